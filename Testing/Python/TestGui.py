# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in ParaView's own window, on an X server: `paraview --script=TestGui.py` under xvfb-run.

The script only sets up the scene; Qt shows the view after it, and a timer then looks at it."""
import time

import penumbra_testing as testing
from gui_testing import Steps, say
from paraview import simple

SECONDS_TO_SHOW = 3

failed = []


def casts_shadow(view, receiver):
    """Whether a shadow darkens some of the view's pixels: it covers about 1 % of them."""
    shadowed = testing.picture(view).astype(int)
    receiver.Representation = testing.PLAIN
    plain = testing.picture(view).astype(int)
    pixels = plain[:, :, 0].size
    darkened = ((plain - shadowed).sum(axis=2) > 100).sum() if plain.shape == shadowed.shape else 0
    say(f"{view.GetRenderWindow().GetClassName()}: {darkened} of {pixels} pixels are in shadow")
    return darkened > pixels / 200


def look(view, receiver):
    shown = time.monotonic() + SECONDS_TO_SHOW
    yield lambda: time.monotonic() > shown
    if not casts_shadow(view, receiver):
        failed.append("no shadow is shown")


def main():
    testing.load_plugin()
    view = simple.GetActiveViewOrCreate("RenderView")  # the one that the window opens with
    scene = testing.make_scene()
    receiver = simple.Show(scene.receiver, view)
    simple.Show(scene.sphere, view)
    simple.Show(scene.light, view)
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [8, -14, 8], [0, 0, 0.5], [0, 0, 1]
    Steps(view.GetInteractor(), look(view, receiver), failed)


main()
