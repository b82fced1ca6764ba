# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The view and the filter RadianceMap run the same bake: the same scene gives the same texels, bit for bit."""
import numpy
from paraview import simple

from penumbra_testing import Checks, bake, cell_array, data_path, load_plugin, texels_of_view

checks = Checks()


def make_room():
    """A floor, a wall and a box as receivers, each with settings of its own."""
    floor = simple.Plane(Origin=[-8, -8, 0], Point1=[8, -8, 0], Point2=[-8, 8, 0], XResolution=7, YResolution=3)
    wall = simple.Plane(Origin=[8, -8, 0], Point1=[8, 8, 0], Point2=[8, -8, 12])
    box = simple.Box(XLength=2, YLength=2, ZLength=2, Center=[-5, -5, 1])
    return [
        simple.ShadowReceiver(
            Input=floor, TexelSize=0.1, LightSamples=96, Reflectance=[0.7, 0.3, 1], AmbientRadiance=[0.05, 0, 0.1]),
        simple.ShadowReceiver(Input=wall, TexelSize=0.25, SamplingPattern="Correlated Multi-Jittered", Seed=7),
        simple.ShadowReceiver(Input=box, TexelSize=0.1, LightSamples=33, Supersampling=2, SampleMultiplier=1.5)]


def make_occluders():
    """A mesh, and composite data with an implicit position."""
    bunny = simple.XMLPolyDataReader(FileName=data_path("bunny.vtp"))
    group = simple.GroupDatasets(Input=[simple.Sphere(Center=[5, 4, 3]), simple.Cone(Center=[4, -5, 2], Height=3)])
    return [simple.Transform(Input=bunny), group]


def make_lights():
    return [
        simple.AreaLight(Origin=[1, -1, 16], Point1=[1, 1, 16], Point2=[3, -1, 16], Radiance=[20, 10, 5]),
        simple.AreaLight(
            Shape="Triangle", Origin=[-7, -1, 6], Point1=[-7, 1, 6], Point2=[-6, 0, 8], Radiance=[1, 3, 9], TwoSided=1)]


def radiance_of_view(receivers, others):
    """The radiance of each receiver of a view, from the texels of its pass: H&H 1997, eq. 1, in single precision."""
    view = simple.CreateView("RenderView")
    for proxy in receivers + others:
        simple.Show(proxy, view)
    simple.ResetCamera(view)
    simple.Render(view)
    return texels_of_view(view)


def settings_of_blocks(receivers):
    """Reflectance and ambient radiance of each block: a floor, a wall, six faces."""
    for receiver, blocks in zip(receivers, (1, 1, 6)):
        for _ in range(blocks):
            yield numpy.float32(receiver.Reflectance), numpy.float32(receiver.AmbientRadiance)


def check_same_texels():
    receivers, occluders, lights = make_room(), make_occluders(), make_lights()
    blocks = bake(receivers, occluders, lights)
    shown = radiance_of_view(receivers, occluders + lights)
    checks.equal(len(shown), len(blocks), "receivers of the view")
    shadowed = 0
    for i, (grid, irradiance, (reflectance, ambient)) in enumerate(zip(blocks, shown, settings_of_blocks(receivers))):
        radiance = cell_array(grid, "Radiance").reshape(-1, 3)
        same = radiance.tobytes() == (reflectance * (ambient + irradiance)).tobytes()
        checks.check(same, f"receiver {i}: {len(radiance)} texels, view and filter the same to the bit")
        shadowed += numpy.count_nonzero(cell_array(grid, "Visibility") < 1)
    checks.at_least(shadowed, 10000, "texels that lie in some shadow")


load_plugin()
check_same_texels()
checks.finish()
