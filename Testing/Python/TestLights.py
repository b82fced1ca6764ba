# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Lights of every shape: their irradiance against textbook formulas, their shadows, and the same texels in a view."""
import numpy
from paraview import simple

from penumbra_testing import (
    Checks, Messages, bake, cell_array, cell_centers, form_factor, texels, texels_of_view, translate)

# Texels are single precision; issue 2 allows 1e-5 of the peak.
CLOSED_FORM_TOLERANCE = 1e-5
# A sampled visibility with n = 1024 (issue 3: the maximum over three scenes, as a share of the peak).
SAMPLED_TOLERANCE = 5e-3

UP = numpy.array((0.0, 0.0, 1.0))
RADIANCE = [2.0, 1.0, 0.5]

# The stained-glass window: columns and rows of cells in a plane of constant y, which it faces along +y.
WINDOW_Y = -4.0
WINDOW_X = numpy.linspace(-1.5, 1.5, 4)
WINDOW_Z = numpy.linspace(1.0, 3.0, 3)
GLASS = numpy.array([[9, 1, 1], [1, 9, 1], [1, 1, 9], [9, 9, 1], [0, 0, 0], [1, 5, 9]], float)
# A pane before it, parallel to it: x and z from, x and z to.
PANE_Y = -2.0
PANE = (-1.0, 0.0, 0.3, 2.2)

checks = Checks()


def make_floor(half=5.0, texel_size=0.25, **settings):
    plane = simple.Plane(Origin=[-half, -half, 0], Point1=[half, -half, 0], Point2=[-half, half, 0])
    return simple.ShadowReceiver(Input=plane, TexelSize=texel_size, **settings)


def make_window(**settings):
    x, z = WINDOW_X, WINDOW_Z
    # The normal of (x, z) is -y: its edges go the other way round.
    plane = simple.Plane(
        Origin=[x[0], WINDOW_Y, z[0]], Point1=[x[0], WINDOW_Y, z[-1]], Point2=[x[-1], WINDOW_Y, z[0]],
        XResolution=len(z) - 1, YResolution=len(x) - 1)
    glass = simple.PythonCalculator(Input=plane, ArrayAssociation="Cell Data", ArrayName="glass")
    glass.Expression = f"numpy.array({GLASS.tolist()})"
    return simple.AreaLightFromSurface(Input=glass, RadianceArray="glass", **settings)


def make_lights():
    """One light of each shape, above the floor and facing it."""
    shapes = {
        "Parallelogram": dict(Origin=[1, -1, 3], Point1=[1, 1, 3], Point2=[3, -1, 3]),
        "Triangle": dict(Origin=[1, -1, 3], Point1=[1, 1, 3], Point2=[3, -1, 4]),
        "Disk": dict(Origin=[1, 0, 3], Point1=[1, 1, 3], Point2=[2, 0, 3]),
        "Segment": dict(Origin=[-1, 0.5, 3], Point1=[2, 0.5, 3]),
        "Point": dict(Origin=[1, 0, 3]),
        "Directional": dict(Origin=[1, 0, 3], Point1=[0, 0, 0], AngularDiameter=5)}
    lights = {name: simple.AreaLight(Shape=name, Radiance=RADIANCE, **points) for name, points in shapes.items()}
    lights["Surface"] = make_window(Radiance=RADIANCE)
    return lights


def check_closed_form(name, light, wanted_of):
    """`wanted_of` gives the irradiance for a Radiance of 1, in W m^-2, at points; a white receiver reflects 1/pi."""
    (grid,) = bake([make_floor()], [], [light])
    wanted = wanted_of(cell_centers(grid))
    wanted = (wanted if wanted.ndim == 3 else wanted[..., None]) * numpy.array(light.Radiance) / numpy.pi
    error = numpy.abs(cell_array(grid, "Radiance") - wanted).max() / wanted.max()
    checks.at_most(error, CLOSED_FORM_TOLERANCE, f"{name}: error against the textbook, share of the peak")
    checks.equal(grid.GetFieldData().GetArray("LightSamples").GetValue(0), 0, f"{name}: samples of a closed form")


