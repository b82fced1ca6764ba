# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The README's lines for pvpython run as they stand, in a folder that has nothing but the build, and do what they say."""

import os
import tempfile
from pathlib import Path

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataReader


def read_lines():
    """The README's block of Python."""
    text = Path(os.environ["PENUMBRA_README"]).read_text(encoding="utf-8")
    return text.split("```python\n")[1].split("```")[0]


def test_data():
    """The floor's middle is in the ball's shadow, its corners are lit."""
    reader = vtkXMLMultiBlockDataReader()
    reader.SetFileName("radiance.vtm")
    reader.Update()
    grid = reader.GetOutput().GetBlock(0)
    dimensions = [0, 0, 0]
    grid.GetDimensions(dimensions)
    columns, rows = dimensions[0] - 1, dimensions[1] - 1
    for name, components in (("Radiance", 3), ("Visibility", 1), ("ErrorEstimate", 1)):
        array = grid.GetCellData().GetArray(name)
        assert array, f"radiance.vtm has no array {name}"
        assert array.GetNumberOfComponents() == components, f"{name}: {array.GetNumberOfComponents()} components"
    visibility = vtk_to_numpy(grid.GetCellData().GetArray("Visibility")).reshape(rows, columns)
    darkest, corner = visibility.min(), visibility[0, 0]
    assert darkest == 0.0, f"the umbra of the ball sees {darkest} of the lamp, right: 0"
    assert corner == 1.0, f"the floor's corner sees {corner} of the lamp, right: 1"


def test_picture():
    """Only a shadow is darker than the background and the shades of the ball: there is none without the plugin."""
    reader = vtkPNGReader()
    reader.SetFileName("shadow.png")
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[..., :3].astype(int)
    brightest = pixels.max(-1)
    dark, half, lit = (brightest < 8).sum(), ((brightest > 8) & (brightest < 40)).sum(), (brightest > 180).sum()
    assert min(dark, half) > 100 and lit > 10000, f"{dark} pixels are in the umbra, {half} in the penumbra, {lit} lit"


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.symlink(os.environ["PENUMBRA_BUILD_DIR"], "build")
        exec(compile(read_lines(), "README.md", "exec"), {})
        test_data()
        test_picture()
        os.chdir("/")
