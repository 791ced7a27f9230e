# The Bake panel in a real window: progress, cancel and the file, while the interface stays alive.
import bpy
import numpy as np
from mesograin.ui.bake_panel.session import session


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


def check_cycles_bakes_beside_and_the_panel_shows_both(window):
    bpy.context.preferences.addons["mesograin"].preferences.cache_folder = str(window.folder / "cache")
    area, properties = yield from prepare(window, width=128, height=64, samples=16, compare=True, reference_samples=512)
    quiet = yield from window.picture(properties)
    state = (bpy.data.filepath, bpy.data.is_dirty, len(bpy.data.images), len(bpy.data.scenes))
    assert window.call(properties, "bake") == {"FINISHED"}
    assert session.running and not bpy.ops.mesograin.bake.poll()
    assert (bpy.data.filepath, bpy.data.is_dirty, len(bpy.data.images), len(bpy.data.scenes)) == state
    yield from window.until(lambda: session.task.detail)
    busy = yield from window.picture(properties)
    assert (np.abs(busy - quiet).max(axis=-1) > 0.1).sum() > 500, "the panel shows no progress"
    silent = yield from window.silence_until(
        lambda: not session.running and not bpy.app.timers.is_registered(session.poll))
    assert silent < 0.75, f"Blender did not answer for {silent:.0%} of the bake"
    assert session.error == session.task.error == "" and session.results["metrics"]["relative_l1"] < 0.05
    shown = yield from window.picture(properties)
    assert (np.abs(shown - quiet).max(axis=-1) > 0.1).sum() > 1000, "the panel shows no numbers"
    area.type = "IMAGE_EDITOR"
    try:
        for picture, file in (("model", "bake.mesograin.exr"), ("reference", "bake.cycles.exr")):
            with window.override(area):
                bpy.ops.mesograin.show_bake(picture=picture)
            image = area.spaces.active.image
            assert image.name == f"Mesograin bake Sphere {picture}" and image.filepath.endswith(file)
        yield from window.picture(area)
        with window.override(area):
            try:
                outcome = str(bpy.ops.mesograin.show_bake(picture="significance"))
            except RuntimeError as error:  # how a script hears of an operator's report
                outcome = str(error)
        assert "no picture 'significance'" in outcome
    finally:
        area.type = "VIEW_3D"


def check_a_comparison_of_bakes_is_cancelled_at_once(window):
    _, properties = yield from prepare(window, width=512, height=512, compare=True, reference_samples=1024,
                                       out=str(window.folder / "never.exr"))
    bpy.data.materials["Translucent"].mesograin.model = "model_1"
    window.call(properties, "bake")
    yield from window.until(lambda: session.task.detail)
    bake = session.task
    window.call(properties, "cancel_bake")
    assert not session.running and bake.cancelled
    yield from window.picture(properties)
    yield from window.until(lambda: not list(window.folder.glob(".unfinished-*")), timeout=10.0)
    assert not list(window.folder.glob("never*")) and session.error == "" and session.results is None
    assert bpy.ops.mesograin.bake.poll()
