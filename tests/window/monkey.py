# A monkey at Blender's window: does one operation after the other, drawn by a seed, and keeps book of memory and time.
import collections
import faulthandler
import inspect
import math
import random
import statistics
import subprocess
import sys
import time

import bmesh
import bpy
import hand
import monkey_work
import resident
from mesograin import compat
from mesograin.engine import status

SCREEN = (640, 480)  # small: without a GPU a redraw of Blender costs by its pixels
BETWEEN = (0.02, 0.05, 0.15, 0.4)  # s that may pass between two operations
MOST_GRAINS = 128  # of a heap: Blender's own drawing of the 2000 in heap.blend takes a minute where no GPU is
TOO_LONG = 20.0  # s without an answer that are worth a word
STEPS_OF_A_DRAG = 6
MOST_TRIES = 60  # to open a file
MOST_TOLD = 8  # of the operations that took longest


class Monkey:
    """What monkey_work's operations are given."""

    def __init__(self, window, seed):
        self.window = window
        self.folder = window.folder
        self.random = random.Random(seed)
        self.longest = (0.0, "")  # s in which Blender did not answer, and the operation
        self.unanswered = 0  # times that Blender's window did not take the key for an operator
        self.took = collections.Counter()  # s that went to each operation, and to being at home

    # Choices

    def one_of(self, things):
        """One of a collection, or None; by name, lest the choice hangs on the order in memory."""
        things = list(things)
        return self.random.choice(things) if things else None

    def mesh_object(self):
        return self.one_of(thing for thing in bpy.context.scene.objects if thing.type == "MESH")

    def areas(self, kind=None):
        return [area for area in self.window._window().screen.areas if kind in (None, area.type)]

    def viewport(self):
        return max(self.areas("VIEW_3D"), key=lambda area: area.width * area.height, default=None)

    def blend_file(self, name):
        return self.window.blend_file(name)

    def pause(self):
        yield from self.window.seconds(self.random.choice(BETWEEN))

    # Deeds

    def operator(self, group, name, *arguments, **settings):
        """Calls an operator as its key would, if it can be; tells whether it was. Its refusals are no news."""
        def call():
            operator = getattr(getattr(bpy.ops, group), name)
            if not operator.poll():
                return False
            try:
                operator(*arguments, **settings)
            except RuntimeError as refusal:
                if "Traceback" in str(refusal):
                    raise
                return False
            return True

        return (yield from self.at(self.viewport() or self.areas()[0], call))

    def at(self, area, function):
        """Calls function() with the mouse over an area; False where Blender's window did not take the key for it."""
        try:
            return (yield from self.window.do(area, function))
        except hand.Unanswered:
            self.unanswered += 1
            self.press_escape()  # what a render complains of stands in a dialog that takes all keys
            return False
        except RuntimeError as refusal:
            if "poll()" not in str(refusal):
                raise
            return False  # Blender took the mouse to be elsewhere, amid a change of its areas

    def open(self, path, load_ui=False):
        bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=load_ui)
        scene = bpy.context.scene
        scene.render.engine = monkey_work.ENGINE
        scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 96, 64, 100
        scene.mesograin.viewport_samples = 16
        thin_out(bpy.data.meshes.get("Heap"))
        scene.cycles.samples = scene.cycles.preview_samples = 1
        bpy.context.preferences.view.render_display_type = "NONE"
        for area in self.areas("VIEW_3D"):
            # Of a gizmo whose region is gone Blender 4.3 shows the tooltip all the same, and dies of it
            # (WM_gizmomap_tooltip_init).
            area.spaces.active.show_gizmo = False
        area = self.viewport()
        if area is not None:
            area.spaces.active.shading.type = "RENDERED"

    def start_render(self, animation=False):
        scene = bpy.context.scene
        scene.mesograin.samples = self.random.choice((1, 16, 512))
        if scene.camera is None or bpy.app.is_job_running("RENDER"):
            return
        scene.frame_start, scene.frame_end = 1, 3
        scene.render.filepath = str(self.folder / "frame")
        yield from self.operator("render", "render", "INVOKE_DEFAULT", animation=animation)
        yield from self.window.seconds(0.1)

    def split_or_join(self):
        views = self.areas("VIEW_3D")
        if len(views) == 1:
            yield from self.operator("screen", "area_split", direction="VERTICAL", factor=0.5)
        elif len(views) > 1:
            yield from self.window.panels_at_rest()
            views = self.areas("VIEW_3D")
            if len(views) > 1:
                yield from self.at(min(views, key=lambda area: area.width * area.height), bpy.ops.screen.area_close)
        yield from self.window.seconds(0.2)

    def resize_window(self):
        width, height = (self.random.randint(side // 2, side) for side in SCREEN)
        _send("windowsize", str(width), str(height))
        yield from self.window.seconds(0.3)
        if self.random.random() < 0.7:
            _send("windowsize", *map(str, SCREEN))

    def drag_in_viewport(self):
        area = self.viewport()
        if area is None:
            return
        region = self.window.region(area)
        x, y = region.x + region.width // 2, SCREEN[1] - region.y - region.height // 2
        _send_to_screen("mousemove", x, y, "mousedown", 2)
        for step in range(STEPS_OF_A_DRAG):
            _send_to_screen("mousemove", x + 10 * step, y + 4 * step)
            yield 0.03
        _send_to_screen("mouseup", 2)

    def press_escape(self):
        """Without a window manager nobody but us gives Blender's window the focus."""
        _send("windowfocus", "key", "Escape")

    # The day

    def home(self):
        """The sphere, alone in a file of its own, and nothing under way: where memory is compared."""
        if self.window._window().screen.show_fullscreen:
            yield from self.operator("screen", "back_to_previous")
        _send("windowsize", *map(str, SCREEN))
        while bpy.app.is_job_running("RENDER"):
            self.press_escape()
            yield from self.window.seconds(0.2)
        for job in ("bake", "compare"):
            yield from self.operator("mesograin", f"cancel_{job}")
        # With the file's own windows: each view that was split off holds tens of megabytes of Blender's own.
        yield from self._open_once_drawn(self.window.blend_file("sphere"), load_ui=True)
        _send("windowsize", *map(str, SCREEN))
        yield from self.window.seconds(0.5)
        for area in self.areas("VIEW_3D"):  # whose four views, and what they show alone, outlive a file
            if area.spaces.active.local_view is not None:
                yield from self.at(area, bpy.ops.view3d.localview)
            if area.spaces.active.region_quadviews:
                yield from self.at(area, bpy.ops.screen.region_quadview)
        yield from self.window.seconds(0.5)
        bpy.ops.outliner.orphans_purge(do_recursive=True)
        yield from self.window.seconds(0.5)

    def _open_once_drawn(self, path, load_ui):
        """See compat.refuses_writing; a loaded machine takes its time to draw."""
        for last in (*[False] * MOST_TRIES, True):
            for area in self.areas():
                area.tag_redraw()
            yield from self.window.seconds(0.3)
            try:
                self.open(path, load_ui)
                return
            except RuntimeError as refusal:
                if last or not compat.refuses_writing(refusal):
                    raise

    def live(self, operations, home_every):
        """Does so many operations; gives the resident bytes at home, each time it was there."""
        memory = []

        def visit_home():
            started = time.monotonic()
            yield from self.home()
            self.took["home"] += time.monotonic() - started
            # Not after each operation: that would wait for all that the device's thread has to do, as no artist does.
            # Here it is done with the views of the file before, too, whose memory is free then.
            assert self.window._take_gl_errors() == []
            memory.append(resident.settled())
            print(f"monkey at home: {memory[-1] / 1e6:.0f} MB, {resident.holders()}, {self.window.native.sent()}, "
                  f"{sys.getallocatedblocks()} blocks of Python's, "
                  f"{self.unanswered} keys not taken, "
                  f"s so far: {', '.join(f'{name} {took:.0f}' for name, took in self.took.most_common(MOST_TOLD))}",
                  flush=True)

        weights, functions = zip(*monkey_work.WORK)
        for number in range(operations):
            if number % home_every == 0:
                yield from visit_home()
            function = self.random.choices(functions, weights)[0]
            print(f"monkey {number}: {function.__name__}", flush=True)
            faulthandler.dump_traceback_later(TOO_LONG)  # who it is that Blender waits for
            yield from self._do(function)
            faulthandler.cancel_dump_traceback_later()
            yield from self.pause()
        yield from visit_home()
        print(f"monkey: {self.longest[0]:.1f} s at most, for {self.longest[1]}", flush=True)
        return memory

    def _do(self, function):
        started = time.monotonic()
        try:
            worth_a_step = function(self)
            if inspect.isgenerator(worth_a_step):
                worth_a_step = yield from worth_a_step
        except (AttributeError, RuntimeError) as refusal:
            if not compat.refuses_writing(refusal):
                raise
            worth_a_step = False
        if worth_a_step is not False:
            yield from self.operator("ed", "undo_push", message=function.__name__)
        yield 0.0  # Blender's own loop: redraws are what an edit costs
        took = time.monotonic() - started
        self.took[function.__name__] += took
        if took > self.longest[0]:
            self.longest = took, function.__name__
        if took > TOO_LONG:
            print(f"monkey: {function.__name__} took {took:.1f} s; {status.complaints()}", flush=True)


def thin_out(heap):
    """Leaves a mesh whose vertices are grains so few of them, evenly chosen."""
    if heap is None or heap.polygons or len(heap.vertices) <= MOST_GRAINS:
        return
    grains = bmesh.new()
    grains.from_mesh(heap)
    every = math.ceil(len(grains.verts) / MOST_GRAINS)
    bmesh.ops.delete(grains, geom=[grain for number, grain in enumerate(grains.verts) if number % every])
    grains.to_mesh(heap)
    grains.free()


def growth(memory):
    """By which share memory is more at the end than in the middle: medians of the third and of the last quarter."""
    quarter = len(memory) // 4
    return statistics.median(memory[-quarter:]) / statistics.median(memory[2 * quarter:3 * quarter]) - 1.0


def _send(*words):
    """To Blender's window, as the X server delivers it."""
    subprocess.run(["xdotool", "search", "--onlyvisible", "--class", "Blender", *words], check=False, timeout=20,
                   capture_output=True)


def _send_to_screen(*words):
    subprocess.run(["xdotool", *map(str, words)], check=True, timeout=20)
