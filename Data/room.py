# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A room with the Stanford bunny in it: a floor and two walls under a ceiling lamp.

For pvpython, after LoadPlugin() of Penumbra:

    import room
    scene = room.build()
    view = room.show(scene)
"""

from pathlib import Path
from types import SimpleNamespace

import paraview.simple as pv

AMBIENT = [0.13, 0.14, 0.17]
WALLS = {  # corner, end of the first edge, end of the second edge: they face into the room
    "Floor": ([-12, -12, 0], [12, -12, 0], [-12, 12, 0]),
    "Back wall": ([-12, 12, 0], [12, 12, 0], [-12, 12, 16]),
    "Side wall": ([-12, -12, 0], [-12, 12, 0], [-12, -12, 16]),
}
COLOURS = {
    "Floor": [0.80, 0.72, 0.62], "Back wall": [0.88, 0.86, 0.82], "Side wall": [0.62, 0.72, 0.80],
    "Pedestal": [0.75, 0.55, 0.45]}


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
    normals = getattr(pv, "SurfaceNormals", None) or pv.GenerateSurfaceNormals  # renamed by ParaView 5.13
    smooth = normals(registrationName="Smooth bunny", Input=bunny)
    box = pv.Box(registrationName="Box", XLength=12, YLength=9, ZLength=1.0, Center=[0, 0, 0.5])
    receivers["Pedestal"] = pv.ShadowReceiver(  # six receivers, one a face
        registrationName="Pedestal", Input=box, LightSamples=samples, TexelSize=texel_size,
        AmbientRadiance=AMBIENT)
    raised = pv.Transform(registrationName="Raised bunny", Input=smooth)
    raised.Transform.Translate = [0, 0, 1.0]
    lamp = pv.AreaLight(
        registrationName="Lamp", Origin=[4, -11, 15.9], Point1=[4, -6, 15.9], Point2=[9, -11, 15.9],
        Radiance=[42.0, 38.0, 31.0])
    return SimpleNamespace(receivers=receivers, occluders=[raised], lights=[lamp])


def show(scene, size=(1200, 800), shading="Radiance"):
    """Shows the scene in a new render view, and answers the view."""
    view = pv.CreateView("RenderView")
    view.ViewSize = size
    view.UseColorPaletteForBackground = 0
    view.Background = [0.16, 0.17, 0.19]
    view.OrientationAxesVisibility = 0
    for name, receiver in scene.receivers.items():
        display = pv.Show(receiver, view)
        display.DiffuseColor = COLOURS[name]
        display.ShadowShading = shading
    for occluder in scene.occluders:
        pv.Show(occluder, view).DiffuseColor = [0.92, 0.88, 0.82]
    for light in scene.lights:
        display = pv.Show(light, view)
        display.Ambient, display.Diffuse = 1.0, 0.0  # a lamp is bright by itself
    view.CameraPosition = [26, -36, 20]
    view.CameraFocalPoint = [-1.5, 0.5, 6.2]
    view.CameraViewUp = [0, 0, 1]
    view.CameraViewAngle = 32
    return view
