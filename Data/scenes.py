# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the scenes of this folder share: their names, the sources that they are made of, and how they are shown.

For pvpython, after LoadPlugin() of Penumbra:

    import scenes
    scene = scenes.build("table")
    view = scenes.show(scene)

A scene is a namespace: receivers, occluders and lights are dictionaries of proxies by name; colours, by the same names;
camera, the view's properties.
"""

import importlib
import math

import paraview.simple as pv
from paraview import servermanager

# Where each scene is made: module and function.
NAMES = {
    "room": ("room", "build"),
    "still-life": ("heckbert_herf", "still_life"),
    "chess": ("heckbert_herf", "chess"),
    "table": ("heckbert_herf", "table"),
    "cornell-box": ("cornell_box", "build"),
}

def build(name):
    """The scene of this name, with the samples that its author gave it."""
    module, function = NAMES[name]
    return getattr(importlib.import_module(module), function)()


def sheet(name, columns, rows, coordinates):
    """columns x rows polygons over the unit square, bent: coordinates are expressions of coordsX and coordsY in [0, 1].

    ParaView's own sources and filters, so that state files hold it. Points that fall together are merged: a sheet
    closes at its seam, and a quad of which two corners are the same becomes a triangle."""
    plane = pv.Plane(
        registrationName=name + " sheet", Origin=[0, 0, 0], Point1=[1, 0, 0], Point2=[0, 1, 0], XResolution=columns,
        YResolution=rows)
    x, y, z = coordinates
    bent = pv.Calculator(
        registrationName=name + " bent", Input=plane, CoordinateResults=1,
        Function=f"({x}) * iHat + ({y}) * jHat + ({z}) * kHat")
    return pv.Clean(registrationName=name + " polygons", Input=bent, Tolerance=1e-6)


def quad(name, corners):
    """A polygon of four corners, or of three if the last two are the same."""
    weights = "(1-coordsX)*(1-coordsY)", "coordsX*(1-coordsY)", "coordsX*coordsY", "(1-coordsX)*coordsY"
    coordinates = [" + ".join(f"{w}*{c[k]}" for w, c in zip(weights, corners)) for k in range(3)]
    return sheet(name, 1, 1, coordinates)


def lathe(name, profile, segments, place):
    """A surface of revolution about the vertical: `segments` polygons in each band between two points of the profile.

    profile: (radius, height) from below; place: x, y, z of where it stands."""
    radius = piecewise_linear([r for r, _ in profile])
    height = piecewise_linear([h for _, h in profile])
    angle = f"2*{math.pi}*(coordsX + {0.5 / segments})"
    x, y, z = place
    coordinates = f"{x} + ({radius})*cos({angle})", f"{y} + ({radius})*sin({angle})", f"{z} + {height}"
    return sheet(name, segments, len(profile) - 1, coordinates)


def piecewise_linear(values):
    """An expression that takes these values at coordsY = 0, 1/n, ..., 1."""
    n = len(values) - 1
    steps = [
        f"({b - a})*min(max({n}*coordsY - {k}, 0), 1)" for k, (a, b) in enumerate(zip(values, values[1:]))]
    return " + ".join([str(values[0])] + steps)


def together(name, sources):
    """Several sources as one."""
    return pv.AppendGeometry(registrationName=name, Input=sources) if len(sources) > 1 else sources[0]


def smooth(name, source, sharpest=30):
    """The same polygons, with normals that make edges of up to `sharpest` degrees look round."""
    normals = getattr(pv, "SurfaceNormals", None) or pv.GenerateSurfaceNormals  # renamed by ParaView 5.13
    return normals(registrationName=name, Input=source, FeatureAngle=sharpest)


def aimed_light(name, center, target, edge, radiance):
    """A square area light that faces `target`."""
    normal = unit([b - a for a, b in zip(center, target)])
    first = unit(cross(normal, [0, 0, 1]))
    second = cross(normal, first)
    origin = [c - edge / 2 * (a + b) for c, a, b in zip(center, first, second)]
    return pv.AreaLight(
        registrationName=name, Origin=origin, Point1=[o + edge * a for o, a in zip(origin, first)],
        Point2=[o + edge * b for o, b in zip(origin, second)], Radiance=radiance)


def unit(vector):
    length = math.sqrt(sum(v * v for v in vector))
    return [v / length for v in vector]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def multiply_samples(scene, factor):
    """H&H 1997, section 5: a multiplier on the samples that each receiver asks for."""
    for receiver in scene.receivers.values():
        receiver.SampleMultiplier = factor


def show(scene, shading="Radiance"):
    """Shows the scene in a new render view, and answers the view."""
    view = pv.CreateView("RenderView")
    view.ViewSize = [1200, 800]  # unless the scene's camera says otherwise
    view.UseColorPaletteForBackground = 0
    view.Background = [0.16, 0.17, 0.19]
    view.OrientationAxesVisibility = 0
    for name, receiver in scene.receivers.items():
        display = pv.Show(receiver, view)
        display.DiffuseColor = scene.colours[name]
        display.ShadowShading = shading
    for name, occluder in scene.occluders.items():
        pv.Show(occluder, view).DiffuseColor = scene.colours[name]
    for light in scene.lights.values():
        display = pv.Show(light, view)
        display.Ambient, display.Diffuse = 1.0, 0.0  # a lamp is bright by itself
    for name, value in scene.camera.items():
        setattr(view, name, value)
    return view


def make_baker(scene):
    """A filter that bake() can use again, so that shaders are compiled once."""
    return pv.RadianceMap(Receivers=list(scene.receivers.values()), Lights=list(scene.lights.values()))


def bake(scene, baker=None):
    """The baked receivers of each proxy: structured grids, in a dictionary of lists by the proxies' names."""
    baker = baker or make_baker(scene)
    blocks = {}
    for name, receiver in scene.receivers.items():
        others = [other for key, other in scene.receivers.items() if key != name]
        baker.Receivers = [receiver]
        baker.Occluders = others + list(scene.occluders.values())
        output = servermanager.Fetch(baker)
        blocks[name] = [output.GetBlock(i) for i in range(output.GetNumberOfBlocks())]
    return blocks


def count_samples(grid):
    """The samples that a baked receiver has taken, of all lights."""
    samples = grid.GetFieldData().GetArray("LightSamples")
    return sum(samples.GetValue(i) for i in range(samples.GetNumberOfTuples()))


def get_seconds(grid):
    """What a receiver's bake took."""
    return grid.GetFieldData().GetArray("BakeSeconds").GetValue(0)


def count_polygons(view):
    """The polygons of all that a view draws."""
    actors = view.GetClientSideObject().GetRenderer().GetActors()
    inputs = [actor.GetMapper().GetInputDataObject(0, 0) for actor in actors if actor.GetVisibility()]
    return sum(surface.GetNumberOfPolys() for data in inputs if data for surface in leaves(data))


def leaves(data):
    """The surfaces of a mapper's input, which may be composite."""
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    found = []
    iterator = data.NewIterator()
    while not iterator.IsDoneWithTraversal():
        found.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return found
