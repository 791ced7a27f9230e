"""Runs inside Blender's window: makes one change after the other and notes how long each takes to be seen: drag.py.

    blender --factory-startup --python drag_in_window.py -- OUT.json CHANGES MODEL ...
"""
import json
import math
import pathlib
import subprocess
import sys
import time

import addon_utils
import bpy

PAUSE = 0.01  # s between looks
SETTLE = 1.0  # s before a setting is measured
MOST = 30.0  # s for one change


class Clock:
    """Notes when a region's drawing is over, and what the render engine took of the main thread meanwhile."""

    def __init__(self, engine):
        self.drawn = 0  # redraws
        self.when = 0.0
        self.spent = {"view_update": [], "view_draw": []}
        self.session = None
        for name in self.spent:
            self._time(engine, name)
        bpy.types.SpaceView3D.draw_handler_add(self._note, (), "WINDOW", "POST_PIXEL")

    def _time(self, engine, name):
        inner, times = getattr(engine, name), self.spent[name]

        def timed(this, context, depsgraph):  # Blender counts them
            start = time.perf_counter()
            inner(this, context, depsgraph)
            times.append(1000.0 * (time.perf_counter() - start))
            self.session = this._session

        setattr(engine, name, timed)

    def _note(self):
        self.drawn += 1
        self.when = time.perf_counter()

    def shows_news(self):
        """Whether the picture last drawn is of all that was asked for."""
        session = self.session
        return (session is not None and session._seen and session.samples > 0 and session._next_scene is None
                and session._next_camera is None and session._kept is None)


class Mouse:
    """Turns the view with its middle button, as an artist does."""

    def __init__(self, window, region, view):
        self._middle = region.x + region.width // 2, window.height - 1 - (region.y + region.height // 2)
        self._view, self._before = view, None

    def press(self):
        self._tell("mousemove", *self._middle, "mousedown", 2)

    def release(self):
        self._tell("mouseup", 2)

    def drag(self, number):
        self._before = self._view.view_matrix.copy()
        self._tell("mousemove_relative", "--", 4 if number // 25 % 2 else -4, 0)

    def has_dragged(self):
        return self._view.view_matrix != self._before

    @staticmethod
    def _tell(*words):
        subprocess.run(["xdotool", *map(str, words)], check=True, timeout=20)


def measured(clock, area, change, rendered, changes, changed=lambda: True):
    """A generator for a timer; its value is {"wait": [ms], ...}. changed(): whether Blender has heard of the change."""
    for times in clock.spent.values():
        times.clear()
    waits = []
    for number in range(changes):
        drawn = clock.drawn
        start = time.perf_counter()
        change(number)
        if changed():
            area.tag_redraw()
        while not (changed() and clock.drawn > drawn and clock.when > start and (not rendered or clock.shows_news())):
            if time.perf_counter() - start > MOST:
                raise RuntimeError("a change was never seen")
            yield PAUSE
        waits.append(1000.0 * (clock.when - start))
    return {"wait": waits, **{name: list(times) for name, times in clock.spent.items()}}


def work(out, changes, models):
    from mesograin.engine import engine

    path = pathlib.Path(__file__).resolve().parents[2] / "blend_files/sphere.blend"
    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False)
    clock = Clock(engine.MesograinRenderEngine)
    screen = bpy.context.window_manager.windows[0].screen
    area = max((area for area in screen.areas if area.type == "VIEW_3D"), key=lambda area: area.width * area.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    space = area.spaces.active
    space.overlay.show_overlays = space.show_gizmo = False
    scene, grain = bpy.context.scene, bpy.data.materials["Translucent"].mesograin
    scene.mesograin.viewport_samples = 1 << 14
    view = space.region_3d
    view.view_perspective, view.view_distance = "PERSP", 7.0

    def drag_parameter(number):
        grain.reflectance = grain.sigma_a = [0.1 + 0.05 * math.sin(0.3 * number + channel) for channel in range(3)]

    def drag_view(number):
        view.view_rotation = (math.cos(0.01 * number), 0.0, math.sin(0.01 * number), 0.0)

    mouse = Mouse(bpy.context.window_manager.windows[0], region, view)

    def by_mouse(rendered):
        mouse.press()
        yield SETTLE
        times = yield from measured(clock, area, mouse.drag, rendered, changes, mouse.has_dragged)
        mouse.release()
        yield SETTLE
        return times

    def by_script(change):
        return lambda rendered: measured(clock, area, change, rendered, changes)

    found = {"size": (region.width, region.height)}
    for name, drag in (("parameter", by_script(drag_parameter)), ("view", by_script(drag_view)), ("mouse", by_mouse)):
        space.shading.type = "SOLID"
        yield SETTLE
        found[f"{name} solid"] = yield from drag(False)
        space.shading.type = "RENDERED"
        for model in models:
            grain.model = model
            yield SETTLE
            deadline = time.perf_counter() + MOST
            while clock.session is None or clock.session.preparing is not None and time.perf_counter() < deadline:
                yield PAUSE
            found[f"{name} {model}"] = yield from drag(True)
            out.write_text(json.dumps(found))
    out.write_text(json.dumps(found))


def main():
    addon_utils.enable("mesograin", default_set=True)
    out, changes, *models = sys.argv[sys.argv.index("--") + 1:]
    steps = work(pathlib.Path(out), int(changes), models)

    def step():
        try:
            return next(steps)
        except StopIteration:
            bpy.ops.wm.quit_blender()
            return None

    bpy.app.timers.register(step, first_interval=1.0, persistent=True)


main()
