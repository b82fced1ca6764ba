# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Input that makes no sense gives one error message, which names the value and what is allowed; the rest is drawn."""
import numpy
from paraview import simple

from penumbra_testing import (
    PLAIN, SHADOWED, Checks, Messages, bake, cell_array, find_pass, make_scene, make_view, picture)

# DESIGN 4 and issue 2: a receiver's textures may not pass this.
MAXIMUM_TEXTURE_BYTES = 256 * 2**20

checks = Checks()


def check_message(name, messages, *words):
    """There is one message, and these words are there."""
    found = messages.get()
    checks.equal(len(found), 1, f"{name}: messages")
    for word in words:
        checks.check(any(word in message for message in found), f"{name}: says '{word}' in {found}")


def check_case(name, scene, *words, shown=None):
    """Draws the scene's view, a new one if none is given, and bakes the same as data."""
    with Messages() as messages:
        shown = shown or make_view(scene)
        drawn = picture(shown.view)
    check_message(f"{name}, view", messages, *words)
    checks.at_least(len(numpy.unique(drawn.reshape(-1, 3), axis=0)), 10, f"{name}: colours in the picture")
    check_finite(name, scene)
    return shown, drawn


def check_finite(name, scene):
    with Messages() as messages:
        blocks = bake([scene.receiver], [scene.sphere], [scene.light])
    checks.at_most(len(messages.get()), 1, f"{name}: messages of the bake, which gives {len(blocks)} blocks")
    for grid in blocks:
        for array in ("Radiance", "Visibility", "ErrorEstimate"):
            checks.check(numpy.isfinite(cell_array(grid, array)).all(), f"{name}: {array} is finite")


def check_plain(name, shown, drawn):
    """The receiver is drawn as if it were none."""
    shown.receiver.Representation = PLAIN
    checks.check((picture(shown.view) == drawn).all(), f"{name}: the receiver is drawn plain")


def nan_polygon():
    """A quadrilateral with a corner that is not a number."""
    source = simple.ProgrammableSource()
    source.OutputDataSetType = "vtkPolyData"
    source.Script = """
import vtk
points = vtk.vtkPoints()
for x, y in ((-5, -5), (5, -5), (5, 5), (-5, float("nan"))):
    points.InsertNextPoint(x, y, 0)
polygons = vtk.vtkCellArray()
polygons.InsertNextCell(4, (0, 1, 2, 3))
self.GetPolyDataOutput().SetPoints(points)
self.GetPolyDataOutput().SetPolys(polygons)
"""
    return source


def check_curved_receiver():
    scene = make_scene()
    scene.receiver.Input = simple.Sphere(Radius=4)
    check_plain("curved receiver", *check_case("curved receiver", scene, "ShadowReceiver", "angle of", "allowed"))


def check_empty_receiver():
    scene = make_scene()
    scene.receiver.Input = simple.Clip(Input=scene.floor, ClipType="Plane")
    scene.receiver.Input.ClipType.Origin = [-100, 0, 0]
    scene.receiver.Input = simple.ExtractSurface(Input=scene.receiver.Input)
    check_case("empty receiver", scene, "ShadowReceiver", "allowed")


def check_light_without_area():
    scene = make_scene()
    scene.light.Point2 = scene.light.Point1[:]
    check_plain("light without area", *check_case("light without area", scene, "AreaLight", "area", "0; allowed"))


def check_nan_receiver():
    scene = make_scene()
    scene.receiver.Input = nan_polygon()
    check_case("NaN in a receiver", scene, "ShadowReceiver", "nan", "allowed")


def check_nan_light():
    scene = make_scene()
    scene.light.Origin = [float("nan"), 0, 5]
    check_plain("NaN in a light", *check_case("NaN in a light", scene, "AreaLight", "Origin", "nan", "finite"))


