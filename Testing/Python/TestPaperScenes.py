# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The scenes of Data/heckbert_herf.py have the counts that Heckbert and Herf 1997, sections 5 and 6, give, and shadows
on all that is to receive them."""
import sys

from paraview import simple

from penumbra_testing import Checks, cell_array, data_path, find_pass, load_plugin, output_path, picture

sys.path.insert(0, data_path(""))

import scenes  # from Data

STAGE = ("Floor", "Back wall", "Side wall")
# Visibility divides sums of single precision.
SHADOWED = 0.99

checks = Checks()


def check_scene(name, receivers, samples, polygons=None, texels=None):
    """samples: of all lights, on those receivers of each proxy that light reaches. None: the paper does not tell."""
    scene = scenes.build(name)
    for receiver in scene.receivers.values():
        receiver.Planner = 0  # the paper's samples, whether they are needed or not
    blocks = scenes.bake(scene)
    grids = [grid for group in blocks.values() for grid in group]
    view = scenes.show(scene)
    simple.Render(view)
    checks.equal(len(grids), receivers, f"{name}: receivers")
    checks.equal(find_pass(view).GetNumberOfReceivers(), receivers, f"{name}: receivers of the view")
    found = {key: {scenes.count_samples(grid) for grid in group} - {0} for key, group in blocks.items()}
    checks.equal(found, {key: {count} for key, count in samples.items()}, f"{name}: samples")
    for key, group in blocks.items():
        least = min(cell_array(grid, "Visibility").min() for grid in group)
        checks.at_most(least, SHADOWED, f"{name}: least visibility on {key}")
    if polygons:
        checks.equal(scenes.count_polygons(view), polygons, f"{name}: polygons that the view draws")
    if texels:
        checks.equal(sum(grid.GetNumberOfCells() for grid in grids), texels, f"{name}: texels")


def check_multiplier():
    scene = scenes.build("still-life")
    scenes.multiply_samples(scene, 4)
    (grid,) = scenes.bake(scene)["Floor"]
    checks.equal(scenes.count_samples(grid), 32, "still-life: samples, times 4")


def check_state():
    """A state file holds a scene whole: its sources are ParaView's own."""
    view = scenes.show(scenes.build("still-life"))
    view.UseFXAA = 0  # a state file that is loaded switches it on
    before = picture(view)
    simple.SaveState(output_path("TestPaperScenes.pvsm"))
    simple.ResetSession()
    load_plugin()
    simple.LoadState(output_path("TestPaperScenes.pvsm"))
    view = simple.GetActiveView()
    view.UseFXAA = 0
    checks.check((picture(view) == before).all(), "still-life: the same picture after its state is loaded")
    checks.equal(scenes.count_polygons(view), 749, "still-life: polygons after its state is loaded")


load_plugin()
check_state()
check_scene("still-life", 3, {key: 8 for key in STAGE}, polygons=749, texels=200000)
check_scene("chess", 3, {key: 32 for key in STAGE}, polygons=6142, texels=200000)
check_scene("table", 25, dict({key: 49 for key in STAGE}, **{"Table top": 9, "Table legs": 4}))
check_multiplier()
checks.finish()
