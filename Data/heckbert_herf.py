# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Scenes with the counts of the paper's own: P. S. Heckbert, M. Herf: Simulating Soft Shadows with Graphics Hardware,
CMU-CS-97-104, 1997, sections 5 and 6. The paper's models were never published; these are new ones of that size.

| scene      | polygons | receivers | light samples of a receiver            | texels  | the paper's time          |
| still_life | 749      | 3         | 8, on two lights                       | 200 000 | 2 Hz as objects move      |
| chess      | 6 142    | 3         | 32, on two lights                      | 200 000 | 5.5 s                     |
| table      |          | 25        | walls and floor 7x7, top 3x3, legs 2x2 |         | 13 s                      |

The paper leaves blanks: for 6 142 polygons the texels are here those of the first scene; for the table they are 256
along the longest edge, the paper's largest texture. All samples are jittered grids, as the paper's (section 3.7).
Polygons are all that are drawn: receivers, occluders and lights.
"""

from types import SimpleNamespace

import paraview.simple as pv

from scenes import aimed_light, lathe, smooth, together

PATTERN = "Jittered Grid"

# A stage of 600 x 560 x 400 mm, on which small things stand: 300 x 280 + 300 x 200 + 280 x 200 texels are 200 000.
STAGE = (600, 560, 400)
STAGE_TEXEL = 2.0

# Profiles of things that are turned on a lathe: (radius, height) from below, in mm. The bands between are 31 in all.
VASE = [
    (46, 0), (64, 24), (79, 72), (78, 110), (62, 148), (40, 182), (29, 206), (32, 226), (44, 245), (40, 246), (0, 205)]
GOBLET = [(38, 0), (36, 5), (10, 14), (7, 32), (7, 78), (16, 88), (41, 114), (48, 150), (45, 172), (0, 98)]
BOWL = [(40, 0), (38, 12), (70, 28), (98, 56), (110, 85), (105, 86), (60, 34), (0, 24)]
ORANGE = [(12, 0), (31, 14), (36, 34), (30, 54), (16, 66), (0, 70)]
SEGMENTS = 24

# Chess pieces, in a unit of 2.1 mm: 17 of 19 bands of 19 polygons are 6 137.
KING = [
    (19, 0), (19.5, 3), (19, 7), (15.5, 10), (14.5, 13), (12, 18), (9, 30), (7.8, 44), (7.5, 56), (13, 60), (13, 63),
    (8.5, 65), (9.5, 74), (12.5, 87), (11.5, 89.5), (5, 93.5), (3, 97), (4.8, 100), (3.6, 104), (0, 106)]
QUEEN = [
    (19, 0), (19.5, 3), (19, 7), (15.5, 10), (14.5, 13), (12, 18), (9, 28), (7.6, 40), (7, 50), (12.5, 54), (12.5, 57),
    (8, 59), (9.2, 68), (13.5, 79), (11.5, 79.5), (8, 82), (4, 84.5), (4.4, 88), (2.8, 91), (0, 92)]
BISHOP = [
    (17, 0), (17.5, 3), (17, 6), (14, 8.5), (13, 11), (10.5, 16), (8, 24), (7, 32), (6.5, 40), (11, 43.5), (11, 46),
    (6.5, 48), (8.4, 53), (9.2, 58), (8.6, 63), (6.6, 68.5), (3.6, 73), (3.6, 75.5), (2.6, 78), (0, 79)]
ROOK = [
    (17, 0), (17.5, 3), (17, 6), (14, 8.5), (13, 11), (11, 16), (9.5, 24), (8.8, 32), (8.5, 40), (12, 44), (12, 46),
    (9.8, 48), (13, 51), (13.2, 56), (13, 62), (11.5, 62.4), (9.5, 62), (9.5, 56), (5, 55.5), (0, 55.5)]
PAWN = [
    (15, 0), (15.4, 2.5), (15, 5), (12.5, 7), (11.5, 9), (9.5, 13), (7.5, 19), (6.3, 24), (5.8, 28), (9.5, 31),
    (9.5, 33), (5.5, 34.5), (7.4, 37.5), (8.5, 41.5), (8.4, 44.5), (7.4, 47.5), (5.8, 49.8), (3.8, 51.3),
    (1.9, 51.9), (0, 52)]
CHESS_SEGMENTS = 19
CHESS_UNIT = 2.1
SQUARE = 70  # mm; the board's 8 x 8 squares are as deep as the stage

# The table's room, in cm.
ROOM = (400, 360, 270)
ROOM_TEXEL = 400 / 256
TABLE_TOP = (180, 95, 4)
TABLE_HEIGHT = 76
TABLE_CENTER = (150, 265)
LEG = [(3.2, 0), (5.2, TABLE_HEIGHT - TABLE_TOP[2])]


def still_life():
    """Four things on a stage, for moving one of them: 749 polygons, 4 samples of each of two lights."""
    things = {
        "Vase": (VASE, 190, 340, 0), "Goblet": (GOBLET, 430, 330, 0), "Bowl": (BOWL, 315, 190, 0),
        "Orange": (ORANGE, 480, 170, 0)}
    occluders = {name: turned(name, [piece], SEGMENTS) for name, piece in things.items()}
    colours = {
        "Vase": [0.36, 0.55, 0.68], "Goblet": [0.85, 0.80, 0.62], "Bowl": [0.78, 0.42, 0.32],
        "Orange": [0.95, 0.60, 0.22]}
    return stage(samples=4, occluders=occluders, colours=colours)


def chess():
    """An endgame of 17 pieces: 6 142 polygons, 16 samples of each of two lights."""
    pieces = {
        "Ivory king": [(KING, 5, 3)],
        "Ivory": [
            (QUEEN, 3, 3), (ROOK, 6, 4), (BISHOP, 2, 5), (ROOK, 4, 1), (PAWN, 1, 2), (PAWN, 5, 2), (PAWN, 6, 1),
            (PAWN, 4, 4)],
        "Walnut": [
            (KING, 4, 6), (QUEEN, 6, 6), (ROOK, 1, 6), (BISHOP, 5, 5), (PAWN, 3, 5), (PAWN, 2, 4), (PAWN, 0, 4),
            (PAWN, 7, 5)]}
    occluders = {
        name: turned(name, [on_square(*piece) for piece in group], CHESS_SEGMENTS) for name, group in pieces.items()}
    colours = {"Ivory king": [0.95, 0.90, 0.78], "Ivory": [0.95, 0.90, 0.78], "Walnut": [0.42, 0.26, 0.18]}
    return stage(samples=16, occluders=occluders, colours=colours)


def on_square(profile, column, row):
    """A chess piece in the middle of a square."""
    profile = scaled(profile, CHESS_UNIT)
    return profile, (STAGE[0] - 8 * SQUARE) / 2 + (column + 0.5) * SQUARE, (row + 0.5) * SQUARE, 0


def scaled(profile, factor):
    return [(radius * factor, height * factor) for radius, height in profile]


def turned(name, pieces, segments):
    """Things that look round, as one surface; each a profile and the x, y, z where it stands."""
    parts = [lathe(f"{name} {i}", profile, segments, place) for i, (profile, *place) in enumerate(pieces)]
    return smooth(name, together(name + " as one", parts), sharpest=50)


def stage(samples, occluders, colours):
    """A floor and two walls under a warm light from the right and a cool one from the left."""
    lights = {
        "Warm light": aimed_light("Warm light", [720, -120, 620], [250, 330, 60], 120, [92.0, 80.0, 62.0]),
        "Cool light": aimed_light("Cool light", [210, -420, 560], [330, 330, 60], 150, [44.0, 55.0, 70.0])}
    camera = {
        "CameraPosition": [700, -830, 560], "CameraFocalPoint": [292, 262, 118], "CameraViewUp": [0, 0, 1],
        "CameraViewAngle": 24}
    colours = dict(
        colours, **{"Floor": [0.82, 0.76, 0.66], "Back wall": [0.86, 0.84, 0.80], "Side wall": [0.70, 0.76, 0.80]})
    return SimpleNamespace(
        receivers=make_walls(STAGE, STAGE_TEXEL, samples), occluders=occluders, lights=lights, colours=colours,
        camera=camera)


def make_walls(size, texel_size, samples):
    """A floor, the wall at its back and the wall at its left: they face into the room."""
    x, y, z = size
    corners = {
        "Floor": ([0, 0, 0], [x, 0, 0], [0, y, 0]), "Back wall": ([0, y, 0], [x, y, 0], [0, y, z]),
        "Side wall": ([0, 0, 0], [0, y, 0], [0, 0, z])}
    return {
        name: receiver(
            name, pv.Plane(
                registrationName=name + " plane", Origin=origin, Point1=point1, Point2=point2, XResolution=1,
                YResolution=1),
            texel_size, samples)
        for name, (origin, point1, point2) in corners.items()}


def receiver(name, source, texel_size, samples):
    return pv.ShadowReceiver(
        registrationName=name, Input=source, LightSamples=samples, SamplingPattern=PATTERN, TexelSize=texel_size,
        AmbientRadiance=[0.12, 0.13, 0.15])


def table():
    """A laid table, all of whose 22 faces receive shadows: 25 receivers with the floor and two walls."""
    x, y = TABLE_CENTER
    width, depth, thickness = TABLE_TOP
    top = pv.Box(
        registrationName="Table top box", XLength=width, YLength=depth, ZLength=thickness,
        Center=[x, y, TABLE_HEIGHT - thickness / 2])
    legs = together("Four legs", [
        lathe(f"Leg {i}", LEG, 4, (x + sx * (width / 2 - 8), y + sy * (depth / 2 - 8), 0))
        for i, (sx, sy) in enumerate(((-1, -1), (1, -1), (1, 1), (-1, 1)))])
    receivers = make_walls(ROOM, ROOM_TEXEL, samples=49)
    receivers["Table top"] = receiver("Table top", top, ROOM_TEXEL, samples=9)
    receivers["Table legs"] = receiver("Table legs", legs, ROOM_TEXEL, samples=4)
    places = {
        "Vase": (VASE, [(x - 45, y + 12)]), "Bowl": (BOWL, [(x + 20, y + 5)]),
        "Goblet": (GOBLET, [(x + 62, y + 18), (x - 12, y - 28)]),
        "Orange": (ORANGE, [(x + 55, y - 20), (x + 42, y - 30)])}
    occluders = {
        name: turned(name, [(scaled(profile, 0.16), *at, TABLE_HEIGHT) for at in group], SEGMENTS)
        for name, (profile, group) in places.items()}
    lights = {"Lamp": aimed_light("Lamp", [330, 50, 310], [140, 280, 60], 70, [88.0, 80.0, 67.0])}
    colours = {
        "Floor": [0.76, 0.66, 0.54], "Back wall": [0.86, 0.84, 0.78], "Side wall": [0.66, 0.74, 0.72],
        "Table top": [0.80, 0.56, 0.38], "Table legs": [0.80, 0.56, 0.38], "Vase": [0.36, 0.55, 0.68],
        "Goblet": [0.85, 0.80, 0.62], "Bowl": [0.78, 0.42, 0.32], "Orange": [0.95, 0.60, 0.22]}
    camera = {
        "CameraPosition": [520, -330, 235], "CameraFocalPoint": [135, 262, 70], "CameraViewUp": [0, 0, 1],
        "CameraViewAngle": 22}
    return SimpleNamespace(receivers=receivers, occluders=occluders, lights=lights, colours=colours, camera=camera)
