# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Interactive frames show one sample a light; still frames of scripts, screenshots and films are complete."""
import glob
import os

import numpy
from paraview import simple

from penumbra_testing import (
    Checks, bake, cell_array, find_pass, make_scene, make_view, output_path, texels_of_view, translate)

SAMPLES = 32

checks = Checks()


def irradiance_of_map(scene, light_samples):
    """What RadianceMap gives for the scene as it is now with so many samples; its floor reflects all, and has no
    ambient light."""
    before = scene.receiver.LightSamples
    scene.receiver.LightSamples = light_samples
    (grid,) = bake([scene.receiver], [scene.sphere], [scene.light])
    scene.receiver.LightSamples = before
    return cell_array(grid, "Radiance").astype(numpy.float32).tobytes()


def shown_irradiance(view):
    (irradiance,) = texels_of_view(view)
    return irradiance.tobytes()


class Watched:
    """A scene in a view, with the two answers that the texels may equal: a draft and what is final."""

    def __init__(self, **properties):
        self.scene = make_scene(texel_size=0.1, light_samples=SAMPLES)
        self.shown = make_view(self.scene)
        self.view = self.shown.view
        for name, value in properties.items():
            setattr(self.shown.receiver, name, value)

    def kind(self):
        """Which of the answers the texels of the view are, to the bit."""
        texels = shown_irradiance(self.view)
        kinds = [name for name, samples in (("draft", 1), ("final", SAMPLES))
                 if texels == irradiance_of_map(self.scene, samples)]
        return kinds[0] if len(kinds) == 1 else f"neither or both: {kinds}"

    def interactive(self):
        self.view.SMProxy.InteractiveRender()

    def move(self, x):
        """Moves the sphere itself: RadianceMap sees it too."""
        self.scene.sphere.Center = [x, 0, 1.5]

    def bakes(self):
        return find_pass(self.view).GetBakeCount()


def check_drafts():
    watched = Watched()
    watched.interactive()
    checks.equal(watched.kind(), "draft", "a first frame that is interactive")
    checks.equal(find_pass(watched.view).GetBakeProgress(), 0, "progress of a draft")
    simple.Render(watched.view)
    checks.equal(watched.kind(), "final", "the still frame after it")
    checks.equal(find_pass(watched.view).GetBakeProgress(), 1, "progress of a still frame")
    for i in range(3):
        watched.move(0.3 * i)
        watched.interactive()
        checks.equal(watched.kind(), "draft", f"dragged to place {i}")
    simple.Render(watched.view)
    checks.equal(watched.kind(), "final", "at rest")


def check_level_of_detail():
    """With ParaView's level of detail, interactive frames draw decimated data; the bake sees the data themselves."""
    watched = Watched()
    watched.view.LODThreshold = 0
    simple.Render(watched.view)
    bakes = watched.bakes()
    watched.interactive()
    checks.check(watched.view.GetClientSideObject().GetUsedLODForLastRender(), "the frame has drawn decimated data")
    checks.equal(watched.kind(), "final", "decimated, but not changed")
    checks.equal(watched.bakes(), bakes, "bakes for that")
    before = shown_irradiance(watched.view)
    simple.Render(watched.view)
    translate(watched.shown.occluder, [0.5, 0, 0])
    watched.interactive()
    checks.check(find_pass(watched.view).GetBakeProgress() < 1, "progress, decimated and its display moved")  # a draft, where the move can shade
    checks.check(shown_irradiance(watched.view) != before, "the shadow follows")
    translate(watched.shown.occluder, [0, 0, 0])
    simple.Render(watched.view)
    watched.move(0.5)
    watched.interactive()
    checks.check(shown_irradiance(watched.view) == before, "while the new data are only there decimated, shadows stay")
    simple.Render(watched.view)
    checks.equal(watched.kind(), "final", "at rest")


def check_camera():
    """A camera that is moved neither loses what is finished nor has anything baked."""
    watched = Watched()
    simple.Render(watched.view)
    bakes = watched.bakes()
    for _ in range(5):
        watched.view.GetActiveCamera().Azimuth(10)
        watched.interactive()
    checks.equal(watched.kind(), "final", "after moves of the camera")
    checks.equal(watched.bakes(), bakes, "bakes, after moves of the camera")


def check_switched_off():
    watched = Watched(ProgressiveRefinement=0)
    watched.interactive()
    checks.equal(watched.kind(), "final", "an interactive frame, without ProgressiveRefinement")
    watched.shown.receiver.ProgressiveRefinement = 1
    watched.move(0.5)
    watched.interactive()
    checks.equal(watched.kind(), "draft", "with it")
    watched.shown.receiver.ProgressiveRefinement = 0
    watched.interactive()
    checks.equal(watched.kind(), "final", "without it again, and nothing else has changed")


def check_one_of_two_switched_off():
    """One receiver that is to be complete makes the frame complete, in whatever order they were shown."""
    for which in range(2):
        watched = Watched()
        other = simple.ShadowReceiver(Input=simple.Plane(Origin=[-5, 6, 0], Point1=[5, 6, 0], Point2=[-5, 6, 5]))
        displays = [watched.shown.receiver, simple.Show(other, watched.view)]
        displays[which].ProgressiveRefinement = 0
        watched.interactive()
        checks.equal(find_pass(watched.view).GetBakeProgress(), 1, f"progress, receiver {which} without it")
        displays[which].ProgressiveRefinement = 1
        watched.move(0.5)
        watched.interactive()
        checks.check(find_pass(watched.view).GetBakeProgress() < 1, "progress, both with it")  # a draft, where the move can shade
        simple.ResetSession()
        simple.LoadPlugin(os.environ["PENUMBRA_PLUGIN"])


def check_screenshots():
    """A screenshot is complete, also if ParaView is told to take it by an interactive frame."""
    for interactive in (0, 1):
        watched = Watched()
        watched.view.UseInteractiveRenderingForScreenshots = interactive
        watched.interactive()
        checks.equal(watched.kind(), "draft", "before the screenshot")
        simple.SaveScreenshot(output_path("TestProgressiveRefinement.png"), watched.view)
        checks.equal(watched.kind(), "final", f"after it, UseInteractiveRenderingForScreenshots {interactive}")


def check_animation():
    """The frames of a film are complete, and so are those of an animation that a script plays."""
    watched = Watched()
    scene = simple.GetAnimationScene()
    scene.NumberOfFrames = 3
    cue = simple.GetAnimationTrack("Center", index=0, proxy=watched.scene.sphere)
    cue.KeyFrames = [
        simple.CompositeKeyFrame(KeyTime=0, KeyValues=[0.0]), simple.CompositeKeyFrame(KeyTime=1, KeyValues=[1.0])]
    kinds = []

    def note(*_):
        kinds.append(find_pass(watched.view).GetBakeProgress())

    simple.Render(watched.view)
    tag = watched.view.GetRenderWindow().AddObserver("EndEvent", note)
    scene.Play()
    checks.equal(kinds, [1.0] * len(kinds), "progress of the frames of an animation that is played")
    checks.equal(watched.kind(), "final", "after it")
    kinds.clear()
    simple.SaveAnimation(output_path("TestProgressiveRefinement.png"), watched.view)
    checks.at_least(len(kinds), 3, "frames drawn for the film")
    checks.equal(kinds, [1.0] * len(kinds), "their progress")
    watched.view.GetRenderWindow().RemoveObserver(tag)


CASES = [value for name, value in list(globals().items()) if name.startswith("check_")]
checks.run(CASES)
