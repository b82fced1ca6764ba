# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The scenes of Heckbert and Herf 1997, sections 5 and 6: today's times beside the paper's. See README.md.

pvpython PaperScenes.py [--smallest] [results.json]; the folder of the build is PENUMBRA_BUILD_DIR, or build/.
"""
import json
import os
import statistics
import sys
import time
from pathlib import Path

import paraview.simple as pv

SOURCE = Path(__file__).resolve().parent.parent.parent
BUILD = Path(os.environ.get("PENUMBRA_BUILD_DIR", SOURCE / "build"))
for folder in (SOURCE / "Data", SOURCE / "Plugin", SOURCE / "Testing" / "Python"):
    sys.path.insert(0, str(folder))
sys.path[:0] = [str(package.parent.parent) for package in BUILD.rglob("penumbra/__init__.py")]

import scenes  # from Data
from demo import load_plugin  # from Plugin
from penumbra_testing import find_pass, translate  # from Testing/Python

# What the paper tells of its scenes, and the seconds that it took (2 Hz are 0.5 s). It tells no polygons of the table,
# and texels of the first scene alone: the second is to have as many here.
PAPER = {
    "still-life": {"polygons": 749, "receivers": 3, "samples": [8], "texels": 200000, "seconds": 0.5},
    "chess": {"polygons": 6142, "receivers": 3, "samples": [32], "texels": 200000, "seconds": 5.5},
    "table": {"receivers": 25, "samples": [4, 9, 49], "seconds": 13.0},
}
VIEW_SIZE = [900, 900]  # the paper's, section 5
RUNS, FRAMES = 5, 40
WARM_UP_FRAMES = 2  # they compile shaders
STEP = 0.5  # units of the scene, by which an occluder moves in a frame


def measure(name, runs, frames):
    """What there is to tell of a scene: counts from the data, and medians of times."""
    scene = scenes.build(name)
    for receiver in scene.receivers.values():
        receiver.Planner = 0  # the paper's samples, whether they are needed or not
    baker = scenes.make_baker(scene)
    scenes.bake(scene, baker)  # compiles shaders
    totals = []
    for _ in range(runs):
        grids = [grid for group in scenes.bake(scene, baker).values() for grid in group]
        totals.append(sum(map(scenes.get_seconds, grids)))
    view = scenes.show(scene)
    view.ViewSize = VIEW_SIZE
    frame_seconds, bakes = move_occluder(scene, view, frames)
    return {
        "polygons": scenes.count_polygons(view), "receivers": len(grids),
        "samples": sorted({scenes.count_samples(grid) for grid in grids} - {0}),
        "texels": sum(grid.GetNumberOfCells() for grid in grids), "bakeSeconds": statistics.median(totals),
        "frameSeconds": frame_seconds, "frames": frames, "framesThatBaked": bakes}


def move_occluder(scene, view, frames):
    """Draws frames between which the scene's first occluder moves; the median of their seconds, and how many baked."""
    display = pv.GetDisplayProperties(next(iter(scene.occluders.values())), view)
    seconds, baked = [], 0
    pv.Render(view)
    shadows, window = find_pass(view), view.GetRenderWindow()
    for frame in range(-WARM_UP_FRAMES, frames):
        translate(display, [STEP * (frame + WARM_UP_FRAMES + 1), 0, 0])
        before, start = shadows.GetBakeCount(), time.perf_counter()
        pv.Render(view)
        window.WaitForCompletion()
        if frame >= 0:
            seconds.append(time.perf_counter() - start)
            baked += shadows.GetBakeCount() > before
    return statistics.median(seconds), baked


def print_table(results):
    columns = (
        "scene", "polygons", "receivers", "texels", "samples", "bake, s", "paper, s", "times as fast", "moving, Hz",
        "paper, Hz")
    print("| " + " | ".join(columns) + " |\n" + "|---" * len(columns) + "|")
    for name, found in results.items():
        paper = PAPER[name]["seconds"]
        print(
            f"| {name} | {found['polygons']} | {found['receivers']} | {found['texels']} "
            f"| {', '.join(map(str, found['samples']))} | {found['bakeSeconds']:.4f} | {paper} "
            f"| {paper / found['bakeSeconds']:.0f} | {1 / found['frameSeconds']:.1f} | {1 / paper:.2g} |")


def failures(results):
    """A line for each count that is not the paper's, or not as it must be. Times are not judged."""
    for name, found in results.items():
        for key, wanted in PAPER[name].items():
            if key != "seconds" and found[key] != wanted:
                yield f"{name}: {key}: {found[key]}, the paper's {wanted}"
        if found["framesThatBaked"] != found["frames"]:
            yield f"{name}: {found['framesThatBaked']} of {found['frames']} frames baked; an occluder moved in each"


def main(arguments):
    smallest = "--smallest" in arguments
    paths = [argument for argument in arguments if argument != "--smallest"]
    if len(paths) > 1 or any(path.startswith("-") for path in paths):
        sys.exit("usage: pvpython PaperScenes.py [--smallest] [results.json]")
    load_plugin()
    names = ["still-life"] if smallest else list(PAPER)
    results = {name: measure(name, *((1, 2) if smallest else (RUNS, FRAMES))) for name in names}
    print_table(results)
    for path in paths:
        Path(path).write_text(json.dumps({"paper": PAPER, "found": results}, indent=2) + "\n", encoding="utf-8")
    failed = list(failures(results))
    print("".join(f"FAILED: {line}\n" for line in failed), end="", flush=True)
    pv.Disconnect()  # before Mesa is torn down
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
