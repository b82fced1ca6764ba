# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the plugin share: the plugin itself, a scene, pictures and texels as arrays, messages, checks.

The environment says where things are: PENUMBRA_PLUGIN names the plugin's library, PENUMBRA_DATA the folder Data,
PENUMBRA_TEST_OUTPUT a folder to write to, and PYTHONPATH holds the package `penumbra`. CMakeLists.txt sets all of them.
"""
import os
import sys
from types import SimpleNamespace

import numpy
from paraview import servermanager, simple
from penumbra.PenumbraRendering import vtkSoftShadowPass
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

SHADOWED = "Soft Shadow Receiver"
PLAIN = "Surface"

# The scene of make_scene(), for oracles that know it without asking the product.
FLOOR_HALF = 5.0
SPHERE_CENTER = (0.0, 0.0, 1.5)
SPHERE_RADIUS = 1.0


def load_plugin():
    simple.LoadPlugin(os.environ["PENUMBRA_PLUGIN"])
    simple._DisableFirstRenderCameraReset()  # cameras are where the tests put them


def data_path(name):
    return os.path.join(os.environ["PENUMBRA_DATA"], name)


def output_path(name):
    return os.path.join(os.environ["PENUMBRA_TEST_OUTPUT"], name)


class Checks:
    """Prints each check as it is made, and ends the script with status 1 if any failed."""

    def __init__(self):
        self.failed = []

    def check(self, holds, what):
        print(("ok      " if holds else "FAILED  ") + what, flush=True)
        if not holds:
            self.failed.append(what)

    def equal(self, found, wanted, what):
        self.check(found == wanted, f"{what}: {found}, wanted {wanted}")

    def at_most(self, found, limit, what):
        self.check(found <= limit, f"{what}: {found:.4g}, at most {limit:.4g}")

    def at_least(self, found, limit, what):
        self.check(found >= limit, f"{what}: {found:.4g}, at least {limit:.4g}")

    def run(self, cases):
        """Calls each case, or those that the script's arguments name, with nothing left of the one before; then ends
        the script."""
        load_plugin()
        for case in cases:
            if len(sys.argv) < 2 or case.__name__ in sys.argv[1:]:
                case()
                simple.ResetSession()
                load_plugin()
        self.finish()

    def finish(self):
        print(f"{len(self.failed)} checks failed.", flush=True)
        sys.exit(1 if self.failed else 0)


class Messages:
    """Collects what VTK and ParaView say, errors and warnings, within a `with` block."""

    def __enter__(self):
        self.window = vtkStringOutputWindow()
        self.before = vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.before)

    def get(self):
        """The messages one by one, without the lines that say where in the sources they come from."""
        return [part.strip() for part in self.window.GetOutput().split("\n\n") if part.strip()]


def make_scene(texel_size=0.05, light_samples=64, radiance=(1.0, 1.0, 1.0)):
    """A sphere that hovers over a floor in the plane z = 0, under a square light that shines down from one side."""
    floor = simple.Plane(
        Origin=[-FLOOR_HALF, -FLOOR_HALF, 0], Point1=[FLOOR_HALF, -FLOOR_HALF, 0], Point2=[-FLOOR_HALF, FLOOR_HALF, 0],
        XResolution=10, YResolution=10)
    receiver = simple.ShadowReceiver(Input=floor, TexelSize=texel_size, LightSamples=light_samples)
    sphere = simple.Sphere(Center=SPHERE_CENTER, Radius=SPHERE_RADIUS, ThetaResolution=40, PhiResolution=40)
    light = simple.AreaLight(Origin=[1, -1, 6], Point1=[1, 1, 6], Point2=[3, -1, 6], Radiance=radiance)
    return SimpleNamespace(floor=floor, receiver=receiver, sphere=sphere, light=light)


def make_view(scene, size=(400, 300)):
    """A view of the whole scene, and the displays in it; without FXAA, so that a pixel shows one surface."""
    view = simple.CreateView("RenderView")
    view.ViewSize = size
    for each in simple.GetRenderViews():
        each.UseFXAA = 0  # a new view switches it on in the others too
    display = simple.Show(scene.receiver, view)
    occluder = simple.Show(scene.sphere, view)
    light = simple.Show(scene.light, view)
    view.CameraPosition = [8, -14, 8]
    view.CameraFocalPoint = [0, 0, 0.5]
    view.CameraViewUp = [0, 0, 1]
    return SimpleNamespace(view=view, receiver=display, occluder=occluder, light=light)


def translation_name(display):
    """The name of the display's property that moves what it shows: `Translation` since ParaView 5.13, where the older
    `Position` is refused; before it, `Position`."""
    return "Translation" if "Translation" in display.ListProperties() else "Position"


def translate(display, offset):
    """Moves what the display shows from where its data are by `offset`, three coordinates."""
    display.SetPropertyWithName(translation_name(display), offset)


def bake(receivers, occluders=(), lights=()):
    """The blocks of a RadianceMap of these proxies."""
    output = radiance_map(receivers, occluders, lights)
    return [output.GetBlock(i) for i in range(output.GetNumberOfBlocks())]


def radiance_map(receivers, occluders=(), lights=()):
    """What the filter RadianceMap makes of these proxies."""
    baker = simple.RadianceMap(Receivers=list(receivers), Occluders=list(occluders), Lights=list(lights))
    baker.UpdatePipeline()
    output = servermanager.Fetch(baker)
    simple.Delete(baker)
    return output


def texels(grid):
    """How many rows and columns of texels a block has."""
    dimensions = [0, 0, 0]
    grid.GetDimensions(dimensions)
    return dimensions[1] - 1, dimensions[0] - 1


def cell_array(grid, name):
    """A cell array with the shape (rows, columns) or (rows, columns, components)."""
    array = vtk_to_numpy(grid.GetCellData().GetArray(name))
    return array.reshape(texels(grid) + array.shape[1:])


def grid_points(grid):
    """The corners of the texels, with the shape (rows + 1, columns + 1, 3)."""
    rows, columns = texels(grid)
    return vtk_to_numpy(grid.GetPoints().GetData()).reshape(rows + 1, columns + 1, 3)


def cell_centers(grid):
    points = grid_points(grid)
    return (points[:-1, :-1] + points[1:, 1:]) / 2


def form_factor(points, normal, polygon):
    """Lambert's edge formula: the form factor at each point of a polygon that lies above the receiver. `polygon` has
    the shape (corners, 3), or one for each point; corners at the same place make an edge of no length."""
    rays = polygon - points[..., None, :]
    rays /= numpy.linalg.norm(rays, axis=-1, keepdims=True)
    following = numpy.roll(rays, -1, axis=-2)
    cross = numpy.cross(rays, following)
    sine = numpy.linalg.norm(cross, axis=-1)
    angle = numpy.arctan2(sine, (rays * following).sum(-1))
    # An edge of no length has the angle 0 and adds nothing; the quotient's limit is 1.
    quotient = numpy.divide(angle, sine, out=numpy.ones_like(sine), where=sine > 0)
    return numpy.abs((quotient * (cross @ normal)).sum(-1)) / (2 * numpy.pi)


def picture(view):
    """What the view draws now, as bytes with the shape (height, width, 3); row 0 is the lowest."""
    simple.Render(view)
    return image_of_window(view)


def image_of_window(view):
    """What the view has drawn last, as picture() gives it."""
    grab = vtkWindowToImageFilter()
    grab.SetInput(view.GetRenderWindow())
    grab.SetReadFrontBuffer(False)
    grab.SetShouldRerender(False)
    grab.Update()
    return image_bytes(grab.GetOutput())


def image_bytes(image):
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[:, :, :3].copy()


def find_pass(view):
    """The view's vtkSoftShadowPass: one of the passes that its renderer delegates to, or None."""
    current = view.GetClientSideObject().GetRenderer().GetPass()
    while current and not isinstance(current, vtkSoftShadowPass):
        current = current.GetDelegatePass() if hasattr(current, "GetDelegatePass") else None
    return current


def texels_of_view(view):
    """Of each receiver that the view shades, the irradiance over pi of its texels, with the shape (texels, 3)."""
    shadows = find_pass(view)
    view.GetRenderWindow().MakeCurrent()
    return [vtk_to_numpy(shadows.GetTexels(i))[:, :3] for i in range(shadows.GetNumberOfReceivers())]