def disk_above(points, centre=(1, 0, 3), radius=1.0):
    """Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-14: an element parallel to a disk."""
    h, r = centre[2], radius
    a2 = ((points[..., :2] - centre[:2]) ** 2).sum(-1)
    root = numpy.sqrt((a2 + h * h + r * r) ** 2 - 4 * a2 * r * r)
    return numpy.pi * 0.5 * (1 - (a2 + h * h - r * r) / root)


def surface_integral(points, places, weights, normal):
    """H&H 1997, eq. 1, summed over places on a surface; weights are areas."""
    d = places - points[..., None, :]
    r2 = (d * d).sum(-1)
    cosines = numpy.maximum(d[..., 2], 0) * numpy.maximum(-(d @ normal), 0)
    return (cosines / r2**2) @ weights


def check_disk():
    check_closed_form("Disk", make_lights()["Disk"], disk_above)
    # Tilted: Gauss-Legendre along the radius times equal steps of the angle, which is exact to rounding for both.
    origin, first, second = numpy.array((0, 0, 3.0)), numpy.array((0.6, 0, -0.8)), numpy.array((0, 1.0, 0))
    light = simple.AreaLight(
        Shape="Disk", Origin=origin, Point1=origin + first, Point2=origin + 3 * second, Radiance=RADIANCE)
    node, weight = numpy.polynomial.legendre.leggauss(24)
    radius, angle = numpy.meshgrid((node + 1) / 2, 2 * numpy.pi * numpy.arange(64) / 64, indexing="ij")
    places = origin + (radius * numpy.cos(angle))[..., None] * first + (radius * numpy.sin(angle))[..., None] * second
    weights = (radius * weight[:, None] / 2 * 2 * numpy.pi / 64).ravel()
    light.TwoSided = 1
    normal = numpy.cross(first, second)
    check_closed_form("tilted Disk", light, lambda points: surface_integral(
        points, places.reshape(-1, 3), weights, normal) + surface_integral(
            points, places.reshape(-1, 3), weights, -normal))


def segment_above(points, begin=(-1, 0.5, 3), end=(2, 0.5, 3)):
    """A diffuse line parallel to x and to the floor: E = I h / (2 d^2) (a + sin a cos a) from one end's angle to the
    other's (IES Lighting Handbook, the parallel element of a diffuse line source)."""
    d2 = begin[2] ** 2 + (points[..., 1] - begin[1]) ** 2
    angles = [numpy.arctan2(end_x - points[..., 0], numpy.sqrt(d2)) for end_x in (begin[0], end[0])]
    low, high = (a + numpy.sin(a) * numpy.cos(a) for a in angles)
    return begin[2] / (2 * d2) * (high - low)


def check_segment():
    check_closed_form("Segment", make_lights()["Segment"], segment_above)
    # Tilted, by Gauss-Legendre: the intensity across, times the sine to the line, over the square of the distance.
    begin, end = numpy.array((-2, 1, 1.0)), numpy.array((2, 0, 4.0))
    node, weight = numpy.polynomial.legendre.leggauss(96)
    places = begin + (node[:, None] + 1) / 2 * (end - begin)
    length = numpy.linalg.norm(end - begin)

    def irradiance(points):
        d = places - points[..., None, :]
        r = numpy.linalg.norm(d, axis=-1)
        sine = numpy.linalg.norm(numpy.cross(d, (end - begin) / length), axis=-1) / r
        return (d[..., 2] / r**3 * sine) @ (weight * length / 2)

    check_closed_form(
        "tilted Segment", simple.AreaLight(Shape="Segment", Origin=begin, Point1=end, Radiance=RADIANCE), irradiance)


