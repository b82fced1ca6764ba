# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The contract of the filter RadianceMap: what its output looks like, and that its numbers are right."""
import numpy
from paraview import simple
from vtkmodules.vtkCommonCore import VTK_DOUBLE
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet

from penumbra_testing import (
    Checks, Messages, bake, cell_array, cell_centers, form_factor, grid_points, load_plugin, make_scene, radiance_map,
    texels)

# Texels are single precision; issue 2 allows 1e-5 of the peak.
LAMBERT_TOLERANCE = 1e-5

checks = Checks()


def light_polygon(light):
    origin, first, second = (numpy.array(light.GetPropertyValue(name)) for name in ("Origin", "Point1", "Point2"))
    if light.Shape == "Triangle":
        return numpy.array([origin, first, second])
    return numpy.array([origin, first, first + second - origin, second])


def unoccluded_radiance(grid, lights, reflectance=(1, 1, 1), ambient=(0, 0, 0)):
    centers = cell_centers(grid)
    irradiance = sum(
        form_factor(centers, (0, 0, 1), light_polygon(light))[..., None] * numpy.array(light.Radiance)
        for light in lights)
    return numpy.array(reflectance) * (numpy.array(ambient) + irradiance)


def check_structure():
    scene = make_scene(texel_size=0.3)
    second = simple.AreaLight(Shape="Triangle", Origin=[-4, -1, 3], Point1=[-4, 1, 3], Point2=[-3, -1, 4])
    output = radiance_map([scene.receiver], [scene.sphere], [scene.light, second])
    checks.equal(output.GetClassName(), "vtkMultiBlockDataSet", "output")
    checks.equal(output.GetNumberOfBlocks(), 1, "blocks of one floor")
    grid = output.GetBlock(0)
    checks.equal(grid.GetClassName(), "vtkStructuredGrid", "block")
    # 10 / 0.3 = 33.3 texels, rounded up.
    checks.equal(texels(grid), (34, 34), "texels")
    check_points(grid)
    check_arrays(grid, lights=2)


def check_points(grid):
    checks.equal(grid.GetPoints().GetDataType(), VTK_DOUBLE, "points' type")
    points = grid_points(grid)
    corner = points[0, 0]
    j, i = (n[..., None] for n in numpy.mgrid[0 : points.shape[0], 0 : points.shape[1]])
    wanted = (
        corner
        + i / (points.shape[1] - 1) * (points[0, -1] - corner)
        + j / (points.shape[0] - 1) * (points[-1, 0] - corner))
    # A few roundings of coordinates up to 10.
    checks.at_most(numpy.abs(points - wanted).max(), 1e-14, "points off b + i/sx ex + j/sy ey")
    corners = {tuple(points[j, i]) for j in (0, -1) for i in (0, -1)}
    checks.equal(corners, {(x, y, 0.0) for x in (-5.0, 5.0) for y in (-5.0, 5.0)}, "corners")


def check_arrays(grid, lights):
    for name, components in (("Radiance", 3), ("Visibility", 1), ("ErrorEstimate", 1)):
        array = grid.GetCellData().GetArray(name)
        checks.equal(
            (array.GetNumberOfComponents(), array.GetNumberOfTuples()), (components, grid.GetNumberOfCells()),
            f"components and tuples of {name}")
        checks.check(numpy.isfinite(cell_array(grid, name)).all(), f"{name} is finite")
    for name, kind, tuples in (
        ("LightSamples", "vtkIntArray", lights), ("Effect", "vtkStringArray", lights),
        ("BakeSeconds", "vtkDoubleArray", 1)):
        array = grid.GetFieldData().GetAbstractArray(name)
        checks.equal((array.GetClassName(), array.GetNumberOfTuples()), (kind, tuples), f"field {name}")
    checks.equal(grid.GetFieldData().GetArray("LightSamples").GetValue(0), 64, "LightSamples[0]")
    checks.equal(grid.GetFieldData().GetAbstractArray("Effect").GetValue(0), "Soft", "Effect[0]")
    checks.at_least(grid.GetFieldData().GetArray("BakeSeconds").GetValue(0), 1e-9, "BakeSeconds")


