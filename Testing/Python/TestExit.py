# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A script that ends while a RadianceMap or a view exists ends with its own status, and without a message.

ParaView lets go of their windows very late: when the process's static objects are destroyed. So the test runs itself
in other processes, which end in each way, with OSMesa's windows (if they are preloaded) and with EGL's. PVPYTHON names
the program to run.
"""
import os
import subprocess
import sys

from paraview import simple

from penumbra_testing import Checks, load_plugin, make_scene, make_view

LAST_WORDS = "reached the end"


def end(what, status):
    """Ends this process while what was asked for exists."""
    load_plugin()
    scene = make_scene()
    if what in ("map", "both"):
        simple.RadianceMap(
            Receivers=[scene.receiver], Occluders=[scene.sphere], Lights=[scene.light]).UpdatePipeline()
    if what in ("view", "both"):
        simple.Render(make_view(scene).view)
    print(LAST_WORDS, flush=True)
    sys.exit(int(status))


def check_end(checks, what, status, preloaded):
    environment = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    if preloaded:
        environment["LD_PRELOAD"] = preloaded
    ended = subprocess.run(
        [os.environ["PVPYTHON"], __file__, what, str(status)], env=environment, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True, check=False)
    name = f"{what}, {'OSMesa' if preloaded else 'EGL'}"
    checks.equal(ended.returncode, status, f"{name}: status")
    checks.equal(ended.stdout.strip(), LAST_WORDS, f"{name}: output")


def main():
    checks = Checks()
    for preloaded in {os.environ.get("LD_PRELOAD"), None}:
        for what, status in (("map", 0), ("map", 3), ("view", 0), ("both", 0)):
            check_end(checks, what, status, preloaded)
    checks.finish()


if len(sys.argv) > 1:
    end(*sys.argv[1:])
main()