def check_nan_occluder():
    """The triangles without the NaN still cast their shadow."""
    scene = make_scene()
    scene.sphere = simple.AppendGeometry(Input=[scene.sphere, nan_polygon()])
    shown, drawn = check_case("NaN in an occluder", scene, "not finite", "allowed")
    shown.receiver.Representation = PLAIN
    checks.check((picture(shown.view) != drawn).any(), "NaN in an occluder: there is a shadow")


def check_tiny_texels():
    scene = make_scene(texel_size=1e-9, light_samples=1)
    with Messages() as messages:
        shown = make_view(scene)
        simple.Hide(scene.sphere, shown.view)
        picture(shown.view)
    check_message("tiny texels", messages, "TexelSize", "1e-09", "16384", "256 MiB")
    found = find_pass(shown.view).GetTextureBytes()
    checks.at_most(found, MAXIMUM_TEXTURE_BYTES, "tiny texels: bytes of the textures")
    checks.equal(found, 0, "tiny texels: bytes of the textures where there is no shadow to show")


def check_properties():
    scene = make_scene()
    shown = make_view(scene)
    as_it_was = picture(shown.view)
    for name, value in (
        ("TexelSize", -1.0), ("LightSamples", 0), ("SampleMultiplier", -2.0), ("Reflectance", [2.0, 0.0, 0.0]),
        ("AmbientRadiance", [-1.0, 0.0, 0.0]), ("SolidAnglePerSample", -0.5), ("ErrorTolerance", -0.25),
        ("ErrorTolerance", 2.0), ("PlanarityTolerance", -0.5),
        ("MaximumLightSamples", 0), ("MaximumLightSamples", 65537)):
        good = scene.receiver.GetPropertyValue(name)
        good = good[:] if hasattr(good, "SMProperty") else good
        scene.receiver.SetPropertyWithName(name, value)
        written = f"{value[0]:g}" if isinstance(value, list) else f"{value:g}"
        words = ("ShadowReceiver", name, written, "allowed")
        check_plain(name, *check_case(f"{name} {value}", scene, *words, shown=shown))
        scene.receiver.SetPropertyWithName(name, good)
        shown.receiver.Representation = SHADOWED
        checks.check((picture(shown.view) == as_it_was).all(), f"{name}: a good value is as before")
    scene = make_scene()
    scene.light.Radiance = [-1, 0, 0]
    check_plain("Radiance", *check_case("Radiance -1", scene, "AreaLight", "Radiance", "-1", "allowed"))


def check_lights():
    """Lights of each shape that make no sense."""
    nan = float("nan")
    for shape, name, value, *words in (
        ("Disk", "Point1", [1, -1, 6], "area"), ("Disk", "Point2", [1, 3, 6], "area"),
        ("Disk", "Origin", [0, nan, 0], "Origin", "nan"),
        ("Segment", "Point1", [1, -1, 6], "Point1", "0; allowed"), ("Segment", "Origin", [nan, 0, 0], "Origin", "nan"),
        ("Point", "Origin", [nan, 0, 0], "Origin", "nan"), ("Point", "Radiance", [1, 2, nan], "Radiance", "nan"),
        ("Directional", "Point1", [1, -1, 6], "Point1", "0; allowed"),
        ("Directional", "AngularDiameter", 180.0, "AngularDiameter", "180", "less than 180"),
        ("Directional", "AngularDiameter", -1.0, "AngularDiameter", "-1"),
        ("Directional", "AngularDiameter", nan, "AngularDiameter", "nan")):
        scene = make_scene()
        scene.light.Shape = shape
        scene.light.SetPropertyWithName(name, value)
        title = f"{shape}, {name} {value}"
        check_plain(title, *check_case(title, scene, "AreaLight", "allowed", *words))


