# The Bake panel in a real window: progress, cancel and the file, while the interface stays alive.
import time

import bpy
import numpy as np
from mesograin.bake_panel import session


def prepare(window, **settings):
    """The sphere, to be baked small; gives the viewport's area and one with the render properties."""
    area = yield from window.open("sphere")
    asked = bpy.context.scene.mesograin_bake
    asked.width, asked.height, asked.samples, asked.out = 64, 32, 4, str(window.folder / "bake.exr")
    for name, value in settings.items():
        setattr(asked, name, value)
    area, properties = yield from window.split(area)
    properties.type = "PROPERTIES"
    yield from window.seconds(0.3)  # its tabs are known once it was drawn
    properties.spaces.active.context = "RENDER"
    yield from window.seconds(0.2)
    return area, properties


def press(window, area, button):
    with window.override(area):
        return getattr(bpy.ops.mesograin, button)("INVOKE_DEFAULT")


def check_it_bakes_while_blender_answers(window):
    _, properties = yield from prepare(window, width=512, height=256, samples=128)
    quiet = yield from window.picture(properties)
    state = (bpy.data.is_dirty, len(bpy.data.images), len(bpy.data.objects))
    started = before = time.monotonic()
    longest = 0.0
    assert press(window, properties, "bake") == {"FINISHED"}
    assert session.running() and not bpy.ops.mesograin.bake.poll()

    def answered():
        nonlocal longest, before
        now = time.monotonic()
        longest, before = max(longest, now - before), now
        return not session.running()

    yield from window.until(answered, timeout=120.0)
    assert longest < 0.5 * (time.monotonic() - started), "Blender did not answer for half of the bake"
    assert session.bake.finished and session.bake.error == ""
    assert (bpy.data.is_dirty, len(bpy.data.images), len(bpy.data.objects)) == state
    pixels = window.native.read_exr(str(window.folder / "bake.exr"))[0]
    assert pixels.shape == (256, 512, 4) and pixels[128, :, 0].max() > 0.0
    yield from window.until(lambda: not bpy.app.timers.is_registered(session._poll))
    shown = yield from window.picture(properties)
    assert (np.abs(shown - quiet).max(axis=-1) > 0.1).sum() > 100, "the panel does not say that it is done"


def check_cancel_leaves_no_file_and_what_fails_is_said(window):
    _, properties = yield from prepare(window, samples=1 << 20, out=str(window.folder / "never.exr"))
    press(window, properties, "bake")
    yield from window.until(lambda: session.bake.fraction > 0.0)
    yield from window.picture(properties)
    assert session.running()
    press(window, properties, "cancel_bake")
    yield from window.until(lambda: not session.running())
    assert not session.bake.finished and not (window.folder / "never.exr").exists()
    bpy.context.scene.mesograin_bake.out = "//nowhere/a.exr"
    try:
        press(window, properties, "bake")
    except RuntimeError as error:  # how a script hears of an operator's report
        assert "choose another place" in str(error)
    assert "choose another place" in session.error and session.bake is None
    yield from window.picture(properties)
