# What an impatient artist does while something renders: switches, reloads, saves, cancels. Nothing breaks, and the
# picture that follows is right.
import threading

import addon_utils
import bpy
from mesograin.engine import engine, status, writing
from mesograin.schema import models
from mesograin.studies.background import job as jobs
from mesograin.ui.bake_panel import session as baking
from mesograin.ui.compare_panel import session as comparing

ENDLESS = 1 << 16
RENDERS = 24


def settle(window, area):
    """Lets the viewport come to its rest and holds it against what the native module renders alone."""
    bpy.context.scene.mesograin.viewport_samples = 4
    status.clear()
    grain = bpy.data.materials["Translucent"].mesograin
    grain.model, grain.reflectance = "lambert", (0.6, 0.5, 0.4)
    picture = yield from window.converged_picture(area)
    assert status.complaints() == []
    window.assert_same(picture, window.expected_picture(area))


def check_models_switch_while_rendering(window):
    area = yield from window.open("sphere", samples=ENDLESS)
    grain = bpy.data.materials["Translucent"].mesograin
    for _ in range(3):
        for model in models.NAMES:
            grain.model = model
            yield from window.seconds(0.1)
    yield from settle(window, area)


def check_objects_come_and_go_while_rendering(window):
    area = yield from window.open("sphere", samples=ENDLESS)
    bpy.data.materials["Translucent"].mesograin.model = "model_3"
    sphere = bpy.data.objects["Sphere"]
    for _ in range(10):
        copy = bpy.data.objects.new("Copy", sphere.data.copy())
        bpy.context.scene.collection.objects.link(copy)
        yield from window.seconds(0.1)
        bpy.data.meshes.remove(copy.data)  # and the object with it
        yield from window.seconds(0.05)
    assert "Copy" not in bpy.data.objects
    yield from settle(window, area)


def check_tabs_are_shown_and_left_while_rendering(window):
    """Blender frees what was drawn of a tab when it shows another."""
    area = yield from window.open("sphere", samples=ENDLESS)
    grain = bpy.data.materials["Translucent"].mesograin
    bpy.context.view_layer.objects.active = bpy.data.objects["Sphere"]
    properties = yield from window.render_properties(area)
    for model in models.NAMES:
        grain.model = model
        for tab in ("MATERIAL", "DATA", "VIEW_LAYER", "WORLD", "RENDER"):
            properties.spaces.active.context = tab
            yield from window.seconds(0.2)
    yield from window.restore()
    yield from settle(window, area)


def check_film_turns_transparent_and_back_while_rendering(window):
    area = yield from window.open("sphere")
    opaque = yield from window.converged_picture(area)
    bpy.context.scene.render.film_transparent = True
    yield from window.seconds(0.5)
    through = yield from window.picture(area)
    corner = (slice(60, 90), slice(60, 90))
    assert opaque[corner].max() < 0.02 and through[corner].min() > 0.02, "the background does not shine through"
    bpy.context.scene.render.film_transparent = False
    yield from window.seconds(0.5)
    window.assert_same((yield from window.converged_picture(area)), opaque)
    yield from settle(window, area)