def check_lambert():
    scene = make_scene(texel_size=0.1, radiance=(2.0, 1.0, 0.5))
    triangle = simple.AreaLight(
        Shape="Triangle", Origin=[-4, -1, 1], Point1=[-4, 1, 1], Point2=[-3, -1, 3], Radiance=[0.1, 0.4, 0.9],
        TwoSided=1)
    scene.receiver.Reflectance = [0.25, 0.5, 1.0]
    scene.receiver.AmbientRadiance = [0.1, 0.0, 0.2]
    for lights in ([scene.light], [triangle], [scene.light, triangle]):
        (grid,) = bake([scene.receiver], [], lights)
        wanted = unoccluded_radiance(grid, lights, scene.receiver.Reflectance, scene.receiver.AmbientRadiance)
        error = numpy.abs(cell_array(grid, "Radiance") - wanted).max() / wanted.max()
        names = ", ".join(str(light.Shape) for light in lights)
        checks.at_most(error, LAMBERT_TOLERANCE, f"error against Lambert's formula, share of the peak, {names}")
        checks.equal(cell_array(grid, "Visibility").min(), 1.0, "visibility where nothing blocks")
        checks.equal(cell_array(grid, "ErrorEstimate").max(), 0.0, "error estimate of a closed form")
        checks.equal(grid.GetFieldData().GetAbstractArray("Effect").GetValue(0), "Unoccluded", "Effect")
        checks.equal(grid.GetFieldData().GetArray("LightSamples").GetValue(0), 0, "samples of a closed form")


def check_box():
    box = simple.Box(XLength=4, YLength=3, ZLength=1)
    blocks = bake([simple.ShadowReceiver(Input=box, TexelSize=0.5)], [], [make_scene().light])
    sizes = sorted(numpy.prod(texels(grid)) for grid in blocks)
    # Faces of 4x3, 4x1 and 3x1, each twice, with 4 texels a unit of area.
    checks.equal(sizes, [12, 12, 16, 16, 48, 48], "texels of a box's faces")


def check_texel_sizes():
    scene = make_scene(texel_size=0)
    checks.equal(sorted_texels(scene), [512, 512], "automatic texels of a square")
    scene.floor.Point1 = [15, -5, 0]
    checks.equal(sorted_texels(scene), [256, 512], "automatic texels of a 2:1 rectangle")
    scene.receiver.TexelSize = 0.25
    checks.equal(sorted_texels(scene), [40, 80], "texels of 0.25 on 20 x 10")


def sorted_texels(scene):
    """Which edge is the first is not agreed."""
    (grid,) = bake([scene.receiver], [], [scene.light])
    return sorted(texels(grid))


