"""Runs inside Blender's window: makes one change after the other and notes how long each takes to be seen: drag.py.

    blender --factory-startup --python drag_in_window.py -- OUT.json SCENE CHANGES MODEL ...
"""
import json
import math
import pathlib
import subprocess
import sys
import time
import traceback

import addon_utils
import bpy
from mathutils import Quaternion

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import drag_scenes  # noqa: E402

PAUSE = 0.01  # s between looks
SETTLE = 1.0  # s before a setting is measured
MOST = 30.0  # s for one change
PAGES = 6  # of the Properties editor that are looked through


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
    """What an artist does with it, in real events."""

    def __init__(self, window):
        self._height = window.height

    def move_to(self, x, y):
        """In the window's own pixels, from below."""
        self._tell("mousemove", x, self._height - 1 - y)

    def move_by(self, x):
        self._tell("mousemove_relative", "--", x, 0)

    def press(self, button):
        self._tell("mousedown", button)

    def release(self, button):
        self._tell("mouseup", button)

    def scroll(self, lines):
        self._tell("click", "--repeat", lines, 5)

    def key(self, name):
        # Without a window manager nobody else gives Blender's window the focus.
        self._tell("search", "--onlyvisible", "--class", "Blender", "windowfocus", "key", name)

    @staticmethod
    def _tell(*words):
        subprocess.run(["xdotool", *map(str, words)], check=True, timeout=20)


def there_and_back(number):
    """Pixels that the mouse is moved by."""
    return 4 if number // 25 % 2 else -4


class TurnedView:
    """The view, turned with the middle button."""

    BUTTON = 2

    def __init__(self, mouse, region, view):
        self._mouse, self._view, self._before = mouse, view, None
        self._middle = region.x + region.width // 2, region.y + region.height // 2

    def reach(self):
        self._mouse.move_to(*self._middle)
        yield PAUSE

    def drag(self, number):
        self._before = self._view.view_matrix.copy()
        self._mouse.move_by(there_and_back(number))

    def has_dragged(self):
        return self._view.view_matrix != self._before


class Slider:
    """A number of a material in the Properties editor."""

    BUTTON = 1

    def __init__(self, mouse, area, owner, name):
        self._mouse, self._area, self._owner, self.name = mouse, area, owner, name
        self._before = None

    def reach(self):
        """Goes up the editor, and turns the wheel, until the key that copies a property's path copies this one's."""
        region = next(region for region in self._area.regions if region.type == "WINDOW")
        x = region.x + region.width * 3 // 4
        for _ in range(PAGES):
            for y in range(region.y + 5, region.y + region.height, 8):
                if (yield from self._is_at(x, y)):
                    return
            self._mouse.scroll(5)
            yield SETTLE
        raise RuntimeError(f"the Properties editor shows no {self.name}")

    def _is_at(self, x, y):
        manager = bpy.context.window_manager
        manager.clipboard = ""
        self._mouse.move_to(x, y)
        yield 0.1
        self._mouse.key("ctrl+shift+c")
        yield 0.1
        return manager.clipboard.endswith(self.name)

    def drag(self, number):
        self._before = getattr(self._owner, self.name)
        self._mouse.move_by(-there_and_back(number))

    def has_dragged(self):
        return getattr(self._owner, self.name) != self._before


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


def work(out, name, changes, models):
    from mesograin.engine import engine
    from mesograin.schema.models import CHOICES

    stage = drag_scenes.SCENES[name]()
    clock = Clock(engine.MesograinRenderEngine)
    screen = bpy.context.window_manager.windows[0].screen
    area = max((area for area in screen.areas if area.type == "VIEW_3D"), key=lambda area: area.width * area.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    space = area.spaces.active
    space.overlay.show_overlays = space.show_gizmo = False
    scene, grain = bpy.context.scene, stage.material.mesograin
    scene.mesograin.viewport_samples = 1 << 14
    view = space.region_3d
    view.view_perspective, view.view_distance = "PERSP", stage.distance
    view.view_location = stage.middle
    if stage.rotation:
        view.view_rotation = stage.rotation

    def drag_parameter(number):
        grain.reflectance = grain.sigma_a = [
            stage.absorption * (1.0 + 0.5 * math.sin(0.3 * number + channel)) for channel in range(3)]

    def drag_view(number):
        view.view_rotation = Quaternion(stage.axis, 0.02 * number) @ Quaternion(stage.rotation or (1.0, 0.0, 0.0, 0.0))

    mouse = Mouse(bpy.context.window_manager.windows[0])
    properties = next(area for area in screen.areas if area.type == "PROPERTIES")
    bpy.context.view_layer.objects.active = next(
        thing for thing in scene.objects if thing.active_material == stage.material)
    slider = Slider(mouse, properties, grain, "scale")

    def by_mouse(dragged):
        def times(rendered):
            if dragged is slider:
                properties.spaces.active.context = "MATERIAL"
                grain.scale = 1.0
            yield SETTLE
            yield from dragged.reach()
            mouse.press(dragged.BUTTON)
            yield SETTLE
            for _ in range(4):  # no drag begins with the first pixels
                mouse.move_by(4)
                yield SETTLE / 4
            found = yield from measured(clock, area, dragged.drag, rendered, changes, dragged.has_dragged)
            mouse.release(dragged.BUTTON)
            yield SETTLE
            return found

        return times

    def by_script(change):
        return lambda rendered: measured(clock, area, change, rendered, changes)

    found = {"size": (region.width, region.height)}
    for name, drag in (("parameter", by_script(drag_parameter)), ("view", by_script(drag_view)),
                       ("slider", by_mouse(slider)), ("mouse", by_mouse(TurnedView(mouse, region, view)))):
        shown = [model for model in models if name != "slider" or slider.name in CHOICES[model].parameters]
        if not shown:
            continue
        space.shading.type, grain.model = "SOLID", shown[0]
        yield SETTLE
        found[f"{name} solid"] = yield from drag(False)
        space.shading.type = "RENDERED"
        for model in shown:
            grain.model = model
            yield SETTLE
            deadline = time.perf_counter() + MOST
            while clock.session is None or clock.session.preparing is not None and time.perf_counter() < deadline:
                yield PAUSE
            found[f"{name} {model}"] = yield from drag(True)
    out.write_text(json.dumps(found))


def main():
    addon_utils.enable("mesograin", default_set=True)
    out, name, changes, *models = sys.argv[sys.argv.index("--") + 1:]
    steps = work(pathlib.Path(out), name, int(changes), models)

    def step():
        try:
            return next(steps)
        except StopIteration:
            pass
        except Exception:  # who started Blender waits for its end and shows what it said
            traceback.print_exc()
        bpy.ops.wm.quit_blender()
        return None

    bpy.app.timers.register(step, first_interval=1.0, persistent=True)


main()
