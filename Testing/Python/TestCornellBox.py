# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A check on something real: the direct light in the Cornell box, by its published geometry, against an integration
that shares no code with the product."""
import sys

import numpy

from exact_light import cross, quadrature, sub, visible_form_factor
from penumbra_testing import Checks, bake, cell_array, cell_centers, data_path, load_plugin

sys.path.insert(0, data_path(""))

import cornell_box  # from Data

WALLS = ("Floor", "Back wall", "Right wall", "Left wall, back", "Left wall, front")
CENTER = (278.0, 274.4, 279.6)
TEXEL_SIZE = 10.0  # mm: some 55 x 56 texels a wall
SAMPLES = 1024
# Shares of a receiver's peak. The same pattern and n have had 5.3e-4 and 4.0e-3 on other scenes (three occluders,
# against an exact answer); twice that is left for the shape of this one.
RMS_LIMIT = 1e-3
MAXIMUM_LIMIT = 1e-2
QUADRATURE_STEPS = 256

checks = Checks()


def unit_normal(outline, inside):
    """The normal of a wall towards a point of the room."""
    normal = numpy.array(cross(sub(outline[1], outline[0]), sub(outline[2], outline[0])))
    normal /= numpy.linalg.norm(normal)
    return tuple(normal if normal @ numpy.subtract(inside, outline[0]) > 0 else -normal)


def is_inside(point, outline, normal):
    """Whether a point of a convex polygon's plane lies in it."""
    edges = zip(outline, outline[1:] + outline[:1])
    sides = [numpy.dot(cross(sub(b, a), sub(point, a)), normal) for a, b in edges]
    return min(sides) > 0 or max(sides) < 0


def block_faces(name):
    points, polygons, _ = cornell_box.SURFACES[name]
    return [[points[i] for i in polygon] for polygon in polygons]


BLOCKS = [block_faces("Short block"), block_faces("Tall block")]


def exact_factors(name, points, blocks):
    """The form factor of what each point of a wall sees of the light; NaN beside the wall's outline."""
    outline = cornell_box.SURFACES[name][0]
    normal = unit_normal(outline, CENTER)
    factors = numpy.array([
        visible_form_factor(p, normal, cornell_box.LIGHT, blocks) if is_inside(p, outline, normal) else numpy.nan
        for p in map(tuple, points.reshape(-1, 3).tolist())])
    return factors.reshape(points.shape[:-1])


def check_oracle(name, points, factors):
    """The exact answer against rays, at some points.

    The outline of a block's shadow on the light is convex, so of a grid of steps x steps cells it passes through 4
    steps at most. Each is counted whole or not at all, off by half a cell in the mean, and there are two blocks: 4
    steps cells of steps^2. The error in cells that no outline passes through is of the order of 1 / steps^2."""
    normal = unit_normal(cornell_box.SURFACES[name][0], CENTER)
    inside = numpy.argwhere(numpy.isfinite(factors))
    errors = [
        abs(quadrature(tuple(points[i, j]), normal, cornell_box.LIGHT, BLOCKS, QUADRATURE_STEPS) - factors[i, j])
        for i, j in inside[:: len(inside) // 40]]
    error = max(errors) / numpy.nanmax(factors)
    checks.at_most(error, 4 / QUADRATURE_STEPS, f"{name}: the oracle off {QUADRATURE_STEPS}^2 rays, share of the peak")


def errors_of(name, grid, factors):
    """The radiance's errors in the texels of a wall, as shares of each component's peak."""
    inside = numpy.isfinite(factors)
    wanted = factors[inside][:, None] * numpy.multiply(cornell_box.SURFACES[name][2], cornell_box.RADIANCE)
    return (cell_array(grid, "Radiance")[inside] - wanted) / wanted.max(axis=0)


def check_wall(name, grid):
    points = cell_centers(grid)
    factors = exact_factors(name, points, BLOCKS)
    check_oracle(name, points, factors)
    error = errors_of(name, grid, factors)
    checks.at_least(len(error), 1000, f"{name}: texels")
    checks.at_most(numpy.sqrt((error**2).mean()), RMS_LIMIT, f"{name}: RMS error, share of the peak")
    checks.at_most(numpy.abs(error).max(), MAXIMUM_LIMIT, f"{name}: maximum error, share of the peak")
    if name == "Floor":
        error = errors_of(name, grid, exact_factors(name, points, BLOCKS[:1]))
        checks.at_least(numpy.abs(error).max(), 0.5, "Floor: maximum error against a box without its tall block")


def check_walls():
    scene = cornell_box.build(samples=SAMPLES, texel_size=TEXEL_SIZE, ambient=[0, 0, 0])
    for name in WALLS:
        others = [receiver for other, receiver in scene.receivers.items() if other != name]
        (grid,) = bake([scene.receivers[name]], others, scene.lights.values())
        check_wall(name, grid)


load_plugin()
check_walls()
checks.finish()
