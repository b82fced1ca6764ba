# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Translucent displays weaken light, Shadow Caster says how much passes, and what casts no shadow is as if absent."""
import os

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

from penumbra_testing import Checks, bake, cell_array, find_pass, make_scene, make_view, picture, texels_of_view

checks = Checks()

# Sums of 64 weights in single precision, 32 at a time: 34 roundings of 6e-8, in each of three bakes.
ROUNDING = 34 * 3 * 6e-8


def make():
    scene = make_scene(texel_size=0.1)
    scene.receiver.Reconstruction = 0  # shares are then sums over samples, and nothing else
    return scene, make_view(scene)


def shown_texels(shown):
    picture(shown.view)
    (texels,) = texels_of_view(shown.view)
    return texels.copy()


def deviation(found, wanted):
    return float(numpy.abs(found - wanted).max() / wanted.max())


def check_display():
    """Opacity and colour of a display: what passes is a share of what an opaque one blocks."""
    _, shown = make()
    opaque = shown_texels(shown)
    shown.occluder.Visibility = 0
    without = shown_texels(shown)
    shown.occluder.Visibility = 1
    checks.check(deviation(opaque, without) > 0.5, "an opaque sphere casts a shadow")

    for opacity in (0.25, 0.75):
        shown.occluder.Opacity = opacity
        wanted = opaque + (1 - opacity) * (without - opaque)
        checks.at_most(deviation(shown_texels(shown), wanted), ROUNDING, f"opacity {opacity}")

    shown.occluder.DiffuseColor = [0.8, 0.4, 0.0]
    shown.occluder.Opacity = 0.5
    passing = 0.5 * (0.5 + 0.5 * numpy.array([1, 0.5, 0]))
    checks.at_most(
        deviation(shown_texels(shown), opaque + passing * (without - opaque)), ROUNDING, "a tinted shadow")

    shown.occluder.Opacity = 1
    checks.check((shown_texels(shown) == opaque).all(), "opacity 1 is opaque")
    shown.occluder.Opacity = 0
    checks.check((shown_texels(shown) == without).all(), "opacity 0 is absent")


def check_scalars():
    """Coloured by an array, a display weakens all components alike."""
    scene, shown = make()
    simple.ColorBy(shown.occluder, ("POINTS", "Normals"))
    shown.occluder.Opacity = 0.5
    shown.occluder.DiffuseColor = [1, 0, 0]
    found = shown_texels(shown)
    checks.check((found[:, 0] == found[:, 2]).all(), "no tint from an array's colours")
    simple.ColorBy(shown.occluder, None)
    found = shown_texels(shown)
    checks.check((found[:, 0] > found[:, 2]).any(), "the tint of a display's own colour")


def make_texture(name, alphas):
    """A white picture whose columns have these alphas, 0 to 255, as a texture."""
    image = vtkImageData()
    image.SetDimensions(len(alphas), 2, 1)
    texels = numpy.full((2, len(alphas), 4), 255, numpy.uint8)
    texels[:, :, 3] = alphas
    image.GetPointData().SetScalars(numpy_to_vtk(texels.reshape(-1, 4), deep=1))
    writer = vtkPNGWriter()
    writer.SetFileName(os.path.join(os.environ["PENUMBRA_TEST_OUTPUT"], name + ".png"))
    writer.SetInputData(image)
    writer.Write()
    return simple.CreateTexture(writer.GetFileName())


