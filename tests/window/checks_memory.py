# What a long day's operations leave in memory, each done over and over: look_at_memory.py is how it is asked, by hand.
import os

import bpy
import numpy as np
from mesograin.engine import engine
from resident import settled

ENGINE = os.environ.get("MESOGRAIN_ENGINE", "MESOGRAIN")  # another one tells what Blender itself keeps
ROUNDS = int(os.environ.get("MESOGRAIN_ROUNDS", "40"))
TIMES = 5  # of a round
AT_REST = 0.4  # s


def ours(window):
    """How much there is of what we make, by name."""
    sent = window.native.sent()
    return {"sessions": len(engine._sessions), "meshes": sent["meshes"], "materials": sent["materials"],
            "programs": sent["programs"] - sent.get("programs_freed", 0)}


def prepare(window):
    bpy.ops.wm.open_mainfile(filepath=str(window.blend_file("sphere")), load_ui=False)
    scene = bpy.context.scene
    scene.render.engine = ENGINE
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 96, 64, 100
    scene.mesograin.samples, scene.mesograin.viewport_samples = 1, 2
    bpy.context.preferences.view.render_display_type = "NONE"
    area = window.area_of_type("VIEW_3D")
    area.spaces.active.shading.type = "RENDERED"
    yield from window.seconds(AT_REST)
    return area


def over_and_over(window, work):
    """Tells what ROUNDS of `work`, a function that gives steps, leave for each time it is done."""
    area = yield from prepare(window)
    memory = []
    for number in range(ROUNDS):
        for _ in range(TIMES):
            yield from work(window, area)
            area = window.area_of_type("VIEW_3D")
        yield from window.seconds(AT_REST)
        memory.append(settled())
        if number % 8 == 0:
            print(f"{window.check}, {ENGINE}: {TIMES * (number + 1)} times, {memory[-1] / 1e6:.1f} MB, {ours(window)}",
                  flush=True)
    half = memory[ROUNDS // 2:]
    slope = np.polyfit(np.arange(len(half)), half, 1)[0] / TIMES
    print(f"{window.check}, {ENGINE}: {memory[0] / 1e6:.1f} to {memory[-1] / 1e6:.1f} MB in {TIMES * ROUNDS} times, "
          f"{slope / 1e3:.1f} kB each time in the second half, {ours(window)}", flush=True)


def check_opening_a_file(window):
    def work(window, _area):
        yield from prepare(window)
    yield from over_and_over(window, work)


def check_switching_the_engine(window):
    def work(window, _area):
        for name in ("BLENDER_WORKBENCH", ENGINE):
            bpy.context.scene.render.engine = name
            yield from window.seconds(AT_REST)
    yield from over_and_over(window, work)


def check_switching_the_shading(window):
    def work(window, area):
        for kind in ("SOLID", "RENDERED"):
            area.spaces.active.shading.type = kind
            yield from window.seconds(AT_REST)
    yield from over_and_over(window, work)


def check_rendering(window):
    def work(window, area):
        yield from window.press_f12(area)
        yield from window.seconds(0.1)
        yield from window.until(lambda: not bpy.app.is_job_running("RENDER"))
    yield from over_and_over(window, work)


def check_rendering_in_one_thread(window):
    def work(window, area):
        with window.override(area):
            bpy.ops.render.render()
        yield 0.05
    yield from over_and_over(window, work)


def check_undoing(window):
    def work(window, area):
        with window.override(area):
            bpy.ops.ed.undo_push(message="before")
            bpy.data.objects["Sphere"].location.x += 0.1
            bpy.ops.ed.undo_push(message="moved")
            yield from window.seconds(AT_REST)
            bpy.ops.ed.undo()
        yield from window.seconds(AT_REST)
    yield from over_and_over(window, work)


def check_four_views(window):
    def work(window, area):
        for _ in range(2):
            with window.override(area):
                bpy.ops.screen.region_quadview()
            yield from window.seconds(AT_REST)
    yield from over_and_over(window, work)


def check_the_full_screen(window):
    def work(window, area):
        with window.override(area):
            bpy.ops.screen.screen_full_area(use_hide_panels=True)
        yield from window.seconds(AT_REST)
        with window.override(window.area_of_type("VIEW_3D")):
            bpy.ops.screen.back_to_previous()
        yield from window.seconds(AT_REST)
    yield from over_and_over(window, work)


def check_changing_a_shape(window):
    def work(window, _area):
        mesh = bpy.data.objects["Sphere"].data
        mesh.vertices[0].co.z += 0.01
        mesh.update()
        mesh.update_tag()
        yield from window.seconds(AT_REST)
    yield from over_and_over(window, work)


def check_changing_a_model(window):
    def work(window, _area):
        for model in ("model_1", "lambert", "model_2", "model_3"):
            bpy.data.objects["Sphere"].active_material.mesograin.model = model
            yield from window.seconds(AT_REST)
    yield from over_and_over(window, work)
