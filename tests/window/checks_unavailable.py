# What an artist meets in the window where the renderer cannot work: without its native module, or without a device.
# The reason is in the environment; see test_window.py.
import contextlib
import os

import bpy
import numpy as np
from mesograin import native_module
from mesograin.engine import status


def reason():
    """Words that the sentence must hold."""
    if "MESOGRAIN_NATIVE_DIR" in os.environ:
        return ("native module", os.environ["MESOGRAIN_NATIVE_DIR"], "mesograin install")
    return ("OpenGL 4.5", "MESOGRAIN_GL_DEVICE=" + os.environ["MESOGRAIN_GL_DEVICE"])


def assert_one_sentence(sentence):
    assert all(word in sentence for word in reason()), sentence
    assert "\n" not in sentence and sentence.endswith("."), sentence


def check_viewport_says_why_it_cannot_render(window):
    area = yield from window.open("sphere")
    yield from window.until(lambda: status.complaints())
    [sentence] = status.complaints()
    assert_one_sentence(sentence)
    # Blender writes an engine's message over the viewport, where the overlays are shown.
    silent = yield from window.picture(area)
    overlay = area.spaces.active.overlay
    overlay.show_overlays = True
    for name in ("floor", "axis_x", "axis_y", "cursor", "object_origins", "relationship_lines", "extras", "text"):
        setattr(overlay, f"show_{name}", name == "text")
    spoken = yield from window.picture(area)
    overlay.show_overlays = False
    different = np.abs(spoken - silent).max(axis=-1) > 0.2
    assert different.sum() > 500, "the viewport says nothing"
    middle = len(different) // 2
    assert different[middle:middle + 80].sum() > 500, "the sentence is longer than a line, and cut off there"


def check_final_render_says_why_and_blender_lives(window):
    area = yield from window.open("sphere")
    bpy.context.preferences.view.render_display_type = "NONE"
    status.clear()
    # A script is given the engine's message as an exception if the render ends before the operator returns.
    with contextlib.suppress(RuntimeError):
        yield from window.press_f12(area)
    yield from window.until(lambda: status.get(status.RENDER) is not None and not bpy.app.is_job_running("RENDER"))
    assert_one_sentence(status.get(status.RENDER).error)


def check_panels_show_the_sentence(window):
    yield from window.open("sphere")
    bpy.context.view_layer.objects.active = bpy.data.objects["Sphere"]
    yield from window.seconds(0.3)
    properties = window.area_of_type("PROPERTIES")
    for context in ("MATERIAL", "RENDER"):
        properties.spaces.active.context = context
        picture = yield from window.picture(properties)
        assert picture.std() > 0.05, f"the {context} panel is empty"
    if native_module.problem():
        assert_one_sentence(native_module.problem())
    # The properties are there and can be set.
    grain = bpy.data.materials["Translucent"].mesograin
    grain.sigma_s = (1.0, 2.0, 3.0)
    assert tuple(grain.sigma_s) == (1.0, 2.0, 3.0)


def check_preferences_show_the_sentence(window):
    area = yield from window.open("sphere")
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Mesograin"
    old, area.type = area.type, "PREFERENCES"
    folded = yield from window.picture(area)
    bpy.ops.preferences.addon_expand(module="mesograin")
    unfolded = yield from window.picture(area)
    with window.override(area):
        try:
            outcome = str(bpy.ops.mesograin.self_test())
        except RuntimeError as error:  # how an operator's error report reaches a script
            outcome = str(error)
    area.type = old
    changed = (np.abs(unfolded - folded).max(axis=-1) > 0.1).sum()
    assert changed > 3000, f"unfolding the add-on changed only {changed} pixels of the preferences"
    assert_one_sentence(outcome.removeprefix("Error: ").strip())
