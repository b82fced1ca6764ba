# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Toggling the representation, the plugin's properties and the view's size leaves memory and pictures as they were."""
import ctypes
import os

from paraview import simple

from penumbra_testing import (
    PLAIN, Checks, find_pass, load_plugin, make_scene, make_view, picture, translation_name)

TOGGLES = 100
# Caches fill in the first toggles: shaders, the allocator's free lists, shadows at all places that occluders take.
WARM_UP = 20
# Textures that are to be freed may wait for one of Mesa's threads: the least memory of a few toggles is steadier.
STEADY = 10
# What is still unsteady, in sizes of the pass's textures: a supersampled bake takes four more. Where one toggle in ten
# does not free its textures, more are lost.
SLACK = (TOGGLES - WARM_UP) / 10

checks = Checks()


def resident_bytes():
    """The process's memory that is in use; Mesa's software rasteriser keeps its textures in it."""
    ctypes.CDLL(None).malloc_trim(0)
    with open("/proc/self/statm", encoding="ascii") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class Setting:
    """A property that is toggled between its value now and another one."""

    def __init__(self, proxy, name, changed):
        self.proxy, self.name, self.changed = proxy, name, changed
        original = proxy.GetPropertyValue(name)
        self.original = original[:] if hasattr(original, "SMProperty") else original

    def change(self):
        self.proxy.SetPropertyWithName(self.name, self.changed)

    def restore(self):
        self.proxy.SetPropertyWithName(self.name, self.original)


def toggle(name, view, settings):
    """Toggles one setting after the other, TOGGLES times in all: each time, the pictures are what they were."""
    original = picture(view)
    changed = [None] * len(settings)
    memory = []
    strays = 0
    for count in range(TOGGLES):
        index = count % len(settings)
        settings[index].change()
        now = picture(view).tobytes()
        changed[index] = changed[index] or now
        strays += now != changed[index]
        settings[index].restore()
        strays += picture(view).tobytes() != original.tobytes()
        memory.append(resident_bytes())
        if count == WARM_UP:
            texture_bytes = find_pass(view).GetTextureBytes()
    checks.equal(strays, 0, f"{name}: pictures that are not what they were, of {2 * TOGGLES}")
    checks.equal(changed.count(original.tobytes()), 0, f"{name}: settings that change nothing, of {len(settings)}")
    checks.equal(find_pass(view).GetTextureBytes(), texture_bytes, f"{name}: bytes of the pass's textures")
    growth = min(memory[-STEADY:]) - min(memory[WARM_UP - STEADY : WARM_UP])
    checks.at_most(growth / texture_bytes, SLACK, f"{name}: growth of the process, in sizes of the pass's textures")


def check_toggles():
    scene = make_scene(texel_size=0, light_samples=8)
    shown = make_view(scene, size=(200, 150))
    shown.view.OrientationAxesVisibility = 0  # ParaView draws their letters otherwise after a change of size and back
    toggle("representation", shown.view, [Setting(shown.receiver, "Representation", PLAIN)])
    toggle("size", shown.view, [Setting(shown.view, "ViewSize", [160, 190])])
    toggle("properties", shown.view, [
        Setting(shown.receiver, "ShadowShading", "Radiance"),
        Setting(scene.receiver, "LightSamples", 40),
        Setting(scene.receiver, "TexelSize", 0.1),
        Setting(scene.receiver, "Supersampling", "2"),
        Setting(scene.receiver, "SamplingPattern", "Random"),
        Setting(scene.receiver, "AmbientRadiance", [0.1, 0.2, 0.1]),
        Setting(scene.light, "Shape", "Triangle"),
        Setting(scene.light, "Radiance", [1.0, 0.5, 0.2]),
        Setting(shown.light, "Visibility", 0),
        Setting(shown.occluder, translation_name(shown.occluder), [0.5, 0.0, 0.0])])


def check_camera():
    scene = make_scene()
    shown = make_view(scene, size=(200, 150))
    original = picture(shown.view)
    bakes = find_pass(shown.view).GetBakeCount()
    for angle in range(TOGGLES):
        shown.view.GetActiveCamera().Azimuth(angle)
        simple.Render(shown.view)
        shown.view.GetActiveCamera().Azimuth(-angle)
    checks.check((picture(shown.view) == original).all(), "camera: the picture is what it was")
    checks.equal(find_pass(shown.view).GetBakeCount(), bakes, f"camera: bakes, after {TOGGLES} moves")


load_plugin()
check_toggles()
check_camera()
checks.finish()
