# Does things in a Blender window from where a key does them: Blender's own context, and nothing overridden in Python.
"""Not `Context.temp_override`, at least not while a render or a preview may begin or run: an operator runs without
Python's lock, and where Python overrides anything Blender before Python 3.12 looks that up without taking the lock
whenever another thread holds it (BPY_context_member_get in its bpy_interface.c). Both threads then allocate at once,
and Blender dies sooner or later, most often in the first lines that an engine runs in the render's thread."""
import subprocess
import time

import bpy

KEY = "PAUSE"  # for which Blender has no use
TRIES = 3  # a loaded machine may move the focus after it took the key
TICKS, SECONDS = 100, 10.0  # of Blender's loop and of time that each may take, whichever is later

_deed = None  # what the next press of the key does


class Unanswered(Exception):
    """Blender did not take the key: something else has the keyboard."""


class _Deed:
    def __init__(self, function):
        self._function = function
        self.done = False
        self.outcome = self.error = None

    def do(self):
        self.done = True
        try:
            self.outcome = self._function()
        except Exception as error:  # it is its owner's
            self.error = error


class MESOGRAIN_OT_hand(bpy.types.Operator):
    bl_idname = "mesograin.hand"
    bl_label = "Hand"
    bl_options = {"INTERNAL"}

    def execute(self, _context):
        global _deed
        deed, _deed = _deed, None
        if deed is None:  # it was given up
            return {"CANCELLED"}
        deed.do()
        return {"FINISHED"}


def do(window, area, function):
    """Calls function() where the area's main region is under the mouse; gives what it returned. Raises Unanswered."""
    global _deed
    _register()
    deed = _deed = _Deed(function)
    for _ in range(TRIES):
        yield from _press(window, area)
        yield from _answered(deed)
        if deed.done:
            break
    _deed = None
    if not deed.done:
        raise Unanswered(f"Blender did not take the key {KEY} over {area.type}")
    if deed.error is not None:
        raise deed.error
    return deed.outcome


def _answered(deed):
    ticks, until = 0, time.monotonic() + SECONDS
    while not deed.done and (ticks < TICKS or time.monotonic() < until):
        ticks += 1
        yield 0.02


def _register():
    if not hasattr(bpy.types, "MESOGRAIN_OT_hand"):
        bpy.utils.register_class(MESOGRAIN_OT_hand)
        keymap = bpy.context.window_manager.keyconfigs.addon.keymaps.new("Window")
        keymap.keymap_items.new(MESOGRAIN_OT_hand.bl_idname, KEY, "PRESS")


def _press(window, area):
    x, y = _free_place(area, window.region(area))
    if bpy.app.use_event_simulate:  # Blender takes no others
        shown = bpy.context.window_manager.windows[0]
        shown.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
        for value in ("PRESS", "RELEASE"):
            shown.event_simulate(type=KEY, value=value, x=x, y=y)
    else:
        height = bpy.context.window_manager.windows[0].height
        # Without a window manager nobody but us gives Blender's window the focus.
        words = f"mousemove {x} {height - 1 - y} search --onlyvisible --class Blender windowfocus key Pause"
        subprocess.run(["xdotool", *words.split()], check=False, timeout=20, capture_output=True)
    yield 0.0


def _free_place(area, region):
    """In a region and in none that lies over it, as near its middle as may be."""
    def covered(x, y):
        return any(other != region and other.width > 1 and other.height > 1
                   and other.x <= x < other.x + other.width and other.y <= y < other.y + other.height
                   for other in area.regions)

    shares = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9)
    places = [(region.x + int(across * region.width), region.y + int(up * region.height))
              for across in shares for up in shares]
    return next((place for place in places if not covered(*place)), places[0])
