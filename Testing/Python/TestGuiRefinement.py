# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Progressive refinement in ParaView's own window, on an X server: timers go on after a still frame, a change
interrupts them, the status bar is told of their progress, and what is shown in the end is final."""
import time

import numpy
import penumbra_testing as testing
from gui_testing import Steps, say
from paraview import servermanager, simple

WALLS = 5
# Batches without time draw one sample of a tile each.
SAMPLES = 8
TEXEL_SIZE = 0.1
# No batch comes without a timer; ten of the plugin's timers would have come in this time.
SECONDS_OF_REST = 0.5

PROGRESSIVE = testing.vtkSoftShadowPass.PROGRESSIVE
DRAFT = testing.vtkSoftShadowPass.DRAFT


class Checks(testing.Checks):
    def check(self, holds, what):
        say(("ok      " if holds else "FAILED  ") + what)
        if not holds:
            self.failed.append(what)


checks = Checks()


class Window:
    """The scene in the view that the window opens with, with a row of walls as further receivers; notes each frame
    that is drawn, and what ParaView's status bar is told."""

    def __init__(self):
        self.view = simple.GetActiveViewOrCreate("RenderView")
        self.scene = testing.make_scene(texel_size=TEXEL_SIZE, light_samples=SAMPLES)
        walls = [simple.Plane(Origin=[i - 3, 5, 0], Point1=[i - 2, 5, 0], Point2=[i - 3, 5, 4]) for i in range(WALLS)]
        self.receivers = [self.scene.receiver] + [
            simple.ShadowReceiver(Input=wall, TexelSize=TEXEL_SIZE, LightSamples=SAMPLES) for wall in walls]
        self.displays = [simple.Show(receiver, self.view) for receiver in self.receivers]
        simple.Show(self.scene.sphere, self.view)
        simple.Show(self.scene.light, self.view)
        self.view.CameraPosition, self.view.CameraFocalPoint, self.view.CameraViewUp = [8, -14, 8], [0, 0, 1], [0, 0, 1]
        self.frames, self.told = [], []
        self.window = self.view.GetRenderWindow()
        self.window.AddObserver("EndEvent", self.note_frame)
        self.handler = servermanager.ActiveConnection.Session.GetProgressHandler()
        self.handler.AddObserver("ProgressEvent", self.note_progress)

    def note_frame(self, *_):
        shadows = testing.find_pass(self.view)
        if shadows:
            self.frames.append((shadows.GetBakeMode(), shadows.GetBakeProgress()))

    def note_progress(self, *_):
        if self.handler.GetLastProgressText() == "Soft shadows":
            self.told.append(self.handler.GetLastProgress())

    def change(self, x):
        """Moves the sphere, and draws a frame as ParaView does after Apply."""
        self.frames.clear()
        self.told.clear()
        self.scene.sphere.Center = [x, 0, 1.5]
        simple.Render(self.view)

    def is_draft(self):
        """Whether one frame was drawn, and it was a draft: but for what the change could not shade."""
        return len(self.frames) == 1 and self.frames[0][0] == DRAFT and self.frames[0][1] < 1

    def progress(self):
        return testing.find_pass(self.view).GetBakeProgress()

    def is_final(self):
        """Whether the texels of all receivers are RadianceMap's, to the bit."""
        blocks = testing.bake(self.receivers, [self.scene.sphere], [self.scene.light])
        shown = testing.texels_of_view(self.view)
        return len(shown) == len(blocks) and all(
            testing.cell_array(block, "Radiance").astype(numpy.float32).tobytes() == irradiance.tobytes()
            for block, irradiance in zip(blocks, shown))


def rest():
    """Waits for a while."""
    end = time.monotonic() + SECONDS_OF_REST
    return lambda: time.monotonic() > end


def run(window):
    yield lambda: window.frames and window.progress() == 1
    testing.find_pass(window.view).SetBatchSeconds(0)

    window.change(0.2)
    checks.check(window.is_draft(), f"after a change: a draft at once: {window.frames}")
    yield lambda: window.progress() == 1
    steps = [progress for mode, progress in window.frames if mode == PROGRESSIVE]
    checks.check(steps == sorted(steps), f"timers go on from there: {numpy.round(steps, 3)}")
    # A fast machine draws several samples in the shortest batch, a millisecond.
    checks.at_least(len(set(steps)), 2, "steps until all is done")
    checks.check(any(0 < percent < 100 for percent in window.told), f"the status bar is told: {window.told}")
    checks.check(window.is_final(), "and then the texels are RadianceMap's")
    window.frames.clear()
    yield rest()
    checks.equal(len(window.frames), 0, "frames after that")

    window.change(0.4)
    yield lambda: 0 < window.progress() < 1
    window.change(0.6)
    checks.check(window.is_draft(), f"a change interrupts: a new draft at once: {window.frames}")
    yield lambda: window.progress() == 1
    checks.check(window.is_final(), "and it is what becomes final")

    window.change(0.8)
    yield lambda: 0 < window.progress() < 1
    window.frames.clear()
    before = window.progress()
    window.view.SMProxy.InteractiveRender()
    yield rest()
    checks.equal(window.frames, [(DRAFT, before)], "an interactive frame keeps what is done; nothing goes on after it")
    simple.Render(window.view)
    yield lambda: window.progress() == 1
    checks.check(window.is_final(), "after the next still frame it does")

    window.change(1.0)
    simple.SaveScreenshot(testing.output_path("TestGuiRefinement.png"), window.view)
    checks.equal(window.progress(), 1, "progress of a screenshot")
    checks.check(window.is_final(), "a screenshot is final")

    window.displays[0].ProgressiveRefinement = 0
    window.change(1.2)
    checks.equal([progress for _, progress in window.frames], [1], "progress without ProgressiveRefinement")

    window.displays[0].ProgressiveRefinement = 1
    animation = simple.GetAnimationScene()
    animation.NumberOfFrames = 4
    track = simple.GetAnimationTrack("Radius", proxy=window.scene.sphere)
    track.KeyFrames = [
        simple.CompositeKeyFrame(KeyTime=0, KeyValues=[1.0]), simple.CompositeKeyFrame(KeyTime=1, KeyValues=[0.5])]
    for time_step in (1 / 3, 2 / 3, 1):
        window.frames.clear()
        animation.AnimationTime = time_step
        checks.check(any(mode == DRAFT and progress < 1 for mode, progress in window.frames),
                     f"an animation that is scrubbed shows drafts: {window.frames}")
    yield lambda: window.progress() == 1
    checks.check(window.is_final(), "when it rests, they become final")


def main():
    testing.load_plugin()
    window = Window()
    Steps(window.view.GetInteractor(), run(window), checks.failed)


main()
