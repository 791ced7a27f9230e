# The Bake panel in a real window: progress, cancel and the file, while the interface stays alive.
import bpy
import numpy as np
from mesograin.bake_panel.session import session


def prepare(window, **settings):
    """The sphere, to be baked small; gives the viewport's area and one with the render properties."""
    area = yield from window.open("sphere")
    asked = bpy.context.scene.mesograin_bake
    asked.width, asked.height, asked.samples, asked.out = 64, 32, 4, str(window.folder / "bake.exr")
    for name, value in settings.items():
        setattr(asked, name, value)
    return area, (yield from window.render_properties(area))


def check_it_bakes_while_blender_answers(window):
    _, properties = yield from prepare(window, width=512, height=256, samples=128)
    quiet = yield from window.picture(properties)
    state = (bpy.data.is_dirty, len(bpy.data.images), len(bpy.data.objects))
    assert window.call(properties, "bake") == {"FINISHED"}
    assert session.running and not bpy.ops.mesograin.bake.poll()
    silent = yield from window.silence_until(lambda: not session.running)
    assert silent < 0.5, f"Blender did not answer for {silent:.0%} of the bake"
    assert session.task.finished and session.task.error == ""
    assert (bpy.data.is_dirty, len(bpy.data.images), len(bpy.data.objects)) == state
    pixels = window.native.read_exr(str(window.folder / "bake.exr"))[0]
    assert pixels.shape == (256, 512, 4) and pixels[128, :, 0].max() > 0.0
    yield from window.until(lambda: not bpy.app.timers.is_registered(session.poll))
    shown = yield from window.picture(properties)
    assert (np.abs(shown - quiet).max(axis=-1) > 0.1).sum() > 100, "the panel does not say that it is done"


def check_cancel_leaves_no_file_and_what_fails_is_said(window):
    _, properties = yield from prepare(window, samples=1 << 20, out=str(window.folder / "never.exr"))
    window.call(properties, "bake")
    yield from window.until(lambda: session.task.fraction > 0.0)
    yield from window.picture(properties)
    assert session.running
    window.call(properties, "cancel_bake")
    yield from window.until(lambda: not session.running)
    assert not session.task.finished and not (window.folder / "never.exr").exists()
    bpy.context.scene.mesograin_bake.out = "//nowhere/a.exr"
    try:
        window.call(properties, "bake")
    except RuntimeError as error:  # how a script hears of an operator's report
        assert "choose another place" in str(error)
    assert "choose another place" in session.error and session.task is None
    yield from window.picture(properties)