def check_point():
    """The inverse square law with the receiver's cosine."""
    place = numpy.array((1, 0, 3.0))
    check_closed_form("Point", make_lights()["Point"], lambda points: (
        place[2] / numpy.linalg.norm(place - points, axis=-1) ** 3))


def check_directional():
    """The cosine law: Radiance is the irradiance at normal incidence, whatever the angular diameter."""
    for diameter in (0, 0.53, 5):
        light = make_lights()["Directional"]
        light.AngularDiameter = diameter
        check_closed_form(f"Directional, {diameter} degrees", light, lambda points: numpy.full(
            points.shape[:2], 3 / numpy.sqrt(10)))
    light.Point1, light.Origin = [1, 0, 1], [1, 0, 3]
    light.AngularDiameter = 60
    check_closed_form("Directional, overhead", light, lambda points: numpy.ones(points.shape[:2]))
    (grid,) = bake([make_floor()], [], [light])
    found = cell_array(grid, "Radiance").astype(float).mean((0, 1)) * numpy.pi
    checks.at_most(
        numpy.abs(found - RADIANCE).max(), CLOSED_FORM_TOLERANCE * max(RADIANCE), "Directional: W m^-2 head on")


def rectangle(x0, x1, z0, z1):
    """Corners in the window's plane, with the shape (..., 4, 3)."""
    x0, x1, z0, z1 = numpy.broadcast_arrays(x0, x1, z0, z1)
    y = numpy.full_like(x0, WINDOW_Y)
    return numpy.stack([numpy.stack(c, -1) for c in ((x0, y, z0), (x0, y, z1), (x1, y, z1), (x1, y, z0))], -2)


def window_irradiance(points, with_pane):
    """Lambert's formula summed over the cells, each less what the pane's shadow covers of it: seen from a point, the
    pane is a rectangle in the window's plane, too."""
    total = numpy.zeros(points.shape)
    scale = (WINDOW_Y - points[..., 1]) / (PANE_Y - points[..., 1])
    shadow = [points[..., axis] + scale * (edge - points[..., axis]) for edge, axis in zip(PANE, (0, 0, 2, 2))]
    blocks = with_pane & (points[..., 1] > PANE_Y)
    for column in range(len(WINDOW_X) - 1):
        for row in range(len(WINDOW_Z) - 1):
            cell = (*WINDOW_X[column : column + 2], *WINDOW_Z[row : row + 2])
            share = form_factor(points, UP, rectangle(*cell))
            low_x, high_x = (numpy.clip(edge, *cell[:2]) for edge in shadow[:2])
            low_z, high_z = (numpy.clip(edge, *cell[2:]) for edge in shadow[2:])
            share -= blocks * form_factor(points, UP, rectangle(low_x, high_x, low_z, high_z))
            total += share[..., None] * GLASS[column * (len(WINDOW_Z) - 1) + row]
    return numpy.pi * total * (points[..., 1:2] > WINDOW_Y)


def check_window():
    """A coloured light, and its coloured shadow."""
    light = make_window(Radiance=RADIANCE)
    check_closed_form("stained glass", light, lambda points: window_irradiance(points, False))
    pane = simple.Plane(Origin=[PANE[0], PANE_Y, PANE[2]], Point1=[PANE[1], PANE_Y, PANE[2]],
                        Point2=[PANE[0], PANE_Y, PANE[3]])
    (grid,) = bake([make_floor(texel_size=0.125, LightSamples=1024)], [pane], [light])
    points = cell_centers(grid)
    wanted = window_irradiance(points, True) * RADIANCE / numpy.pi
    open_ = window_irradiance(points, False) * RADIANCE / numpy.pi
    error = numpy.abs(cell_array(grid, "Radiance") - wanted) / wanted.max()
    checks.at_most(error.max(), SAMPLED_TOLERANCE, "stained glass behind a pane: error, share of the peak")
    # Some of the shadow has a hue: red, green and blue are lost there in shares that differ by more than any error.
    lost = (open_ - cell_array(grid, "Radiance")) / wanted.max()
    even = open_ / wanted.max() * (lost.sum(-1) / numpy.where(open_ > 0, open_, 1).sum(-1) * wanted.max())[..., None]
    checks.at_least(numpy.abs(lost - even).max(), 10 * SAMPLED_TOLERANCE, "stained glass: the hue of its shadow")


