# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the planner spares in the scenes of Heckbert and Herf 1997: each with it and without it. See README.md.

pvpython PlannerGain.py [--smallest] [results.json]; the folder of the build is PENUMBRA_BUILD_DIR, or build/.
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

from vtkmodules.vtkCommonDataModel import vtkTable

import scenes  # from Data
from demo import load_plugin  # from Plugin
from penumbra_testing import find_pass  # from Testing/Python

SCENES = ["still-life", "chess", "table"]
VIEW_SIZE = [300, 200]  # the frame should cost little beside its bake
RUNS = 5
EFFECTS = ["None", "Unoccluded", "Umbra", "Hard", "Soft"]


def measure(name, runs):
    """What a scene takes, planner off and on: counts, and the median seconds of a frame that bakes all."""
    scene = scenes.build(name)
    view = scenes.show(scene, shading="Shadow")
    view.ViewSize = VIEW_SIZE
    bake(scene, view, False)  # compiles shaders
    results, seconds = {}, {False: [], True: []}
    for _ in range(runs):
        for on in (True, False):
            seconds[on].append(bake(scene, view, on))
            results[on] = count(find_pass(view))
    for on, values in seconds.items():
        results[on]["seconds"] = statistics.median(values)
    return {"off": results[False], "on": results[True]}


def bake(scene, view, on):
    """Draws a frame for which all receivers are baked; its seconds."""
    for receiver in scene.receivers.values():
        receiver.Planner = int(on)
    start = time.perf_counter()
    pv.Render(view)
    view.GetRenderWindow().WaitForCompletion()
    return time.perf_counter() - start


def count(shadows):
    """Sums over the pass's plan, and how many pairs needed each effect."""
    plan = vtkTable()
    shadows.GetPlan(plan)
    rows = range(plan.GetNumberOfRows())
    column = {key: [plan.GetValueByName(row, key) for row in rows]
              for key in ("Effect", "LightSamples", "Texels", "Triangles")}
    samples = [value.ToInt() for value in column["LightSamples"]]
    effects = [value.ToString() for value in column["Effect"]]
    return {
        "triangles": sum(t.ToInt() for t, n in zip(column["Triangles"], samples) if n > 0),
        "samples": sum(samples), "texels": sum(value.ToInt() for value in column["Texels"]),
        "bytes": shadows.GetTextureBytes(), "effects": {name: effects.count(name) for name in EFFECTS}}


def print_table(results):
    columns = ["scene", ", ".join(EFFECTS), "triangles", "samples", "texels of masks", "bytes", "seconds", "times as fast"]
    print("Each pair of numbers: planner off, on\n\n| " + " | ".join(columns) + " |\n" + "|---" * len(columns) + "|")
    for name, found in results.items():
        off, on = found["off"], found["on"]
        effects = ", ".join(str(on["effects"][effect]) for effect in EFFECTS)
        pairs = " | ".join(f"{off[key]}, {on[key]}" for key in ("triangles", "samples", "texels", "bytes"))
        print(f"| {name} | {effects} | {pairs} | {off['seconds']:.4f}, {on['seconds']:.4f} "
              f"| {off['seconds'] / on['seconds']:.2f} |")


def failures(results):
    """A line for each count that the planner makes larger. Times are not judged, since frames are among them, nor are
    bytes: shares that are smaller may be kept where others may not."""
    for name, found in results.items():
        for key in ("triangles", "samples", "texels"):
            if found["on"][key] > found["off"][key]:
                yield f"{name}: {key}: {found['on'][key]} with the planner, {found['off'][key]} without it"


def main(arguments):
    smallest = "--smallest" in arguments
    paths = [argument for argument in arguments if argument != "--smallest"]
    if len(paths) > 1 or any(path.startswith("-") for path in paths):
        sys.exit("usage: pvpython PlannerGain.py [--smallest] [results.json]")
    load_plugin()
    results = {name: measure(name, 1 if smallest else RUNS) for name in (SCENES[:1] if smallest else SCENES)}
    print_table(results)
    for path in paths:
        Path(path).write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")
    failed = list(failures(results))
    print("".join(f"FAILED: {line}\n" for line in failed), end="", flush=True)
    pv.Disconnect()  # before Mesa is torn down
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
