# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Cornell box, by its published geometry: Cornell University Program of Computer Graphics, Cornell Box Data,
https://www.graphics.cornell.edu/online/box/data.html. Lengths are in mm, y points up, the camera looks along z.

The box was measured, so it is not quite a box: the left wall's corners are 6.4 mm apart in x, and lie in no plane. Here
it is two triangles, each a receiver of its own, along the diagonal that keeps the inside convex, so that walls never
shadow each other.

What is not the publication's:
* Colours. It gives spectra; the rgb are those that renderers commonly put in their place (the scene of the Tungsten
  renderer, among others).
* The light's radiance. It gives a spectrum without a unit (0 at 400 nm, 8.0 at 500 nm, 15.6 at 600 nm, 18.4 at 700 nm),
  which is orange to the eye. Here it is the warm white that a photographer would make of it, bright enough for a
  picture without the light that comes from walls.
* An ambient radiance, in place of that light: it has no shadow and no shape. 0 gives the direct light alone.
"""

from types import SimpleNamespace

import paraview.simple as pv

from scenes import quad, together

WHITE, RED, GREEN = [0.725, 0.71, 0.68], [0.63, 0.065, 0.05], [0.14, 0.45, 0.091]
RADIANCE = [64.0, 55.0, 42.0]
AMBIENT = [0.26, 0.23, 0.19]

FLOOR = [(552.8, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 559.2), (549.6, 0.0, 559.2)]
CEILING = [(556.0, 548.8, 0.0), (556.0, 548.8, 559.2), (0.0, 548.8, 559.2), (0.0, 548.8, 0.0)]
LIGHT = [(343.0, 548.8, 227.0), (343.0, 548.8, 332.0), (213.0, 548.8, 332.0), (213.0, 548.8, 227.0)]
BACK_WALL = [(549.6, 0.0, 559.2), (0.0, 0.0, 559.2), (0.0, 548.8, 559.2), (556.0, 548.8, 559.2)]
RIGHT_WALL = [(0.0, 0.0, 559.2), (0.0, 0.0, 0.0), (0.0, 548.8, 0.0), (0.0, 548.8, 559.2)]
LEFT_WALL = [(552.8, 0.0, 0.0), (549.6, 0.0, 559.2), (556.0, 548.8, 559.2), (556.0, 548.8, 0.0)]
SHORT_BLOCK_TOP = [(130.0, 165.0, 65.0), (82.0, 165.0, 225.0), (240.0, 165.0, 272.0), (290.0, 165.0, 114.0)]
TALL_BLOCK_TOP = [(423.0, 330.0, 247.0), (265.0, 330.0, 296.0), (314.0, 330.0, 456.0), (472.0, 330.0, 406.0)]

QUAD = [(0, 1, 2, 3)]
TRIANGLE = [(0, 1, 2, 2)]
# Between the outline, points 0 to 3, and the hole, 4 to 7, in which the light is.
FRAME = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
# The top, points 0 to 3, and the sides, down to points 4 to 7 on the floor; a block's bottom is never seen.
BLOCK = QUAD + [(4, 0, 3, 7), (7, 3, 2, 6), (6, 2, 1, 5), (5, 1, 0, 4)]


def block(top):
    return top + [(x, 0.0, z) for x, _, z in top]


SURFACES = {
    "Floor": (FLOOR, QUAD, WHITE), "Ceiling": (CEILING + LIGHT, FRAME, WHITE), "Back wall": (BACK_WALL, QUAD, WHITE),
    "Right wall": (RIGHT_WALL, QUAD, GREEN), "Left wall, back": (LEFT_WALL[:3], TRIANGLE, RED),
    "Left wall, front": (LEFT_WALL[2:] + LEFT_WALL[:1], TRIANGLE, RED),
    "Short block": (block(SHORT_BLOCK_TOP), BLOCK, WHITE), "Tall block": (block(TALL_BLOCK_TOP), BLOCK, WHITE)}


def surface(name, points, polygons):
    return together(name + " polygons", [
        quad(f"{name} {i}", [points[k] for k in polygon]) for i, polygon in enumerate(polygons)])


def build(samples=256, texel_size=2.0, ambient=AMBIENT):
    """Makes the sources and filters; every surface is a receiver.

    samples: of the light; texel_size: in mm; ambient: the radiance that stands for light from walls."""
    receivers = {
        name: pv.ShadowReceiver(
            registrationName=name, Input=surface(name, points, polygons), LightSamples=samples, TexelSize=texel_size,
            Reflectance=reflectance, AmbientRadiance=ambient)
        for name, (points, polygons, reflectance) in SURFACES.items()}
    light = pv.AreaLight(
        registrationName="Light", Origin=LIGHT[0], Point1=LIGHT[1], Point2=LIGHT[3], Radiance=RADIANCE)
    # The published camera: a focal length of 35 mm and a width of 25 mm.
    camera = {
        "CameraPosition": [278, 273, -800], "CameraFocalPoint": [278, 273, 0], "CameraViewUp": [0, 1, 0],
        "CameraViewAngle": 39.3, "ViewSize": [800, 800]}
    return SimpleNamespace(
        receivers=receivers, occluders={}, lights={"Light": light},
        colours={name: [1.0, 1.0, 1.0] for name in SURFACES}, camera=camera)