def shadow_of_lid(points, toward):
    """Whether a lid, the square |x|, |y| < 1 at z = 1, hides what lies in the direction `toward` of each point."""
    hit = points + toward / toward[..., 2:] * (1 - points[..., 2:])
    return (numpy.abs(hit[..., :2]) < 1).all(-1)


def make_lid():
    return simple.Plane(Origin=[-1, -1, 1], Point1=[1, -1, 1], Point2=[-1, 1, 1])


def check_hard_shadows():
    """Points and suns without extent take one sample, and their shadows are those that rays find, texel by texel."""
    place, direction = numpy.array((1.02, 0.03, 3.0)), numpy.array((0.31, -0.17, 1.0))
    point = simple.AreaLight(Shape="Point", Origin=place)
    sun = simple.AreaLight(Shape="Directional", Origin=direction, Point1=[0, 0, 0], AngularDiameter=0)
    for name, light in (("Point", point), ("Directional", sun)):
        for reconstruction in (0, 1):
            (grid,) = bake([make_floor(texel_size=0.1, Reconstruction=reconstruction)], [make_lid()], [light])
            points = cell_centers(grid)
            toward = place - points if light is point else numpy.broadcast_to(direction, points.shape)
            visible = cell_array(grid, "Visibility")
            wrong = (visible != ~shadow_of_lid(points, toward)).sum()
            checks.equal(wrong, 0, f"{name}, reconstruction {reconstruction}: texels that rays see otherwise")
            checks.equal(grid.GetFieldData().GetArray("LightSamples").GetValue(0), 1, f"{name}: samples")


def check_sun_penumbra():
    """Under a sun in the zenith, an edge at height 1 hides a segment of its disk."""
    light = simple.AreaLight(Shape="Directional", Origin=[0, 0, 1], Point1=[0, 0, 0], AngularDiameter=20)
    (grid,) = bake([make_floor(texel_size=0.025, half=2, LightSamples=1024)], [make_lid()], [light])
    middle = texels(grid)[0] // 2
    x, visible = cell_centers(grid)[middle, :, 0], cell_array(grid, "Visibility")[middle]
    # Directions of the sun are (x, y, 1) in a disk; what arrives from an even sky goes with 1 / (x^2 + y^2 + 1)^2.
    radius = numpy.tan(numpy.radians(10))
    node = (numpy.arange(2000) + 0.5) / 1000 - 1
    across, along = (n * radius for n in numpy.meshgrid(node, node))
    weight = (across**2 + along**2 < radius**2) / (1 + across**2 + along**2) ** 2
    wanted = [(weight * (numpy.abs(at + across) > 1)).sum() / weight.sum() for at in x]
    checks.at_most(numpy.abs(visible - wanted).max(), SAMPLED_TOLERANCE, "sun of 20 degrees: error of visibility")
    checks.check((visible[numpy.abs(x) > 1 + radius] == 1).all(), "sun: 1 outside the penumbra")
    checks.check((visible[numpy.abs(x) < 1 - radius] == 0).all(), "sun: 0 in the umbra")


