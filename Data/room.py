# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A room with the Stanford bunny in it: a floor and two walls under a ceiling lamp.

For pvpython, after LoadPlugin() of Penumbra:

    import room, scenes
    scene = room.build()
    view = scenes.show(scene)
"""

from pathlib import Path
from types import SimpleNamespace

import paraview.simple as pv

from scenes import smooth

AMBIENT = [0.13, 0.14, 0.17]
WALLS = {  # corner, end of the first edge, end of the second edge: they face into the room
    "Floor": ([-12, -12, 0], [12, -12, 0], [-12, 12, 0]),
    "Back wall": ([-12, 12, 0], [12, 12, 0], [-12, 12, 16]),
    "Side wall": ([-12, -12, 0], [-12, 12, 0], [-12, -12, 16]),
}
COLOURS = {
    "Floor": [0.80, 0.72, 0.62], "Back wall": [0.88, 0.86, 0.82], "Side wall": [0.62, 0.72, 0.80],
    "Pedestal": [0.75, 0.55, 0.45], "Raised bunny": [0.92, 0.88, 0.82]}


def read_bunny():
    path = Path(__file__).resolve().parent / "bunny.vtp"
    bunny = pv.XMLPolyDataReader(registrationName="Bunny", FileName=[str(path)])
    bunny.UpdatePipeline()
    if bunny.GetDataInformation().GetNumberOfCells() == 0:  # ParaView says why, and goes on
        raise RuntimeError(f"{path} cannot be read")
    return bunny


def build(samples=256, texel_size=24 / 512):
    """Makes the sources and filters: receivers (by name), occluders and lights.

    samples: per light; texel_size: in units of the scene, whose bunny is 9.7 high."""
    receivers = {}
    for name, (corner, point1, point2) in WALLS.items():
        plane = pv.Plane(registrationName=name + " plane", Origin=corner, Point1=point1, Point2=point2)
        receivers[name] = pv.ShadowReceiver(
            registrationName=name, Input=plane, LightSamples=samples, TexelSize=texel_size,
            AmbientRadiance=AMBIENT)
    bunny = read_bunny()
    box = pv.Box(registrationName="Box", XLength=12, YLength=9, ZLength=1.0, Center=[0, 0, 0.5])
    receivers["Pedestal"] = pv.ShadowReceiver(  # six receivers, one a face
        registrationName="Pedestal", Input=box, LightSamples=samples, TexelSize=texel_size,
        AmbientRadiance=AMBIENT)
    raised = pv.Transform(registrationName="Raised bunny", Input=smooth("Smooth bunny", bunny))
    raised.Transform.Translate = [0, 0, 1.0]
    lamp = pv.AreaLight(
        registrationName="Lamp", Origin=[4, -11, 15.9], Point1=[4, -6, 15.9], Point2=[9, -11, 15.9],
        Radiance=[42.0, 38.0, 31.0])
    camera = {
        "CameraPosition": [26, -36, 20], "CameraFocalPoint": [-1.5, 0.5, 6.2], "CameraViewUp": [0, 0, 1],
        "CameraViewAngle": 32}
    return SimpleNamespace(
        receivers=receivers, occluders={"Raised bunny": raised}, lights={"Lamp": lamp}, colours=COLOURS, camera=camera)
