# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a scene with soft shadows, and prints what it took: pvpython demo.py OUTPUT.png [NAME [MULTIPLIER]].

NAME is one of Data/scenes.py, room if there is none; MULTIPLIER a factor of the samples that the scene asks for.
Plugin/demo.sh calls it. The folder of the built plugin is PENUMBRA_BUILD_DIR, or build/ at the top level."""

import os
import sys
from pathlib import Path

import paraview.simple as pv

SOURCE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(SOURCE / "Data"))
sys.dont_write_bytecode = True  # the source tree stays as git has it

import scenes  # from Data


def load_plugin():
    build = Path(os.environ.get("PENUMBRA_BUILD_DIR", SOURCE / "build"))
    plugins = sorted(build.rglob("Penumbra.so"))
    if not plugins:
        sys.exit(f"Penumbra: no Penumbra.so below {build}; build it, or say where by PENUMBRA_BUILD_DIR.")
    pv.LoadPlugin(str(plugins[0]), ns=vars(pv))


def print_figures(scene, view):
    """Bakes the same receivers as data, to tell the samples, texels, seconds and error of each."""
    print(f"{scenes.count_polygons(view)} polygons")
    print(f"{'receiver':16} {'of them':>8} {'samples':>8} {'texels':>10} {'seconds':>8}  error estimate, of the peak")
    for name, grids in scenes.bake(scene).items():
        print(
            f"{name:16} {len(grids):8d} {max(map(scenes.count_samples, grids)):8d} "
            f"{sum(grid.GetNumberOfCells() for grid in grids):10d} {sum(map(scenes.get_seconds, grids)):8.3f}  "
            + describe_error(grids))


def describe_error(grids):
    """The error estimates of a proxy's receivers, of the highest radiance on any of them."""
    errors = [grid.GetCellData().GetArray("ErrorEstimate") for grid in grids]
    texels = sum(array.GetNumberOfTuples() for array in errors)
    squares = sum(array.GetValue(k) ** 2 for array in errors for k in range(array.GetNumberOfTuples()))
    peak = max(grid.GetCellData().GetArray("Radiance").GetRange(c)[1] for grid in grids for c in range(3))
    largest = max(array.GetRange()[1] for array in errors)
    if peak == 0:
        return "no light"
    return f"RMS {(squares / texels) ** 0.5 / peak:.1e}, maximum {largest / peak:.1e}"


def parse_multiplier(text):
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        sys.exit(f"Penumbra: the multiplier {text} is not a number greater than 0.")
    return value


def main(output, name="room", multiplier="1"):
    if name not in scenes.NAMES:
        sys.exit(f"Penumbra: there is no scene {name}; there are {', '.join(scenes.NAMES)}.")
    factor = parse_multiplier(multiplier)
    load_plugin()
    scene = scenes.build(name)
    scenes.multiply_samples(scene, factor)
    view = scenes.show(scene)
    pv.SaveScreenshot(output, view)
    print_figures(scene, view)
    print(output)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
