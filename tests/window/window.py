# A Blender window as the checks see it: open a file in it, wait, touch it, look at its pixels.
import contextlib
import pathlib
import struct
import time
import zlib

import bpy
import hand
import numpy as np
from mesograin import native_module
from mesograin.engine import engine, status
from mesograin.scene import export, meshes

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIMEOUT = 60.0
RIM = 28
PANELS_MOVE = 0.3  # s, ANIMATION_TIME in Blender's interface_panel.c


class Window:
    """Waits are generators to be used by `yield from`; between their steps Blender runs its main loop."""

    def __init__(self, folder, screen):
        self.folder = folder  # of the screenshots
        self.screen = screen  # Xvfb's framebuffer, a file
        self.native = None if native_module.problem() else native_module.get()
        self.check = ""
        self._shots = 0
        self._opened = []

    def begin(self, check):
        self.check, self._shots = check, 0
        self._take_gl_errors()

    def end(self):
        errors = self._take_gl_errors()
        assert errors == [], errors

    def _take_gl_errors(self):
        try:
            return self.native.take_gl_errors() if self.native else []
        except self.native.Error:  # without a device there is no OpenGL to complain
            return []

    # Waiting

    def seconds(self, duration):
        until = time.monotonic() + duration
        while time.monotonic() < until:
            yield 0.05

    def until(self, condition, timeout=TIMEOUT):
        deadline = time.monotonic() + timeout
        while not condition():
            assert time.monotonic() < deadline, f"{timeout} s were not enough; {status.complaints()}"
            yield 0.05

    def silence_until(self, condition, timeout=120.0):
        """Waits as `until`; gives the longest time that Blender did not answer, as a share of the whole."""
        started = before = time.monotonic()
        longest = 0.0

        def answered():
            nonlocal longest, before
            now = time.monotonic()
            longest, before = max(longest, now - before), now
            return condition()

        yield from self.until(answered, timeout)
        return longest / (time.monotonic() - started)

    # Files and areas

    @staticmethod
    def blend_file(name):
        return ROOT / "blend_files" / f"{name}.blend"

    def open(self, name, samples=4):
        """Opens a file of blend_files with its materials Lambertian, its suns no brighter than the display, and the
        main 3D viewport Rendered; gives the viewport's area."""
        bpy.ops.wm.open_mainfile(filepath=str(self.blend_file(name)), load_ui=False)
        scene = bpy.context.scene
        scene.view_settings.view_transform, scene.view_settings.exposure = "Standard", 0.0
        scene.render.film_transparent = False
        scene.render.dither_intensity = 0.0
        scene.mesograin.viewport_samples = samples
        for material in bpy.data.materials:
            material.mesograin.model = "lambert"
            material.mesograin.reflectance = (0.8, 0.8, 0.8)
        for light in bpy.data.lights:
            light.energy = min(light.energy, 20.0) * 0.1
        area = self.area_of_type("VIEW_3D")
        self.prepare(area)
        status.clear()
        yield from self.seconds(0.2)
        return area

    def prepare(self, area):
        """Rendered, with nothing drawn over the picture, looking at the origin from +z at a distance of 7."""
        space = area.spaces.active
        space.shading.type = "RENDERED"
        space.overlay.show_overlays = False
        space.show_gizmo = False
        with self.override(area):  # Blender crashes where a region is hidden without one
            for name in ("header", "tool_header", "toolbar", "ui"):
                if getattr(space, f"show_region_{name}"):
                    setattr(space, f"show_region_{name}", False)
        view = space.region_3d
        view.view_perspective = "PERSP"
        view.view_location, view.view_distance = (0.0, 0.0, 0.0), 7.0
        view.view_rotation = (1.0, 0.0, 0.0, 0.0)

    def area_of_type(self, kind):
        return max((area for area in self._window().screen.areas if area.type == kind),
                   key=lambda area: area.width * area.height)

    def split(self, area):
        """Splits an area side by side; gives both halves."""
        before = set(self._window().screen.areas)
        with self.override(area):
            bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
        yield from self.seconds(0.3)
        [new] = set(self._window().screen.areas) - before
        self._opened.append(new)
        self.prepare(new)
        yield from self.seconds(0.3)
        return area, new

    def render_properties(self, area):
        """Splits an area; gives the new half, which shows the render properties."""
        _, properties = yield from self.split(area)
        properties.type = "PROPERTIES"
        yield from self.seconds(0.3)  # its tabs are known once it was drawn
        properties.spaces.active.context = "RENDER"
        yield from self.seconds(0.2)
        return properties

    def do(self, area, function):
        """Calls function() from where a key over this area would; gives what it returns. The way to whatever begins a
        render, and to whatever is done beside one."""
        return (yield from hand.do(self, area, function))

    def press_f12(self, area):
        """Gives the answer of the operator."""
        return (yield from self.do(area, lambda: bpy.ops.render.render("INVOKE_DEFAULT")))

    def call(self, area, operator):
        """What a click on the button of `mesograin.<operator>` in this area does; gives the operator's answer."""
        with self.override(area):
            return getattr(bpy.ops.mesograin, operator)("INVOKE_DEFAULT")

    def panels_at_rest(self):
        """Waits until an area may be closed."""
        # A panel that changed its height moves those below it. Blender 3.4 frees panels with their area but not the
        # handler that moves them, and dies of it at the next tick, whosever panel it is. One wait may be over within
        # one slow redraw: several let Blender begin to move them, get there, and be told that it did.
        for _ in range(5):
            yield from self.seconds(PANELS_MOVE)

    def restore(self):
        """Closes what `split` opened."""
        if self._opened:
            yield from self.panels_at_rest()
        while self._opened:
            with self.override(self._opened.pop()):
                bpy.ops.screen.area_close()
            yield from self.seconds(0.3)

    def region(self, area):
        return next(region for region in area.regions if region.type == "WINDOW")

    @contextlib.contextmanager
    def override(self, area):
        """Never where a render runs, nor to begin one: see hand.py."""
        assert not bpy.app.is_job_running("RENDER"), "Blender may crash of an override beside a render: use `do`"
        with bpy.context.temp_override(window=self._window(), area=area, region=self.region(area)):
            yield
            assert not bpy.app.is_job_running("RENDER"), "Blender may crash of a render begun so: use `press_f12`"

    @staticmethod
    def _window():
        return bpy.context.window_manager.windows[0]

    @staticmethod
    def session(area):
        """The session of the live engine whose picture has the size of the area's region."""
        region = next(region for region in area.regions if region.type == "WINDOW")
        live = [session for session in engine._sessions if not session.stopped and session.has_scene]
        if len(live) == 1:
            return live[0]
        [match] = [session for session in live if session.size == (region.width, region.height)]
        return match

    # Mouse and keys

    def drag(self, area, button, offset, steps=6):
        region, window = self.region(area), self._window()
        x, y = region.x + region.width // 2, region.y + region.height // 2
        window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
        yield 0.1
        window.event_simulate(type=button, value="PRESS", x=x, y=y)
        for step in range(1, steps + 1):
            yield 0.05
            at = {"x": x + offset[0] * step // steps, "y": y + offset[1] * step // steps}
            window.event_simulate(type="MOUSEMOVE", value="NOTHING", **at)
        yield 0.05
        window.event_simulate(type=button, value="RELEASE", **at)
        yield 0.2

    def point_at(self, area):
        """Moves the mouse to the middle of an area; gives where that is."""
        region = self.region(area)
        at = {"x": region.x + region.width // 2, "y": region.y + region.height // 2}
        self._window().event_simulate(type="MOUSEMOVE", value="NOTHING", **at)
        yield 0.05
        return at

    def press(self, area, key, **held):
        """A key, with `ctrl`, `shift` or `alt` held where they are True."""
        window, at = self._window(), (yield from self.point_at(area))
        for value in ("PRESS", "RELEASE"):
            window.event_simulate(type=key, value=value, **at, **held)
            yield 0.05

    def write(self, words):
        """Types letters, spaces and quotes; the mouse stays where it is."""
        for letter in words:
            key = {" ": "SPACE", "'": "QUOTE"}.get(letter, letter.upper())
            self._window().event_simulate(type=key, value="PRESS", unicode=letter)
            self._window().event_simulate(type=key, value="RELEASE")
            yield 0.02

    # Pixels

    def converged_picture(self, area):
        """Waits until every viewport has all its samples, then looks at this one."""
        target = bpy.context.scene.mesograin.viewport_samples

        def converged():
            live = [session for session in engine._sessions if not session.stopped and session.has_scene]
            return (status.get(status.VIEWPORT) is not None and live
                    and all(session.samples == target and not session.busy for session in live))

        yield from self.until(converged)
        return (yield from self.picture(area))

    def picture(self, area, whole=False):
        """The pixels of an area's main region, or of the whole area, as the screen shows them, (h, w, 3) in 0..1 with
        row 0 at the top; kept as a PNG: of a whole area, else of the screen."""
        area.tag_redraw()
        yield from self.seconds(0.3)
        self._shots += 1
        shot = self._screen()
        shown = area if whole else self.region(area)
        top = shot.shape[0] - shown.y - shown.height
        pixels = shot[top:top + shown.height, shown.x:shown.x + shown.width]
        save_picture(pixels if whole else shot, self.folder / f"{self.check}_{self._shots}.png")
        return pixels

    def _screen(self):
        """What the virtual screen shows, (h, w, 3) in 0..1. Read from Xvfb, not by Blender's own screenshot operator,
        which reads a front buffer that Mesa 25 leaves black."""
        data = self.screen.read_bytes()
        # X11/XWDFile.h: a big-endian header of 25 words, colours of 12 bytes each, then the pixels, here B, G, R, pad.
        header = struct.unpack(">25I", data[:100])
        header_size, width, height, bytes_per_line, colours = (header[i] for i in (0, 4, 5, 12, 19))
        rows = np.frombuffer(data, dtype=np.uint8, offset=header_size + 12 * colours, count=height * bytes_per_line)
        pixels = rows.reshape(height, bytes_per_line)[:, :4 * width].reshape(height, width, 4)
        return pixels[..., 2::-1].astype(np.float32) / 255.0

    def expected_picture(self, area, count_sent=True):
        """What the native module alone renders for the area's matrices, through the display transform of 'Standard'."""
        depsgraph = bpy.context.evaluated_depsgraph_get()
        # The viewport's own meshes, lest the check itself sends any.
        cache = meshes.MeshCache() if count_sent else self.session(area).cache
        scene = export.read_scene(depsgraph, cache).to_native()
        region, data = self.region(area), area.spaces.active.region_3d
        view = self.native.View(region.width, region.height)
        view.set_scene(scene)
        view.set_camera(self.native.Camera(np.array(data.view_matrix, dtype=np.float64),
                                           np.array(data.window_matrix, dtype=np.float64)))
        view.render(bpy.context.scene.mesograin.viewport_samples)
        return self.display(view.read()[..., :3])

    @staticmethod
    def display(linear):
        """The sRGB transfer function, IEC 61966-2-1."""
        linear = np.clip(linear, 0.0, 1.0)
        return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.power(linear, 1.0 / 2.4) - 0.055)

    @staticmethod
    def linear(display):
        return np.where(display <= 0.04045, display / 12.92, np.power((display + 0.055) / 1.055, 2.4))

    @staticmethod
    def inner(picture):
        """Without the rim, where Blender draws arrows that bring hidden regions back."""
        return picture[RIM:-RIM, RIM:-RIM]

    @classmethod
    def assert_same(cls, picture, expected):
        """Equal in linear light, but for eight bits and for the 1/256 by which Blender's bilinear lookup blurs."""
        assert picture.shape == expected.shape, (picture.shape, expected.shape)
        difference = np.abs(cls.linear(cls.inner(picture)) - cls.linear(cls.inner(expected)))
        assert difference.mean() < 0.002 and difference.max() < 0.015, (
            f"mean difference {difference.mean():.4f}, largest {difference.max():.4f} at "
            f"{np.unravel_index(difference.argmax(), difference.shape)}")


def save_picture(picture, path):
    """Writes (h, w, 3) in 0..1 as a PNG, to be looked at. Not by Blender: where one of its images is removed Blender 5
    tags all of the scene as changed, and what is checked next would have it read again."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, _ = picture.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # each begins with its filter, which is none
    rows[:, 1:] = np.round(255.0 * picture).reshape(height, -1)
    header = struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)  # eight bits of R, G and B
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))