def check_two_sided():
    """A surface that faces away sends nothing, and two-sided the same as turned round; other lights have no sides."""
    floor, lights = make_floor(), make_lights()
    del lights["Surface"]  # which sends to another part of the floor, once it is turned
    for name, light in lights.items():
        (wanted,) = bake([floor], [make_lid()], [light])
        turn(name, light)
        (away,) = bake([floor], [make_lid()], [light])
        light.TwoSided = 1
        (both,) = bake([floor], [make_lid()], [light])
        wanted, away, both = (cell_array(grid, "Radiance") for grid in (wanted, away, both))
        if name in ("Segment", "Point", "Directional"):
            checks.check((away == both).all(), f"{name}: TwoSided changes nothing")
        else:
            checks.equal(away.max(), 0.0, f"{name}: radiance from behind")
        # Samples go round the other way: only their number is the same.
        difference = numpy.abs(both - wanted).mean() / wanted.max()
        checks.at_most(difference, SAMPLED_TOLERANCE, f"{name}: difference, both sides and turned, mean")
    (front,) = bake([floor], [], [make_window()])
    (both,) = bake([floor], [], [make_window(TwoSided=1)])
    behind = cell_centers(front)[..., 1] < WINDOW_Y
    front, both = (cell_array(grid, "Radiance") for grid in (front, both))
    checks.equal(front[behind].max(), 0.0, "Surface: radiance behind it")
    checks.at_least(both[behind].max(), 0.1, "Surface: radiance behind it, two-sided")
    checks.check((front[~behind] == both[~behind]).all(), "Surface: before it, two-sided changes nothing")


def turn(name, light):
    if name in ("Parallelogram", "Triangle"):
        light.Point1, light.Point2 = light.Point2[:], light.Point1[:]
    elif name == "Disk":
        light.Point2 = [0, 0, 3]


def check_same_texels():
    """The view's pass and the filter, bit for bit: each shape alone, and all together."""
    floor = make_floor(Supersampling="2")
    lights = make_lights()
    ball = simple.Sphere(Center=[0, 0, 1.2], ThetaResolution=20, PhiResolution=20)
    for name, chosen in [*((name, [light]) for name, light in lights.items()), ("all", list(lights.values()))]:
        with Messages() as messages:
            (grid,) = bake([floor], [ball], chosen)
            view = simple.CreateView("RenderView")
            for proxy in [floor, ball, *chosen]:
                simple.Show(proxy, view)
            simple.Render(view)
            (shown,) = texels_of_view(view)
        checks.equal(messages.get(), [], f"{name}: messages")
        found = cell_array(grid, "Radiance")
        checks.check(found.tobytes() == shown.tobytes(), f"{name}: view and filter the same to the bit")
        visible = cell_array(grid, "Visibility")
        checks.check(visible.min() < 0.5 <= visible.max(), f"{name}: the ball has a shadow")
        simple.Delete(view)


def check_display():
    """A light lights while it is shown, and moves with its display."""
    floor = make_floor(texel_size=0.5)
    for name, light in make_lights().items():
        view = simple.CreateView("RenderView")
        simple.Show(floor, view)
        display = simple.Show(light, view)
        translate(display, [0, 0, 1])
        display.Orientation = [0, 0, 180]
        simple.Render(view)
        (moved,) = texels_of_view(view)
        (wanted,) = bake([floor], [], [transformed(name, light)])
        wanted = cell_array(wanted, "Radiance").reshape(-1, 3)
        checks.at_most(
            numpy.abs(moved - wanted).max() / wanted.max(), CLOSED_FORM_TOLERANCE, f"{name}: moved by its display")
        simple.Hide(light, view)
        simple.Render(view)
        checks.equal(len(texels_of_view(view)), 0, f"{name}: receivers that a hidden light shades")
        simple.Delete(view)


