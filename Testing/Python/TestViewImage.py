# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a bunny on a floor in ParaView's view, with ambient occlusion and a scalar bar, against a baseline.

Called with the argument `--update`, the test writes the baseline anew.
"""
import sys
import xml.etree.ElementTree

from paraview import simple
from vtkmodules.vtkTestingRendering import vtkTesting

from penumbra_testing import PLAIN, Checks, data_path, load_plugin, output_path

BASELINE = "Baseline/ViewWithAmbientOcclusion.png"
SIZE = [400, 300]
# vtkTesting's own default: the sum over pixels of what remains of the difference beyond 105 levels (of 765) after a
# shift by up to a pixel, in units of full intensity. Other releases of Mesa move edges by less than a pixel, and leave
# nothing; of the scalar bar's text, 40 pixels high and wide, a few pixels at most. A missing shadow leaves hundreds.
TOLERANCE = 10

checks = Checks()


def draw():
    """A bunny on a floor that is coloured by its height along x."""
    floor = simple.Plane(Origin=[-12, -12, 0], Point1=[12, -12, 0], Point2=[-12, 12, 0])
    coloured = simple.Elevation(Input=floor, LowPoint=[-12, 0, 0], HighPoint=[12, 0, 0])
    receiver = simple.ShadowReceiver(Input=coloured, LightSamples=256, AmbientRadiance=[0.05] * 3)
    bunny = simple.XMLPolyDataReader(FileName=data_path("bunny.vtp"))
    light = simple.AreaLight(Origin=[5, -2, 14], Point1=[5, 2, 14], Point2=[9, -2, 14], Radiance=[20] * 3)
    view = simple.CreateView("RenderView")
    view.ViewSize = SIZE
    view.UseFXAA = 0
    view.UseAmbientOcclusion = 1
    view.OrientationAxesVisibility = 0  # text is drawn otherwise by other releases of FreeType
    display = simple.Show(receiver, view)
    simple.ColorBy(display, ("POINTS", "Elevation"))
    display.SetScalarBarVisibility(view, True)
    for source in (bunny, light):
        simple.Show(source, view)
    view.CameraPosition = [10, -34, 24]
    view.CameraFocalPoint = [0, 0, 3]
    view.CameraViewUp = [0, 0, 1]
    return view, display


def image_error(view, name):
    """What VTK's regression test says of the view's picture: whether it passes, and by what error."""
    path = output_path(name)
    simple.SaveScreenshot(path, view, ImageResolution=SIZE)
    testing = vtkTesting()
    for argument in ("-T", output_path(""), "-V", data_path(BASELINE)):
        testing.AddArgument(argument)
    passed = testing.RegressionTest(path, TOLERANCE) == vtkTesting.PASSED
    return passed, testing.GetImageDifference()


def check_image():
    view, display = draw()
    if "--update" in sys.argv:
        simple.SaveScreenshot(data_path(BASELINE), view, ImageResolution=SIZE)
    passed, error = image_error(view, "TestViewImage.png")
    checks.check(passed, f"the picture is the baseline: error {error:.4g}, at most {TOLERANCE}")
    display.Representation = PLAIN
    print("The next comparison is to fail:", flush=True)
    passed, error = image_error(view, "TestViewImagePlain.png")
    checks.check(not passed, f"without shadows it is not: error {error:.4g}, more than {TOLERANCE}")


def check_model():
    """What is not well-formed XML can only be read with an expat that hands out tokens at once: see Data/README.md."""
    root = xml.etree.ElementTree.parse(data_path("bunny.vtp")).getroot()
    checks.equal(root.tag, "VTKFile", "the bunny is well-formed XML")


load_plugin()
check_model()
check_image()
checks.finish()
