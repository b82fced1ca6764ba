# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes bunny.vtp from the index.js of the npm package `bunny`; Data/README.md tells how and why.

Usage: pvpython convert_bunny.py index.js bunny.vtp
"""

import json
import re
import sys

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter


def read_array(script, name):
    """The array that the script exports by this name, as numpy has it."""
    return numpy.array(json.loads(re.search(rf"exports\.{name}\s*=\s*(\[\[.*?\]\])", script, re.DOTALL).group(1)))


def stand_on_floor(positions):
    """Turns y-up into z-up, and moves the box around the points to be centred on the z axis and to begin at z = 0."""
    points = positions[:, (0, 2, 1)] * (1.0, -1.0, 1.0)
    low, high = points.min(axis=0), points.max(axis=0)
    return points - ((low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, low[2])


def main(script_path, output_path):
    with open(script_path, encoding="utf-8") as file:
        script = file.read()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(stand_on_floor(read_array(script, "positions")).astype(numpy.float32), deep=True))
    triangles = vtkCellArray()
    cells = read_array(script, "cells").astype(numpy.int64)
    triangles.SetData(3, numpy_to_vtk(cells.ravel(), deep=True))

    bunny = vtkPolyData()
    bunny.SetPoints(points)
    bunny.SetPolys(triangles)
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(bunny)
    writer.SetFileName(output_path)
    writer.SetIdTypeToInt32()
    writer.SetDataModeToBinary()  # well-formed XML, unlike appended data: Data/README.md
    writer.SetCompressorTypeToZLib()
    writer.SetCompressionLevel(9)
    if not writer.Write():
        sys.exit(f"convert_bunny.py: {output_path} cannot be written")


if __name__ == "__main__":
    main(*sys.argv[1:])