def make_surface(values=None, polygon=None):
    """A light from a square of 2 x 2 cells with these values, or from one polygon."""
    source = simple.Plane(Origin=[1, -1, 6], Point1=[1, 1, 6], Point2=[3, -1, 6], XResolution=2, YResolution=2)
    if polygon:
        source = simple.ProgrammableSource(OutputDataSetType="vtkPolyData")
        source.Script = f"""
import vtk
points, polygons = vtk.vtkPoints(), vtk.vtkCellArray()
nan = float("nan")
for p in {polygon}:
    points.InsertNextPoint(p)
polygons.InsertNextCell(points.GetNumberOfPoints(), range(points.GetNumberOfPoints()))
self.GetPolyDataOutput().SetPoints(points)
self.GetPolyDataOutput().SetPolys(polygons)
"""
    light = simple.AreaLightFromSurface(Input=source)
    if values:
        light.Input = simple.PythonCalculator(
            Input=source, ArrayAssociation="Cell Data", ArrayName="glass",
            Expression=f"numpy.array({values})".replace("nan", "numpy.nan"))
        light.RadianceArray = "glass"
    return light


def check_surface_lights():
    nan = float("nan")
    missing = make_surface()
    missing.RadianceArray = "no such array"
    negative = make_surface()
    negative.Radiance = [1, -2, 1]
    bent = [(1, -1, 6), (1, 1, 6), (3, 1, 6), (3, -1, 7)]
    concave = [(1, -1, 6), (1, 1, 6), (1.2, -0.8, 6), (3, -1, 6)]
    for name, light, *words in (
        ("missing array", missing, "RadianceArray", "no such array", "cell array"),
        ("two components", make_surface([[1.0, 2]] * 4), "glass", "2 components", "1 or 3"),
        ("negative array", make_surface([1.0, -3, 1, 1]), "glass", "-3", "cell 1"),
        ("array with NaN", make_surface([1.0, 1, nan, 1]), "glass", "nan", "cell 2"),
        ("black array", make_surface([0.0] * 4), "radiance greater than 0"),
        ("negative Radiance", negative, "Radiance", "-2"),
        ("bent polygon", make_surface(polygon=bent), "polygon 0", "planar and convex"),
        ("concave polygon", make_surface(polygon=concave), "polygon 0", "planar and convex"),
        ("NaN in a polygon", make_surface(polygon=[(1, -1, 6), (1, nan, 6), (3, 1, 6)]), "polygon 0", "not finite"),
        ("polygon without area", make_surface(polygon=[(1, -1, 6), (1, 1, 6), (1, 3, 6)]), "area")):
        scene = make_scene()
        scene.light = light
        check_plain(name, *check_case(name, scene, "AreaLightFromSurface", "allowed", *words))


def check_no_occluders():
    scene = make_scene()
    with Messages() as messages:
        (grid,) = bake([scene.receiver], [], [scene.light])
    checks.equal(messages.get(), [], "no occluders: messages")
    checks.at_least(cell_array(grid, "Radiance").min(), 1e-6, "no occluders: least radiance")
    checks.equal(cell_array(grid, "Visibility").min(), 1.0, "no occluders: least visibility")


def check_no_lights():
    scene = make_scene()
    with Messages() as messages:
        (grid,) = bake([scene.receiver], [scene.sphere], [])
        shown = make_view(scene)
        simple.Hide(scene.light, shown.view)
        drawn = picture(shown.view)
    checks.equal(messages.get(), [], "no lights: messages")
    checks.equal(cell_array(grid, "Radiance").max(), 0.0, "no lights: radiance")
    checks.equal(cell_array(grid, "Visibility").min(), 1.0, "no lights: visibility")
    checks.equal(find_pass(shown.view).GetNumberOfReceivers(), 0, "no lights: receivers that the view shades")
    check_plain("no lights", shown, drawn)


CASES = [check_curved_receiver, check_empty_receiver, check_light_without_area, check_nan_receiver, check_nan_light,
         check_nan_occluder, check_tiny_texels, check_properties, check_lights,
         check_surface_lights, check_no_occluders, check_no_lights]
checks.run(CASES)
