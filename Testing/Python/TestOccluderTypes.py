# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Whatever a view shows as a surface is an occluder of the filter RadianceMap, whatever the type of its data: both give
the same texels, bit for bit. What has no surface is said, once."""
from paraview import simple
from vtkmodules.vtkCommonDataModel import vtkAMRBox, vtkOverlappingAMR, vtkUniformGrid

from penumbra_testing import Checks, Messages, bake, cell_array, load_plugin, texels_of_view, translate

checks = Checks()

# A plate of 8 x 8 cells at z = 1; those in its left half get a ghost type.
PLATE = """
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkFiltersSources import vtkPlaneSource
source = vtkPlaneSource()
source.SetOrigin(-2, -2, 1); source.SetPoint1(2, -2, 1); source.SetPoint2(-2, 2, 1); source.SetResolution(8, 8)
source.Update()
types = numpy.zeros(64, numpy.uint8)
types.reshape(8, 8)[:, :4] = {ghost}
array = numpy_to_vtk(types, deep=1)
array.SetName("vtkGhostType")
output = self.GetPolyDataOutput()
output.ShallowCopy(source.GetOutput())
output.GetCellData().AddArray(array)
"""

# 8 x 8 x 2 cells, the first of each row blank.
LAYERS = """
from vtkmodules.vtkCommonCore import vtkPoints
points = vtkPoints()
for k in range(3):
    for j in range(9):
        for i in range(9):
            points.InsertNextPoint(-2 + i * 0.5 + 0.1 * k, -2 + j * 0.5, 1 + k * 0.5)
output = self.GetStructuredGridOutput()
output.SetDimensions(9, 9, 3)
output.SetPoints(points)
for cell in range(128):
    if cell % 8 < {blank}:
        output.BlankCell(cell)
"""

RECTILINEAR = """
from vtkmodules.vtkCommonCore import vtkDoubleArray
output = self.GetRectilinearGridOutput()
output.SetDimensions(4, 4, 2)
for values, put in (((-2, -1, 0.5, 2), output.SetXCoordinates), ((-1, 0, 0.2, 1.5), output.SetYCoordinates),
                    ((1, 1.7), output.SetZCoordinates)):
    array = vtkDoubleArray()
    for value in values:
        array.InsertNextValue(value)
    put(array)
