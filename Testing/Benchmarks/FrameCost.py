# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What baked shadows cost a frame in ParaView's stock render view. See README.md.

Each scene is shown in two views that differ in one thing: receivers are 'Surface' in one, 'Soft Shadow Receiver' in the
other. The camera moves, and the views draw the same frame in turn.
"""
import argparse
import json
import math
import os
import statistics
import sys
import time
from types import SimpleNamespace

from paraview import simple

sys.path += [os.environ["PENUMBRA_DATA"], os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Python")]
import room
import scenes
from penumbra_testing import PLAIN, SHADOWED, find_pass, load_plugin

# What issue 2 asks for, in the views that users have.
LARGEST_RATIO = 1.05
# Frames that compile shaders and bake, and do not count.
WARM_UP_FRAMES = 4
SHADINGS = ("Shadow", "Radiance")
FULL = SimpleNamespace(size=(1200, 800), texels=512, samples=(1, 64, 4096), frames=100)
SMALLEST = SimpleNamespace(size=(300, 200), texels=32, samples=(1, 64), frames=2)


def show(scene, plan):
    view = scenes.show(scene)
    view.ViewSize = plan.size
    return view


def make_room(plan, samples):
    """The demo's room without its bunny."""
    scene = room.build(samples, 24 / plan.texels)
    scene.occluders = {}
    return scene, lambda: show(scene, plan)


def make_bunny(plan, samples):
    """The demo as it is: the room and the bunny, of 3 674 triangles."""
    scene = room.build(samples, 24 / plan.texels)
    return scene, lambda: show(scene, plan)


def make_floor(plan, samples):
    """Nearly every pixel shows a floor that the camera looks down on, the worst case: all else is a small sphere."""
    plane = simple.Plane(Origin=[-12, -12, 0], Point1=[12, -12, 0], Point2=[-12, 12, 0])
    floor = simple.ShadowReceiver(Input=plane, LightSamples=samples, TexelSize=24 / plan.texels)
    sphere = simple.Sphere(Center=[0, 0, 2], Radius=1)
    lamp = simple.AreaLight(Origin=[4, -11, 15.9], Point1=[4, -6, 15.9], Point2=[9, -11, 15.9])
    scene = SimpleNamespace(receivers={"Floor": floor}, occluders=[sphere], lights=[lamp])

    def show_floor():
        view = simple.CreateView("RenderView")
        view.ViewSize = plan.size
        view.OrientationAxesVisibility = 0
        for source in (floor, sphere, lamp):
            simple.Show(source, view)
        view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0, -8, 12], [0, 0, 0], [0, 0, 1]
        return view
    return scene, show_floor


SCENES = {"room": (make_room, True), "room and bunny": (make_bunny, True), "floor": (make_floor, False)}


def draw_frame(view, angle):
    """Draws a frame from the camera's place turned by `angle` degrees, to its last pixel; answers its CPU and its wall
    time in seconds."""
    camera = view.GetActiveCamera()
    camera.Azimuth(angle)
    cpu, wall = time.process_time(), time.perf_counter()
    view.SMProxy.StillRender()
    view.GetRenderWindow().WaitForCompletion()  # OpenGL only queues what it is told to draw
    cost = time.process_time() - cpu, time.perf_counter() - wall
    camera.Azimuth(-angle)
    return cost


def measure(plan, plain, shadowed):
    """The median ratios of neighbouring frames, the median times of each kind, and how often the pass baked."""
    times = []
    for frame in range(-WARM_UP_FRAMES, plan.frames):
        angle = 8 * math.sin(0.3 * frame)
        order = (plain, shadowed) if frame % 2 else (shadowed, plain)
        pair = [draw_frame(view, angle) for view in order]
        if frame < 0:
            bakes = find_pass(shadowed).GetBakeCount()
        if frame >= 0:
            times.append(pair if frame % 2 else pair[::-1])
    result = {"bakes": find_pass(shadowed).GetBakeCount() - bakes}
    for i, clock in enumerate(("cpu", "wall")):
        result[clock + "Ratio"] = statistics.median(b[i] / a[i] for a, b in times)
        result[clock + "PlainSeconds"] = statistics.median(a[i] for a, _ in times)
        result[clock + "ShadowSeconds"] = statistics.median(b[i] for _, b in times)
    return result


def measure_scene(plan, name, samples):
    make, judged = SCENES[name]
    scene, show = make(plan, samples)
    views = show(), show()
    for view, representation in zip(views, (PLAIN, SHADOWED)):
        for receiver in scene.receivers.values():
            simple.GetDisplayProperties(receiver, view).Representation = representation
    results = []
    for shading in SHADINGS:
        for receiver in scene.receivers.values():
            simple.GetDisplayProperties(receiver, views[1]).ShadowShading = shading
        result = {"scene": name, "samples": samples, "shading": shading, "judged": judged}
        result.update(measure(plan, *views))
        print_row(result)
        results.append(result)
    simple.ResetSession()
    load_plugin()
    return results


def print_row(result):
    print("| {scene} | {samples} | {shading} | {0:.2f} | {1:.2f} | {cpuRatio:.3f} | {wallRatio:.3f} |".format(
        1e3 * result["cpuPlainSeconds"], 1e3 * result["cpuShadowSeconds"], **result), flush=True)


def judge(plan, results):
    """Prints a line for each requirement that does not hold; answers whether all do."""
    failed = [f"moving the camera must not bake: {r}" for r in results if r["bakes"] != 0]
    if plan is FULL:
        failed += [f"{r['scene']}, n = {r['samples']}, {r['shading']}: the ratio of CPU times is {r['cpuRatio']:.3f}, "
                   f"allowed: {LARGEST_RATIO}" for r in results if r["judged"] and r["cpuRatio"] > LARGEST_RATIO]
    for line in failed:
        print("FAILED:", line)
    return not failed


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--smallest", action="store_true", help="too little for times, which are not judged then")
    parser.add_argument("--frames", type=int, help="of each kind, instead of 100")
    parser.add_argument("--samples", type=int, nargs="+", help="per light, instead of 1, 64 and 4096")
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("json", nargs="?", help="a file to write the results to")
    arguments = parser.parse_args()
    plan = SMALLEST if arguments.smallest else FULL
    plan.frames = arguments.frames or plan.frames
    plan.samples = arguments.samples or plan.samples

    load_plugin()
    print(f"{plan.size[0]} x {plan.size[1]} pixels, {plan.texels} texels a side, medians of {plan.frames} pairs\n")
    print("| scene | n | shading | Surface, CPU ms | with shadows, CPU ms | ratio of CPU times | of wall times |")
    print("|---|---|---|---|---|---|---|")
    results = []
    for name in arguments.scenes:
        for samples in plan.samples:
            results += measure_scene(plan, name, samples)
    if arguments.json:
        with open(arguments.json, "w") as file:
            json.dump({"size": plan.size, "frames": plan.frames, "results": results}, file, indent=1)
    good = judge(plan, results)
    simple.Disconnect()
    sys.exit(0 if good else 1)


main()