def check_texture():
    """A display casts what its texture's alpha leaves of it, and as much of that."""
    _, shown = make()
    shown.occluder.Visibility = 0
    without = shown_texels(shown)
    plate = simple.Plane(Origin=[-1, -1, 1], Point1=[1, -1, 1], Point2=[-1, 1, 1])
    display = simple.Show(plate, shown.view)
    opaque = shown_texels(shown)
    checks.check(deviation(opaque, without) > 0.5, "a plate casts a shadow")
    display.Texture = make_texture("half", [128, 128])
    wanted = opaque + (1 - 128 / 255) * (without - opaque)
    checks.at_most(deviation(shown_texels(shown), wanted), ROUNDING, "an alpha of a half")
    display.Texture = make_texture("left", [255, 0])
    left = shown_texels(shown)
    simple.Hide(plate, shown.view)
    simple.Show(simple.Plane(Origin=[-1, -1, 1], Point1=[0, -1, 1], Point2=[-1, 1, 1]), shown.view)
    wanted = shown_texels(shown)
    checks.check(deviation(wanted, opaque) > 0.5, "half a plate casts another shadow")
    # A sample that passes an edge on the other side by a rounding weighs 1/64, or somewhat more where it is nearer.
    checks.at_most(deviation(left, wanted), 1.5 / 64, "a plate, half of it cut out")


def show_through_caster(scene, shown, **properties):
    """The sphere through a filter, in the sphere's place."""
    caster = simple.ShadowCaster(Input=scene.sphere, **properties)
    shown.occluder.Visibility = 0
    return caster, simple.Show(caster, shown.view)


def check_caster():
    """The filter in the view and in Radiance Map, whatever the data's type."""
    scene, shown = make()
    opaque = shown_texels(shown)
    shown.occluder.Opacity = 0.5
    half = shown_texels(shown)
    shown.occluder.Visibility = 0
    without = shown_texels(shown)

    caster, display = show_through_caster(scene, shown)
    checks.check((shown_texels(shown) == opaque).all(), "Shadow Caster's defaults change nothing")
    display.Opacity = 0.5
    checks.check((shown_texels(shown) == half).all(), "nor do they with a translucent display")
    caster.UseTransmittance = 1
    display.Opacity = 1
    checks.check((shown_texels(shown) == half).all(), "a transmittance of 0.5 is an opacity of 0.5")
    (grid,) = bake([scene.receiver], [caster], [scene.light])
    checks.check(
        (cell_array(grid, "Radiance").reshape(-1, 3) == half).all(), "Radiance Map gives the view's texels")
    caster.CastShadow = 0
    checks.check((shown_texels(shown) == without).all(), "without CastShadow, the sphere is as if absent")
    (grid,) = bake([scene.receiver], [caster], [scene.light])
    checks.check((cell_array(grid, "Radiance").reshape(-1, 3) == without).all(), "for Radiance Map, too")

    simple.Hide(caster, shown.view)
    for make_other in (lambda: simple.GroupDatasets(Input=[scene.sphere]), lambda: simple.Tetrahedralize(scene.sphere)):
        other = simple.ShadowCaster(Input=make_other(), CastShadow=0)
        simple.Show(other, shown.view)
        checks.check(
            (shown_texels(shown) == without).all(), f"CastShadow off, on a {other.GetDataInformation().GetDataSetTypeAsString()}")
        other.CastShadow = 1
        checks.check((shown_texels(shown) != without).any(), "and on")
        simple.Hide(other, shown.view)


def check_receiver():
    """A receiver that casts no shadow receives as before."""
    scene, shown = make()
    alone = shown_texels(shown)
    table = simple.Plane(Origin=[-4, -4, 1], Point1=[0, -4, 1], Point2=[-4, 0, 1])
    receiver = simple.ShadowReceiver(Input=table, TexelSize=0.1)
    simple.Show(receiver, shown.view)
    picture(shown.view)
    floor, top = (texels.copy() for texels in texels_of_view(shown.view))
    checks.check((floor != alone).any(), "a table casts its shadow on the floor")
    receiver.CastShadow = 0
    picture(shown.view)
    floor, same_top = (texels.copy() for texels in texels_of_view(shown.view))
    checks.check((floor == alone).all(), "without CastShadow it casts none")
    checks.check((same_top == top).all(), "and receives what it did")
    checks.equal(find_pass(shown.view).GetNumberOfReceivers(), 2, "receivers")


checks.run([check_display, check_scalars, check_texture, check_caster, check_receiver])