"""

EXTENT = """
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
self.GetOutputInformation(0).Set(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT(), {extent})
"""


def program(data_type, script, extent=None):
    source = simple.ProgrammableSource(OutputDataSetType=data_type, Script=script)
    if extent:
        source.ScriptRequestInformation = EXTENT.format(extent=extent)
    return source


def make_occluders():
    """By name, data that block some of the light on the floor."""
    image = simple.Wavelet(WholeExtent=[-2, 2, -2, 2, 1, 3])
    tetrahedra = simple.Clip(Input=image)
    tetrahedra.ClipType.Origin, tetrahedra.ClipType.Normal = [0.3, 0, 1], [1, 0.2, 0]
    slab = simple.Wavelet(WholeExtent=[-2, 2, -1, 1, 2, 2])
    ball = simple.Sphere(Center=[2, 0, 2], Radius=0.7)
    curved = simple.UnstructuredCellTypes(CellType="Quadratic Tet", BlocksDimensions=[2, 2, 2])
    plate = program("vtkPolyData", PLATE.format(ghost=32))
    blocks = simple.GroupDatasets(Input=[tetrahedra, ball, slab])
    return {
        "an image": image,
        "an image of one layer": slab,
        "an unstructured grid": tetrahedra,
        "an unstructured grid of curved cells": move_up(simple.Transform(Input=curved)),
        "a structured grid": program("vtkStructuredGrid", LAYERS.format(blank=0), "0, 8, 0, 8, 0, 2"),
        "a structured grid, half of it blank": program(
            "vtkStructuredGrid", LAYERS.format(blank=4), "0, 8, 0, 8, 0, 2"),
        "a rectilinear grid": program("vtkRectilinearGrid", RECTILINEAR, "0, 3, 0, 3, 0, 1"),
        "a hyper tree grid": simple.HyperTreeGridRandom(Dimensions=[4, 4, 3], OutputBounds=[-2, 2, -2, 2, 1, 3]),
        "blocks": blocks,
        "blocks within blocks": simple.GroupDatasets(Input=[blocks, plate]),
        "a plate, half of it hidden": plate,
        "a plate, half of it a copy": program("vtkPolyData", PLATE.format(ghost=1)),
        "a caster of blocks": simple.ShadowCaster(Input=blocks, UseTransmittance=1, Transmittance=[0.2, 0.5, 0.9]),
        "a caster of a plate, half of it hidden": simple.ShadowCaster(
            Input=plate, UseTransmittance=1, Transmittance=[0.2, 0.5, 0.9]),
        "refined grids": refine(),
    }


def refine():
    """Over the right half of a coarse box, a finer one."""
    grids = vtkOverlappingAMR()
    grids.Initialize(2, [1, 1])
    grids.SetOrigin((-2, -2, 1))
    grids.SetGridDescription(8)  # VTK_XYZ_GRID
    for level, (lower, upper) in enumerate((((0, 0, 0), (3, 3, 1)), ((4, 0, 0), (7, 7, 3)))):
        step = 1 / (1 + level)
        grids.SetSpacing(level, [step] * 3)
        grids.SetAMRBox(level, 0, vtkAMRBox(lower, upper))
        grid = vtkUniformGrid()
        grid.SetOrigin([o + step * l for o, l in zip((-2, -2, 1), lower)])
        grid.SetSpacing([step] * 3)
        grid.SetDimensions([u - l + 2 for l, u in zip(lower, upper)])
        for cell in range(grid.GetNumberOfCells()):
            if level == 0 and cell % 4 >= 2:
                grid.BlankCell(cell)
        grids.SetDataSet(level, 0, grid)
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(grids)
    return source


def move_up(transform):
    transform.Transform.Translate = [0, 0, 2]
    return transform


def make_floor():
    plane = simple.Plane(Origin=[-6, -6, 0], Point1=[6, -6, 0], Point2=[-6, 6, 0])
    return simple.ShadowReceiver(Input=plane, TexelSize=0.15, LightSamples=16)


def make_light():
    return simple.AreaLight(Origin=[-1, -1, 9], Point1=[-1, 1, 9], Point2=[1, -1, 9])


def check_types():
    floor, light = make_floor(), make_light()
    view = simple.CreateView("RenderView")
    simple.Show(floor, view)
    simple.Show(light, view)
    for name, occluder in make_occluders().items():
        display = simple.Show(occluder, view)
        display.Representation = "Surface"
        simple.ResetCamera(view)
        simple.Render(view)
        shown = texels_of_view(view)
        simple.Hide(occluder, view)
        with Messages() as messages:
            grid, = bake([floor], [occluder], [light])
        checks.equal(messages.get(), [], f"messages about {name}")
        found = cell_array(grid, "Radiance").reshape(-1, 3)
        different = (found != shown[0]).any(-1)
        where = f"; texel {different.argmax()}: {found[different.argmax()]}, shown {shown[0][different.argmax()]}"
        checks.check(not different.any(),
                     f"{name}: of {len(found)} texels, {different.sum()} differ from the view's"
                     + (where if different.any() else ""))
        checks.at_least((cell_array(grid, "Visibility") < 1).sum(), 200, f"shadowed texels of {name}")


def check_slice_representation():
    """The Slice representation of an image casts as a plane at its place does."""
    image = simple.Wavelet(WholeExtent=[-3, 5, -2, 4, -1, 3])
    planes = {
        "XY Plane": ([-3, -2, 1], [5, -2, 1], [-3, 4, 1]),
        "XZ Plane": ([-3, 2, -1], [5, 2, -1], [-3, 2, 3]),
        "YZ Plane": ([2, -2, -1], [2, 4, -1], [2, -2, 3]),
    }
    up, scale = [0, 0, 2], [0.5, 0.5, 0.5]
    for direction, slice_number in (("XY Plane", 2), ("XZ Plane", 4), ("YZ Plane", 5)):
        view = simple.CreateView("RenderView")
        simple.Show(make_floor(), view)
        simple.Show(make_light(), view)
        display = simple.Show(image, view)
        display.Representation = "Slice"
        display.SliceMode, display.Slice = direction, slice_number
        translate(display, up)
        display.Scale = scale
        simple.Render(view)
        shown = texels_of_view(view)[0]
        corners = planes[direction]
        plane = simple.Plane(Origin=corners[0], Point1=corners[1], Point2=corners[2])
        simple.Hide(image, view)
        placed = simple.Show(plane, view)
        translate(placed, up)
        placed.Scale = scale
        simple.Render(view)
        wanted = texels_of_view(view)[0]
        checks.equal((shown != wanted).sum(), 0, f"texels under a slice that differ from a plane's, {direction}")
        simple.Hide(plane, view)
        simple.Render(view)
        checks.at_least((texels_of_view(view)[0] != wanted).any(-1).sum(), 20,
                        f"texels that a slice shadows, {direction}")


def check_what_has_no_surface():
    floor, light = make_floor(), make_light()
    table = program("vtkTable", "")
    wanted = bake([floor], [], [light])[0]
    with Messages() as messages:
        grid, = bake([floor], [simple.Sphere(Center=[0, 0, 90]), table], [light])
    checks.equal(len(messages.get()), 1, "messages about a table")
    for word in ("Occluders[1]", "vtkTable", "allowed"):
        checks.check(word in "".join(messages.get()), f"the message has '{word}'")
    same = cell_array(grid, "Radiance").tobytes() == cell_array(wanted, "Radiance").tobytes()
    checks.check(same, "the rest is baked")


load_plugin()
check_types()
check_slice_representation()
check_what_has_no_surface()
checks.finish()