def check_file_is_saved_and_opened_again_while_rendering(window):
    area = yield from window.open("sphere", samples=ENDLESS)
    bpy.data.materials["Translucent"].mesograin.model = "model_1"
    yield from window.until(lambda: status.get(status.VIEWPORT) is not None)
    path = str(window.folder / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    yield from window.seconds(0.2)
    bpy.ops.wm.revert_mainfile()
    yield from window.seconds(0.5)
    assert bpy.data.filepath == path and bpy.data.materials["Translucent"].mesograin.model == "model_1"
    area = window.area_of_type("VIEW_3D")
    window.prepare(area)
    yield from settle(window, area)


def check_add_on_is_disabled_and_enabled_while_everything_runs(window):
    area = yield from window.open("sphere", samples=ENDLESS)
    scene = bpy.context.scene
    scene.mesograin_bake.samples, scene.mesograin_bake.out = 1 << 20, str(window.folder / "never.exr")
    scene.mesograin_compare.models, scene.mesograin_compare.out = {"model_1"}, str(window.folder / "never")
    panel = yield from window.render_properties(area)
    yield from window.until(lambda: status.get(status.VIEWPORT) is not None)
    old = window.session(area)
    window.call(panel, "bake")
    window.call(panel, "compare")
    bake, job = baking.session.task, comparing.session.task
    yield from window.seconds(1.0)
    assert bake.running and job.running
    addon_utils.disable("mesograin")
    assert not bake.running and old.stopped and job.state == jobs.CANCELLED
    yield from window.until(lambda: job.wait(0.0), timeout=10.0)
    yield from window.seconds(0.5)
    assert not (window.folder / "never.exr").exists() and not (window.folder / "never").exists()
    addon_utils.enable("mesograin")
    assert bpy.data.materials["Translucent"].mesograin.model == "lambert", "what the file said was lost"
    yield from window.seconds(0.5)
    yield from window.restore()
    yield from settle(window, area)


def check_cancel_at_once(window):
    area = yield from window.open("sphere")
    scene = bpy.context.scene
    scene.mesograin_bake.samples, scene.mesograin_bake.out = 1 << 20, str(window.folder / "never.exr")
    scene.mesograin_compare.models, scene.mesograin_compare.out = {"model_1"}, str(window.folder / "never")
    panel = yield from window.render_properties(area)
    for _ in range(3):
        for operator, session in (("bake", baking.session), ("compare", comparing.session)):
            window.call(panel, operator)
            task = session.task
            window.call(panel, f"cancel_{operator}")
            yield from window.until(lambda task=task: not task.running, timeout=10.0)
            task.wait()
            assert session.error == ""
    assert not list(window.folder.glob("never*"))
    yield from window.restore()
    yield from settle(window, area)


def check_renders_begin_and_end_while_an_animation_plays(window):
    area = yield from window.open("sphere", samples=ENDLESS)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.mesograin.samples = 32, 32, 1
    bpy.context.preferences.view.render_display_type = "NONE"
    sphere = bpy.data.objects["Sphere"]
    for frame, height in ((1, -0.2), (25, 0.2), (50, -0.2)):
        sphere.location.z = height
        sphere.keyframe_insert("location", frame=frame)
    for number in range(RENDERS):
        yield from window.do(area, bpy.ops.screen.animation_play)  # or it pauses
        status.clear()
        assert (yield from window.press_f12(area)) == {"RUNNING_MODAL"}
        yield from window.do(area, lambda number=number: bpy.ops.ed.undo_push(message=f"Rendered {number}"))
        yield from window.until(lambda: not bpy.app.is_job_running("RENDER"))
        assert status.get(status.RENDER).samples == 1
    if window._window().screen.is_animation_playing:
        yield from window.do(area, bpy.ops.screen.animation_play)
    yield from settle(window, area)


def check_timers_may_write_after_a_render_that_began_amid_a_panels_drawing(window):
    area = yield from window.open("sphere")
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.mesograin.samples = 32, 32, 1
    bpy.context.preferences.view.render_display_type = "NONE"
    properties = yield from window.render_properties(area)
    began, drawing, rendering, drawn = (threading.Event() for _ in range(4))

    class SlowPanel(bpy.types.Panel):
        bl_idname, bl_label, bl_order = "MESOGRAIN_PT_slow", "Slow", 0
        bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "render"

        def draw(self, _context):
            if began.is_set() and not drawn.is_set():
                drawing.set()
                rendering.wait(10.0)
                drawn.set()

    def before(*_arguments):  # in the render's thread
        began.set()
        properties.tag_redraw()
        drawing.wait(10.0)

    def render(self, depsgraph):
        rendering.set()
        drawn.wait(10.0)
        threading.Event().wait(0.2)  # until that panel was drawn, to the last of it
        original(self, depsgraph)

    original, engine.MesograinRenderEngine._render = engine.MesograinRenderEngine._render, render
    refusals, allow = [], writing.allow
    writing.allow = lambda: refusals.append(allow())
    bpy.utils.register_class(SlowPanel)
    bpy.app.handlers.render_pre.append(before)
    try:
        yield from window.seconds(0.5)
        yield from window.press_f12(area)
        yield from window.until(drawn.is_set)
        yield from window.until(lambda: not bpy.app.is_job_running("RENDER"))
    finally:
        bpy.app.handlers.render_pre.remove(before)
        engine.MesograinRenderEngine._render = original
    yield from window.seconds(2.0 * writing.LOOK_SECONDS)
    writing.allow = allow
    print(f"{window.check}: refused {len(refusals)} times", flush=True)
    if writing.refused():
        allow()  # lest what follows fails too
        raise AssertionError("Blender still lets timers write nothing")
    scene.render.resolution_percentage = 50
    bpy.utils.unregister_class(SlowPanel)
    yield from window.restore()
    yield from settle(window, area)
