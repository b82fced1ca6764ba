# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in ParaView's own window, on an X server: `paraview --script=TestGui.py` under xvfb-run.

The script only sets up the scene; Qt shows the view after it, and a timer then looks at it. ParaView sends what
scripts print to its own console, so this one writes to the file descriptor."""
import os

import penumbra_testing as testing
from paraview import simple

SECONDS_TO_SHOW = 3


def say(text):
    os.write(1, (text + "\n").encode())


def casts_shadow(view, receiver):
    """Whether a shadow darkens some of the view's pixels: it covers about 1 % of them."""
    shadowed = testing.picture(view).astype(int)
    receiver.Representation = testing.PLAIN
    plain = testing.picture(view).astype(int)
    pixels = plain[:, :, 0].size
    darkened = ((plain - shadowed).sum(axis=2) > 100).sum() if plain.shape == shadowed.shape else 0
    say(f"{view.GetRenderWindow().GetClassName()}: {darkened} of {pixels} pixels are in shadow")
    return darkened > pixels / 200


def finish(check):
    """Ends ParaView with the check's result: else its window would stay open."""
    try:
        passed = check()
    except Exception as error:
        say(repr(error))
        passed = False
    say("passed" if passed else "FAILED")
    os._exit(0 if passed else 1)


def main():
    testing.load_plugin()
    view = simple.GetActiveViewOrCreate("RenderView")  # the one that the window opens with
    scene = testing.make_scene()
    receiver = simple.Show(scene.receiver, view)
    simple.Show(scene.sphere, view)
    simple.Show(scene.light, view)
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [8, -14, 8], [0, 0, 0.5], [0, 0, 1]
    interactor = view.GetInteractor()
    interactor.AddObserver("TimerEvent", lambda *_: finish(lambda: casts_shadow(view, receiver)))
    interactor.CreateOneShotTimer(1000 * SECONDS_TO_SHOW)


main()