def check_stretched_disk():
    """A disk shines as the ellipse that its display makes of it: by an unequal scale, and by a shear besides."""
    floor = make_floor(texel_size=0.5)
    light = make_lights()["Disk"]
    centre, first, second = numpy.array((1, 0, 3.0)), numpy.array((0, 1.0, 0)), numpy.array((1.0, 0, 0))
    node, weight = numpy.polynomial.legendre.leggauss(24)
    radius, angle = numpy.meshgrid((node + 1) / 2, 2 * numpy.pi * numpy.arange(64) / 64, indexing="ij")
    disk = centre + (radius * numpy.cos(angle))[..., None] * first + (radius * numpy.sin(angle))[..., None] * second
    weights = (radius * weight[:, None] / 2 * 2 * numpy.pi / 64).ravel()
    shear = numpy.array(((1, 0.5, 0), (0.2, 1, 0), (0.3, -0.4, 1)))
    for name, matrix, displayed in (
            ("scaled", numpy.diag((3, 1, 0.5)), dict(Scale=[3, 1, 0.5])),
            ("sheared", shear, dict(UserTransform=numpy.pad(shear, (0, 1)).ravel().tolist()[:15] + [1]))):
        view = simple.CreateView("RenderView")
        simple.Show(floor, view)
        display = simple.Show(light, view)
        for key, value in displayed.items():
            setattr(display, key, value)
        simple.Render(view)
        (shown,) = texels_of_view(view)
        (grid,) = bake([floor], [], [light])
        normal = numpy.cross(matrix @ first, matrix @ second)
        wanted = surface_integral(
            cell_centers(grid), disk.reshape(-1, 3) @ matrix.T, weights * numpy.linalg.norm(normal),
            normal / numpy.linalg.norm(normal)).reshape(-1, 1) * numpy.array(RADIANCE) / numpy.pi
        checks.at_most(numpy.abs(shown - wanted).max() / wanted.max(), CLOSED_FORM_TOLERANCE, f"{name} Disk: error")
        simple.Delete(view)


def transformed(name, light):
    """The same light with its points turned half around z and lifted by 1."""
    if name == "Surface":
        moved = simple.Transform(Input=light.Input, TransformAllInputVectors=0)  # the glass is no vector
        moved.Transform.Translate, moved.Transform.Rotate = [0, 0, 1], [0, 0, 180]
        return simple.AreaLightFromSurface(Input=moved, RadianceArray="glass", Radiance=light.Radiance)
    points = {key: [-p[0], -p[1], p[2] + 1] for key in ("Origin", "Point1", "Point2")
              for p in [light.GetPropertyValue(key)]}
    return simple.AreaLight(Shape=name, Radiance=light.Radiance, AngularDiameter=light.AngularDiameter, **points)


def check_radiance_array():
    """By its name, or by ParaView's pair; grey arrays; none by default, whether the input has cell arrays or not."""
    window = make_window()
    found = radiance_of(window)
    checks.check((found == GLASS).all(), "the cells' radiance, by name")
    window.RadianceArray = ["CELLS", "glass"]
    checks.check((radiance_of(window) == GLASS).all(), "the cells' radiance, by ['CELLS', name]")
    grey = simple.PythonCalculator(Input=window.Input, ArrayAssociation="Cell Data", ArrayName="grey")
    grey.Expression = "numpy.arange(6.0)"
    light = simple.AreaLightFromSurface(Input=grey, RadianceArray="grey")
    checks.check((radiance_of(light) == numpy.arange(6.0)[:, None]).all(), "a grey array")
    for source in (window.Input, simple.Plane()):
        with Messages() as messages:
            found = radiance_of(simple.AreaLightFromSurface(Input=source))
        checks.check((found == 1).all() and not messages.get(), "without an array, each cell has a radiance of 1")


def radiance_of(light):
    """Of each cell of a light from a surface."""
    light.UpdatePipeline()
    data = simple.servermanager.Fetch(light).GetCellData().GetArray("PenumbraRadiance")
    return numpy.array([data.GetTuple(i) for i in range(data.GetNumberOfTuples())])


checks.run([
    check_disk, check_segment, check_point, check_directional, check_window, check_hard_shadows, check_sun_penumbra,
    check_two_sided, check_same_texels, check_display, check_stretched_disk, check_radiance_array])