def downsample(fine, factor):
    """The mean of `factor` times finer texels under a tent that reaches to the neighbours' centres."""
    reach = numpy.arange(-(factor // 2), factor + factor // 2)
    tent = 1 - numpy.abs((reach + 0.5) / factor - 0.5)
    for axis in (0, 1):
        fine = numpy.moveaxis(fine, axis, 0)
        coarse = []
        for i in range(fine.shape[0] // factor):
            inside = (i * factor + reach >= 0) & (i * factor + reach < fine.shape[0])
            coarse.append(numpy.average(fine[i * factor + reach[inside]], axis=0, weights=tent[inside]))
        fine = numpy.moveaxis(numpy.array(coarse), 0, axis)
    return fine


def check_supersampling():
    scene = make_scene(texel_size=0.2)
    for factor in (2, 4):
        scene.receiver.Supersampling, scene.receiver.TexelSize = 1, 0.2 / factor
        (fine,) = bake([scene.receiver], [scene.sphere], [scene.light])
        scene.receiver.Supersampling, scene.receiver.TexelSize = factor, 0.2
        (coarse,) = bake([scene.receiver], [scene.sphere], [scene.light])
        wanted = downsample(cell_array(fine, "Radiance").astype(float), factor)
        found = cell_array(coarse, "Radiance")
        # Up to 64 products, each rounded to single precision (6e-8), of numbers up to the peak.
        error = numpy.abs(found - wanted).max() / wanted.max()
        checks.at_most(error, 4e-6, f"supersampling {factor} off the tent of finer texels")


def check_linearity():
    scene = make_scene(texel_size=0.2)
    white = radiance_of(scene)
    reflectance, ambient = numpy.float32([0.25, 0.5, 0.7]), numpy.float32([0.3, 0.1, 0.0])
    scene.receiver.Reflectance = reflectance.tolist()
    checks.check((radiance_of(scene) == reflectance * white).all(), "radiance is linear in the reflectance, to the bit")
    scene.receiver.AmbientRadiance = ambient.tolist()
    wanted = reflectance * (ambient + white)
    checks.check((radiance_of(scene) == wanted).all(), "radiance = reflectance (ambient + irradiance / pi), to the bit")


def radiance_of(scene):
    (grid,) = bake([scene.receiver], [scene.sphere], [scene.light])
    return cell_array(grid, "Radiance")


def check_umbra():
    scene = make_scene(texel_size=0.1)
    scene.receiver.AmbientRadiance = [0.1, 0.2, 0.3]
    scene.receiver.Reflectance = [0.5, 0.5, 1.0]
    lid = simple.Plane(Origin=[-4, -4, 1], Point1=[4, -4, 1], Point2=[-4, 4, 1])
    (grid,) = bake([scene.receiver], [lid], [scene.light])
    umbra = cell_array(grid, "Visibility") == 0
    checks.at_least(umbra.sum(), 1000, "texels in the umbra of a lid")
    ambient = numpy.float32(scene.receiver.Reflectance) * numpy.float32(scene.receiver.AmbientRadiance)
    checks.check((cell_array(grid, "Radiance")[umbra] == ambient).all(), "the umbra is exactly the ambient radiance")
    checks.equal(cell_array(grid, "ErrorEstimate")[umbra].max(), 0.0, "error estimate in the umbra")


def check_receivers_shadow_each_other():
    scene = make_scene(texel_size=0.1)
    table = simple.ShadowReceiver(
        Input=simple.Plane(Origin=[-2, -2, 1], Point1=[2, -2, 1], Point2=[-2, 2, 1]), TexelSize=0.1)
    floor, top = bake([scene.receiver, table], [], [scene.light])
    checks.equal(cell_array(floor, "Visibility").min(), 0.0, "least visibility of a floor under a table")
    checks.equal(cell_array(top, "Visibility").min(), 1.0, "least visibility of the table's top")
    (alone,) = bake([scene.receiver], [table], [scene.light])
    same = cell_array(floor, "Radiance").tobytes() == cell_array(alone, "Radiance").tobytes()
    checks.check(same, "a receiver blocks as the same surface does as an occluder, to the bit")


def check_visibility():
    scene = make_scene(texel_size=0.1)
    scene.receiver.Reconstruction = 0  # a filter keeps order only to within the error of what it filters
    cylinder = simple.Cylinder(Center=[-2, 0.5, 0.5], Resolution=30)
    (first,) = bake([scene.receiver], [scene.sphere], [scene.light])
    (both,) = bake([scene.receiver], [scene.sphere, cylinder], [scene.light])
    fewer, more = cell_array(first, "Visibility"), cell_array(both, "Visibility")
    checks.check(0 <= more.min() and more.max() <= 1, f"visibility lies in [{more.min()}, {more.max()}], within [0, 1]")
    checks.check((more <= fewer).all(), "more occluders never let more light through")
    checks.check((more < fewer).any(), "the second occluder has a shadow")


def coloured_lights(scene):
    """Five lights whose colours no float has exactly."""
    return [scene.light] + [
        simple.AreaLight(
            Origin=[i - 3, -2, 5], Point1=[i - 3, -1, 5], Point2=[i - 2, -2, 5], Radiance=[0.1 + i, 0.7 / (i + 1), 0.3])
        for i in range(1, 5)]


def check_visibility_is_exact():
    """Where nothing is blocked visibility is 1, and where all is it is 0, to the bit, whatever the lights."""
    scene = make_scene(texel_size=0.1, radiance=(0.9, 0.7, 0.3))
    lights = coloured_lights(scene)
    lid = simple.Plane(Origin=[-2, -2, 1], Point1=[2, -2, 1], Point2=[-2, 2, 1])
    for supersampling in (1, 4):
        scene.receiver.Supersampling = supersampling
        (grid,) = bake([scene.receiver], [], lights)
        checks.check((cell_array(grid, "Visibility") == 1).all(), "without an occluder, visibility is 1 everywhere")
        wanted = cell_array(grid, "Radiance")
        (grid,) = bake([scene.receiver], [lid], lights)
        visibility, radiance = cell_array(grid, "Visibility"), cell_array(grid, "Radiance")
        checks.check(((visibility == 1) == (radiance == wanted).all(-1)).all(), "it is 1 just where no light is lost")
        checks.check(((visibility == 0) == (radiance == 0).all(-1)).all(), "it is 0 just where none arrives")
        checks.at_least((visibility == 0).sum(), 500, "texels in the umbra")
        checks.at_least((visibility == 1).sum(), 500, "lit texels")


def check_order():
    scene = make_scene(texel_size=0.1, radiance=(0.9, 0.7, 0.3))
    other = simple.AreaLight(Origin=[-4, -1, 3], Point1=[-4, 1, 3], Point2=[-3, -1, 4], Radiance=[0.1, 0.2, 0.7])
    third = simple.AreaLight(Origin=[0, -4, 3], Point1=[0, -3, 3], Point2=[1, -4, 3], Radiance=[0.3, 0.1, 0.2])
    cylinder = simple.Cylinder(Center=[-2, 0.5, 0.5], Resolution=30)
    wall = simple.ShadowReceiver(Input=simple.Plane(Origin=[5, -5, 0], Point1=[5, 5, 0], Point2=[5, -5, 5]))
    wall.TexelSize = 0.1
    inputs = [scene.receiver, wall], [scene.sphere, cylinder], [scene.light, other, third]
    floor, side = (texel_bytes(grid) for grid in bake(*inputs))
    reverse_side, reverse_floor = (texel_bytes(grid) for grid in bake(*(i[::-1] for i in inputs)))
    checks.check((floor, side) == (reverse_floor, reverse_side), "the order of inputs does not change a bit")
    checks.check([floor, side] == [texel_bytes(grid) for grid in bake(*inputs)], "a second bake gives the same bits")


def texel_bytes(grid):
    return b"".join(cell_array(grid, name).tobytes() for name in ("Radiance", "Visibility", "ErrorEstimate"))


def check_error_estimate():
    """Over many random patterns, the estimate's square is, in the mean, that of the true error."""
    scene = make_scene(texel_size=0.5)
    scene.receiver.LightSamples = 16384
    exact = radiance_of(scene).mean(-1)
    scene.receiver.SamplingPattern, scene.receiver.LightSamples = "Random", 64
    errors, estimates = [], []
    for seed in range(24):
        scene.receiver.Seed = seed
        (grid,) = bake([scene.receiver], [scene.sphere], [scene.light])
        errors.append(cell_array(grid, "Radiance").mean(-1) - exact)
        estimates.append(cell_array(grid, "ErrorEstimate"))
    ratio = numpy.sqrt(numpy.mean(numpy.square(estimates)) / numpy.mean(numpy.square(errors)))
    # 24 patterns of a few independent errors each: some 100 in all, so the ratio's own error is about 10 %.
    checks.check(0.7 < ratio < 1.4, f"error estimate over true error, random patterns: {ratio:.3f}, within 0.7 to 1.4")


def check_both_sides():
    """Side 'Both' gives two blocks, each by the light that arrives there."""
    scene = make_scene(texel_size=0.5)
    below = simple.AreaLight(Origin=[-1, -2, -4], Point1=[1, -2, -4], Point2=[-1, 0, -4])
    scene.receiver.Side = "Both"
    output = radiance_map([scene.receiver], [scene.sphere], [scene.light, below])
    checks.equal(output.GetNumberOfBlocks(), 2, "blocks of both sides")
    names = [output.GetMetaData(i).Get(vtkCompositeDataSet.NAME()) for i in range(output.GetNumberOfBlocks())]
    names = [name.removeprefix("Block 0_") for name in names]  # ParaView 6.1's Fetch() puts that before the filter's
    checks.equal(names, ["Front", "Back"], "names of the blocks of both sides")
    front, back = output.GetBlock(0), output.GetBlock(1)
    wanted = form_factor(cell_centers(back), (0, 0, -1), light_polygon(below))[..., None] * numpy.array(below.Radiance)
    error = numpy.abs(cell_array(back, "Radiance") - wanted).max() / wanted.max()
    checks.at_most(error, LAMBERT_TOLERANCE, "the back, which the sphere does not shade, off Lambert's formula")
    checks.at_least((cell_array(front, "Visibility") < 0.5).sum(), 10, "texels of the front in the sphere's shadow")


def check_rounded_coordinates():
    """Faces whose points are rounded to a centimetre are planar within a PlanarityTolerance of two."""
    angle = numpy.radians(37.0)
    along, up = numpy.array([numpy.cos(angle), numpy.sin(angle), 0]), numpy.array([-0.6, 0.8, 0.45])
    corners = [u * along + v * up for u, v in ((0, 0), (7.3, 0), (9.1, 2.2), (7.3, 4.7), (1.1, 4.1))]
    source = simple.ProgrammableSource(OutputDataSetType="vtkPolyData", Script=f"""
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray
points, polygons = vtkPoints(), vtkCellArray()
points.SetDataTypeToDouble()
corners = {[[round(float(x), 2) for x in corner] for corner in corners]}
polygons.InsertNextCell(len(corners))
for corner in corners:
    polygons.InsertCellPoint(points.InsertNextPoint(corner))
output = self.GetPolyDataOutput()
output.SetPoints(points)
output.SetPolys(polygons)
""")
    lamp = simple.AreaLight(Origin=[2, 2, 9], Point1=[2, 3, 9], Point2=[3, 2, 9])
    for tolerance, blocks in ((0.02, 1), (1e-4, 0)):
        receiver = simple.ShadowReceiver(Input=source, TexelSize=0.5, PlanarityTolerance=tolerance)
        with Messages() as messages:
            found = len(bake([receiver], [], [lamp]))
        checks.equal(found, blocks, f"receivers of a face rounded to 1 cm, PlanarityTolerance {tolerance}")
        checks.equal("PlanarityTolerance" in "".join(messages.get()), blocks == 0, "what allows more is said")


def check_settings():
    scene = make_scene(texel_size=0.5, light_samples=10)
    scene.receiver.SampleMultiplier = 2.5
    (grid,) = bake([scene.receiver], [scene.sphere], [scene.light])
    checks.equal(grid.GetFieldData().GetArray("LightSamples").GetValue(0), 25, "10 samples times 2.5")
    for side, effect in (("Auto", "Soft"), ("Front", "Soft"), ("Back", "None")):
        scene.receiver.Side = side
        (grid,) = bake([scene.receiver], [scene.sphere], [scene.light])
        checks.equal(grid.GetFieldData().GetAbstractArray("Effect").GetValue(0), effect, f"Effect, side {side}")
    scene.receiver.Side = "Auto"
    scene.light.Point1, scene.light.Point2 = scene.light.Point2[:], scene.light.Point1[:]
    (grid,) = bake([scene.receiver], [scene.sphere], [scene.light])
    checks.equal(cell_array(grid, "Radiance").max(), 0.0, "radiance from a light that shines away")
    checks.equal(cell_array(grid, "Visibility").min(), 1.0, "visibility where no light would arrive")
    scene.light.TwoSided = 1
    (grid,) = bake([scene.receiver], [scene.sphere], [scene.light])
    checks.equal(grid.GetFieldData().GetAbstractArray("Effect").GetValue(0), "Soft", "Effect, the same two-sided")
    checks.equal(len(bake([scene.floor], [scene.sphere], [scene.light])), 1, "blocks of a plain plane")


load_plugin()
check_structure()
check_lambert()
check_box()
check_texel_sizes()
check_supersampling()
check_linearity()
check_umbra()
check_receivers_shadow_each_other()
check_visibility()
check_visibility_is_exact()
check_order()
check_error_estimate()
check_both_sides()
check_rounded_coordinates()
check_settings()
checks.finish()
