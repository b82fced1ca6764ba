# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a room with soft shadows, and prints what it took: pvpython demo.py OUTPUT.png [SAMPLES].

Plugin/demo.sh calls it. The folder of the built plugin is PENUMBRA_BUILD_DIR, or build/ at the top level."""

import os
import sys
from pathlib import Path

import paraview.simple as pv
from paraview import servermanager

SOURCE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(SOURCE / "Data"))


def load_plugin():
    build = Path(os.environ.get("PENUMBRA_BUILD_DIR", SOURCE / "build"))
    plugins = sorted(build.rglob("Penumbra.so"))
    if not plugins:
        sys.exit(f"Penumbra: no Penumbra.so below {build}; build it, or say where by PENUMBRA_BUILD_DIR.")
    pv.LoadPlugin(str(plugins[0]), ns=vars(pv))


def print_figures(scene):
    """Bakes the same receivers as data, to tell the samples, texels, seconds and error of each."""
    baked = pv.RadianceMap(
        Receivers=list(scene.receivers.values()), Occluders=scene.occluders, Lights=scene.lights)
    blocks = servermanager.Fetch(baked)
    print(f"{'receiver':12} {'samples':>8} {'texels':>10} {'seconds':>8}  error estimate, of the peak")
    names = list(scene.receivers)
    for i in range(blocks.GetNumberOfBlocks()):
        name = names[min(i, len(names) - 1)]  # the last one, a box, has a block for each face
        grid = blocks.GetBlock(i)
        cells, fields = grid.GetCellData(), grid.GetFieldData()
        samples = sum(fields.GetArray("LightSamples").GetValue(k)
                      for k in range(fields.GetArray("LightSamples").GetNumberOfTuples()))
        errors = cells.GetArray("ErrorEstimate")
        mean_square = sum(errors.GetValue(k) ** 2 for k in range(errors.GetNumberOfTuples()))
        mean_square /= errors.GetNumberOfTuples()
        peak = max(cells.GetArray("Radiance").GetRange(c)[1] for c in range(3))
        print(f"{name:12} {samples:8d} {grid.GetNumberOfCells():10d} "
              f"{fields.GetArray('BakeSeconds').GetValue(0):8.3f}  "
              f"RMS {mean_square ** 0.5 / peak:.1e}, maximum {errors.GetRange()[1] / peak:.1e}")


def main(output, samples=256):
    load_plugin()
    import room

    scene = room.build(samples=int(samples))
    view = room.show(scene)
    pv.SaveScreenshot(output, view)
    print_figures(scene)
    print(output)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
