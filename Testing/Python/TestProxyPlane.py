# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Curved receivers by a plane (H&H 1997, figure 5): the shadow's edge on a bumpy floor is where rays from the light's
centre say, in the view and in the map; off, and for what no plane serves, there is one error."""
import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

from penumbra_testing import PLAIN, Checks, Messages, bake, cell_array, cell_centers, find_pass, grid_points, picture

HALF = 2.0
BUMP = 0.3
TEXEL = 0.05
CELLS = 40
LAMP = numpy.array([0.9, 0.5, 3.0])
LAMP_HALF = 0.01
# The occluder is the rectangle in the plane z = PLATE_Z.
PLATE_LOW, PLATE_HIGH, PLATE_Z = numpy.array([-0.6, -0.5]), numpy.array([0.5, 0.4]), 1.2
SIZE = 200
SCALE = 2.2  # half of what the view shows, in world units

checks = Checks()


def height(x, y):
    """A bump in every quarter of the floor: between 0, in its middle and at its edges, and BUMP."""
    return BUMP * numpy.sin(numpy.pi * x / HALF) ** 2 * numpy.sin(numpy.pi * y / HALF) ** 2


# How far the quads' triangles, whichever way they are cut, are from the function: a linear interpolant in a square of
# side c misses by at most c^2 / 8 (|fxx| + 2 |fxy| + |fyy|), and each is at most 2 BUMP (pi / HALF)^2 here.
SAG = (2 * HALF / CELLS) ** 2 / 8 * 4 * 2 * BUMP * (numpy.pi / HALF) ** 2

# How far from the shadow's edge, on the plate, points are judged: a bilinear look-up takes texels within a texel along
# each axis, and reconstruction those two further; the lamp moves a ray by at most its half diagonal; the height's error
# by less than itself, since rays there are steeper than 45 degrees.
BLUR = numpy.sqrt(2) * (3 * TEXEL + LAMP_HALF) + SAG


def plate_depth(points):
    """Of rays from the lamp's centre through the points: how far inside the plate's outline they pass it."""
    share = (LAMP[2] - PLATE_Z) / (LAMP[2] - points[..., 2:])
    q = (LAMP + share * (points - LAMP))[..., :2]
    return numpy.minimum(q - PLATE_LOW, PLATE_HIGH - q).min(-1)


def make_floor(**properties):
    """The bumpy floor as a receiver."""
    plane = simple.Plane(Origin=[-HALF, -HALF, 0], Point1=[HALF, -HALF, 0], Point2=[-HALF, HALF, 0], XResolution=CELLS,
                         YResolution=CELLS)
    bumps = simple.PythonCalculator(
        Input=plane, ArrayName="height",
        Expression=f"{BUMP} * sin({numpy.pi / HALF} * points[:, 0])**2 * sin({numpy.pi / HALF} * points[:, 1])**2")
    warped = simple.WarpByScalar(Input=bumps, Scalars=["POINTS", "height"], UseNormal=1, Normal=[0, 0, 1])
    return simple.ShadowReceiver(Input=warped, TexelSize=TEXEL, **properties)


def make_scene(**properties):
    floor = make_floor(**properties)
    (x0, y0), (x1, y1) = PLATE_LOW, PLATE_HIGH
    plate = simple.Plane(Origin=[x0, y0, PLATE_Z], Point1=[x1, y0, PLATE_Z], Point2=[x0, y1, PLATE_Z])
    x, y, z = LAMP
    lamp = simple.AreaLight(Origin=[x - LAMP_HALF, y + LAMP_HALF, z], Point1=[x + LAMP_HALF, y + LAMP_HALF, z],
                            Point2=[x - LAMP_HALF, y - LAMP_HALF, z])
    return floor, plate, lamp


def make_view(floor, *others):
    """From above, without perspective."""
    view = simple.CreateView("RenderView")
    view.ViewSize = [SIZE, SIZE]
    view.UseFXAA = 0
    view.OrientationAxesVisibility = 0
    display = simple.Show(floor, view)
    display.ColorArrayName = [None, ""]
    for source in others:
        simple.Show(source, view)
    view.CameraParallelProjection = 1
    view.CameraParallelScale = SCALE
    view.CameraPosition = [0, 0, 10]
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraViewUp = [0, 1, 0]
    return view, display


def check_view():
    floor, plate, lamp = make_scene(ProxyPlane=1)
    with Messages() as messages:
        view, display = make_view(floor, plate, lamp)
        shadowed = picture(view)[..., 0].astype(int)
    checks.equal(messages.get(), [], "view: messages")
    checks.equal(find_pass(view).GetNumberOfReceivers(), 1, "view: receivers")
    display.Representation = PLAIN
    plain = picture(view)[..., 0].astype(int)

    y, x = (2 * (numpy.mgrid[0:SIZE, 0:SIZE] + 0.5) / SIZE - 1) * SCALE
    points = numpy.stack([x, y, height(x, y)], -1)
    depth = plate_depth(points)
    margin = 2 * 2 * SCALE / SIZE  # two pixels
    hidden = ((points[..., :2] > PLATE_LOW - margin) & (points[..., :2] < PLATE_HIGH + margin)).all(-1)
    hidden |= numpy.linalg.norm(points[..., :2] - LAMP[:2], axis=-1) < 2 * LAMP_HALF + margin
    seen = (numpy.abs(points[..., :2]) < HALF - margin).all(-1) & ~hidden
    lit, dark = seen & (depth < -BLUR), seen & (depth > BLUR)
    checks.at_least(lit.sum(), 10000, "view: pixels that are lit")
    checks.at_least(dark.sum(), 300, "view: pixels that are dark")
    checks.at_most(numpy.abs(shadowed - plain)[lit].max(), 1, "view: lit pixels off the plain picture")
    checks.at_most(shadowed[dark].max(), 1, "view: brightest dark pixel")
    checks.at_least(plain[dark].min(), 50, "view: darkest of them without shadows")


def check_map():
    floor, plate, lamp = make_scene(ProxyPlane=1)
    (grid,) = bake([floor], [plate], [lamp])
    points = grid_points(grid)
    # The lowest points of the floor are at z = 0, but for the rounding of its floats.
    checks.at_most(numpy.abs(points[..., 2]).max(), 1e-6, "map: points off the plane")
    # The best fit is horizontal by symmetry, and the rectangle holds the projections of all points.
    source = vtk_to_numpy(simple.servermanager.Fetch(floor).GetPoints().GetData())
    share = LAMP[2] / (LAMP[2] - source[:, 2:])
    projected = (LAMP + share * (source - LAMP))[:, :2]
    low, high = points[..., :2].min((0, 1)), points[..., :2].max((0, 1))
    excess = max((low - projected.min(0)).max(), (projected.max(0) - high).max())
    checks.at_most(excess, 1e-4, "map: what projections are outside of the grid")
    depth = plate_depth(cell_centers(grid))
    visibility = cell_array(grid, "Visibility")
    checks.at_least(visibility[depth < -BLUR].min(), 1.0, "map: visibility in the light")
    checks.at_most(visibility[depth > BLUR].max(), 0.0, "map: visibility in the shadow")
    checks.at_least((depth > BLUR).sum(), 300, "map: texels in the shadow")


def check_messages(name, properties, *words, lamp_direction=None):
    """One error on the whole way, and the floor is drawn plain."""
    with Messages() as messages:
        floor, plate, lamp = make_scene(**properties)
        if lamp_direction:
            lamp.Shape = "Directional"
            lamp.Point1 = [a + b for a, b in zip(lamp.Origin, lamp_direction)]
        view, display = make_view(floor, plate, lamp)
        drawn = picture(view)
    found = messages.get()
    checks.equal(len(found), 1, f"{name}: messages, {found}")
    for word in words:
        checks.check(any(word in message for message in found), f"{name}: says '{word}'")
    display.Representation = PLAIN
    checks.check((picture(view) == drawn).all(), f"{name}: the receiver is drawn plain")
    with Messages() as messages:
        blocks = bake([floor], [plate], [lamp])
    checks.at_most(len(messages.get()), 1, f"{name}: messages of the map")
    checks.equal(len(blocks), 0, f"{name}: blocks of the map")


def check_bad_input():
    nan = float("nan")
    given = {"ProxyPlane": 1, "ProxyPlaneMode": "Given"}
    check_messages("off", {}, "ShadowReceiver", "angle of", "allowed")
    check_messages("no normal", {**given, "ProxyNormal": [0, 0, 0]}, "ProxyNormal", "(0, 0, 0)", "allowed")
    check_messages("NaN normal", {**given, "ProxyNormal": [0, nan, 0]}, "ProxyNormal", "nan", "allowed")
    check_messages("NaN origin", {**given, "ProxyOrigin": [nan, 0, 0]}, "ProxyOrigin", "nan", "allowed")
    check_messages("edge-on", given, "edge-on", "allowed", lamp_direction=[1, 0, 0])
    check_messages("nearly edge-on", given, "edge-on", "times", "allowed", lamp_direction=[1, 0, -0.001])


def check_planar():
    """A planar receiver is what it is without."""
    pictures = []
    for proxy in (0, 1):
        floor, plate, lamp = make_scene(ProxyPlane=proxy)
        floor.Input.ScaleFactor = 0
        view, _ = make_view(floor, plate, lamp)
        pictures.append(picture(view))
        checks.equal(find_pass(view).GetNumberOfReceivers(), 1, f"planar, ProxyPlane {proxy}: receivers")
    checks.check((pictures[0] == pictures[1]).all(), "planar: the same picture with ProxyPlane on")


checks.run([check_view, check_map, check_bad_input, check_planar])
