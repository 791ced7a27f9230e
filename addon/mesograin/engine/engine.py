# The render engine as Blender calls it: final renders and Rendered viewports, both through the native module.
import contextlib
import dataclasses
import functools
import time
import weakref

import bpy
import numpy as np

from .. import compat, native_module
from ..durations import duration
from ..scene import export, lens, meshes
from . import grace, material_preview, motion, passes, rounds, status, telling, viewport, viewport_text, waiting
from . import writing

# How long a final render may go without showing how far it is.
SHOW_SECONDS = 0.5
# How often a viewport that waits for light between grains is asked for news. Redraws for that would take the processor
# from what is waited for: Blender's own cost more than ours.
LOOK_SECONDS = 0.05
# After so long without a picture of what changed a viewport says that it is drawing: a new program may take seconds.
BEHIND_SECONDS = 1.0

_sessions = weakref.WeakSet()


class MesograinRenderEngine(bpy.types.RenderEngine):
    bl_idname = "MESOGRAIN"
    bl_label = "Mesograin"
    bl_use_preview = not bpy.app.background  # where Blender itself ends after one, of any engine
    bl_use_eevee_viewport = True  # Material Preview stays what it is
    bl_use_shading_nodes_custom = False

    def __init__(self, *args, **kwargs):
        super().__init__(*args, **kwargs)
        self._session = None
        self._telling = telling.Telling(bpy.app.background)
        self._texture = None
        self._transparent = False  # whether the texture is
        self._warnings = ()
        self._error = ""  # of the viewport, one sentence

    def update_render_passes(self, scene, view_layer):
        # The compositor's Render Layers node has a socket for each pass that is registered, and for no other.
        self.register_pass(scene, view_layer, "Combined", 4, "RGBA", "COLOR")
        passes.tell_compositor(self, scene, view_layer)

    # Final renders

    def render(self, depsgraph):
        if self.is_preview:
            self._render_preview(depsgraph)
            return
        try:
            self._render(depsgraph)
        except grace.GivenUp:
            status.put(status.RENDER, status.Status())
        except _sentences() as error:
            self._complain(status.RENDER, status.Status(error=str(error)))

    def _render(self, depsgraph):
        native = native_module.get()
        eyes = _eyes(depsgraph.scene.render)
        started = time.perf_counter()
        width, height = self.resolution_x, self.resolution_y
        region = export.render_region(depsgraph.scene, width, height)
        self.update_stats("", "Mesograin: reading the scene")
        exposure = motion.Exposure(self, depsgraph)
        warnings = exposure.values.warnings
        budgets = rounds.of(depsgraph.scene.mesograin, exposure.values, started, len(eyes))
        view = native.View(region.width, region.height, patient=budgets[0].patient)
        self._result(view.start_scene(exposure.native_scene(exposure.values)), view)
        self._result(view.start_portions(passes.portions(depsgraph.view_layer)), view)
        for warning in warnings:
            self.report({"WARNING"}, warning)

        opaque, picture = not depsgraph.scene.render.film_transparent, None
        for number, (name, budget) in enumerate(zip(eyes, budgets)):
            read_camera = functools.partial(self._camera, depsgraph, width, height, region, name)
            self._result(view.start_camera(read_camera(), region.width, region.height), view)
            passes.add(self, depsgraph.view_layer)
            result = self.begin_result(0, 0, region.width, region.height, layer=depsgraph.view_layer.name, view=name)
            try:
                for share in self._render_samples(view, exposure, read_camera, budget):
                    self._show(result, view, opaque)
                    self.update_result(result)
                    self.update_progress((number + share) / len(eyes))
                if view.samples:  # a cancelled render keeps what it has
                    picture = self._show(result, view, opaque)
                    self._result(view.start_moment(read_camera(), exposure.native_scene(exposure.values)), view)
                    self._show_passes(result, view, depsgraph.view_layer, exposure, read_camera)
            except grace.GivenUp:
                self.end_result(result)
                raise
            except Exception:  # whatever it is: Blender must not be left with a result that never ends
                self.end_result(result, cancel=True)
                raise
            self.end_result(result)
        self._sign(passes.metadata(depsgraph.view_layer, exposure.values))
        for warning in view.warnings:
            self.report({"WARNING"}, warning)
        # As of the last read: the device may be busy now.
        timings = tuple((timing["pass"], timing["milliseconds"]) for timing in picture["timings"]) if picture else ()
        exchange = status.exchange(picture["statistics"]) if picture else None
        came = budget.sentence(view.samples)
        if came:
            self.report({"INFO"}, f"{came}.")
        status.put(status.RENDER, status.Status(view.samples, region.width, region.height, timings,
                                                (*warnings, *view.warnings), exchange=exchange, budget=came))

    def _render_preview(self, depsgraph):
        """Of a material. What is wrong with one is said in its tab, and there is no picture."""
        width, height = self.resolution_x, self.resolution_y
        grain = material_preview.grain_on(depsgraph)
        with contextlib.suppress(grace.GivenUp, *_sentences()):
            native_module.get()
            result = self.begin_result(0, 0, width, height, layer=depsgraph.view_layer.name)
            try:
                if not grain or not material_preview.is_icon(width, height):
                    while material_preview.wait_for_calm(self.test_break) and not self._preview(depsgraph, result):
                        pass
                elif material_preview.is_calm():
                    self._preview(depsgraph, result, grain)
                else:  # Blender, which redraws icons, waits for one that it ends, and begins with it again
                    last = material_preview.owe_icon(grain, width, height)
                    if last is not None:
                        _set_pass(result, "Combined", last)
            finally:
                self.end_result(result)
        if material_preview.is_calm():
            writing.note_render()

    def _preview(self, depsgraph, result, icon=""):
        """Whether it was drawn, or is not wanted any more: it gives way to viewports. icon: the name of the material
        that it is kept for."""
        begun = time.monotonic()

        def is_over():
            return material_preview.changed_since(begun) or self.test_break()

        width, height = self.resolution_x, self.resolution_y
        values = material_preview.staged(export.read_scene(depsgraph, meshes.MeshCache()), depsgraph)
        camera = export.camera_from_scene(depsgraph, width, height)
        view = native_module.get().View(width, height, patient=False)
        self._result(view.start_scene(values.to_native()), view, given_up=is_over)
        self._result(view.start_camera(camera, width, height), view, given_up=is_over)
        for samples in material_preview.rounds(width, height):
            self._result(view.start(samples), view, given_up=is_over)
            if is_over():
                if icon and not self.test_break():
                    material_preview.owe_icon(icon, width, height)
                return self.test_break()
            picture = self._show(result, view, not depsgraph.scene.render.film_transparent)
            self.update_result(result)
        if icon:
            material_preview.keep_icon(icon, picture["pixels"])
        return True

    def _camera(self, depsgraph, width, height, region, eye):
        """native.Camera of the eye of this name, or of the camera as it is."""
        if not eye:
            return export.camera_from_scene(depsgraph, width, height, self.camera_override, region)
        self.active_view_set(eye)
        camera = self.camera_override  # with views by camera names, that of this one
        placed = camera and export.Eye(self.camera_model_matrix(camera), self.camera_shift_x(camera))
        return export.camera_from_scene(depsgraph, width, height, camera, region, placed)

    def _render_samples(self, view, exposure, read_camera, budget):
        """Renders until the rounds of `budget` end, or a cancel, and yields the share that is done whenever it is time
        to show it."""
        self._await_light(view, budget)
        shown, first, seen = time.perf_counter(), True, exposure.values
        while not self.test_break():
            count = budget.next(view.samples, lambda: self._read(view)["pixels"], time.perf_counter())
            if count == 0:
                return
            with contextlib.closing(exposure.moments(read_camera, count)) as moments:
                for values, camera, samples in moments:
                    if exposure.blurred:
                        other = None if values is seen else exposure.native_scene(values)
                        self._result(view.start_moment(camera, other), view)
                        seen = values
                    for now in self._draw_some(view, samples, budget):
                        if now - shown > SHOW_SECONDS:
                            self._tell(budget.line(now))
                            yield budget.share(view.samples, now)
                            shown = time.perf_counter()
                    if view.samples and (self.test_break() or budget.is_over(time.perf_counter())):
                        return
            if first and exposure.values.exchange == "heaps":
                better = budget.better_exchange(view.statistics()["exchange"])
                if better:
                    seen = exposure.values = dataclasses.replace(exposure.values, exchange=better)
                    self._result(view.start_scene(exposure.native_scene(seen)), view)
            first = False

    def _draw_some(self, view, samples, budget):
        """So many, unless the budget is spent before; yields now and then when it is."""
        chunk, reached = 1, view.samples + samples
        while view.samples < reached and not self.test_break():
            started = time.perf_counter()
            self._draw(view, min(chunk, reached - view.samples))
            now = time.perf_counter()
            budget.note(view.samples, now)
            yield now
            if budget.is_over(now):
                return
            if now - started < grace.POLL_SECONDS:
                chunk *= 2

    def _await_light(self, view, budget):
        """Of a view that would draw without knowing all of light in and between grains: for as long as is worth it."""
        if budget.patient:
            return
        patience = waiting.Waiting()
        while view.preparing is not None and budget.waits_for_light(time.perf_counter()) and not self.test_break():
            self._tell(patience.sentence(view.awaited, view.preparing or 0.0, time.perf_counter()))
            time.sleep(grace.POLL_SECONDS)
            self._result(view.start_news(), view)
        self._result(view.start_news(), view)

    def _tell(self, text):
        if self._telling.is_due():
            self.update_stats("", text)

    def _draw(self, view, samples):
        """Until they are drawn, or cancelled by the artist."""
        patience = waiting.Waiting()

        def tell():
            share = view.preparing
            if share is not None:
                self._tell(patience.sentence(view.awaited, share, time.perf_counter()))

        self._result(view.start(samples), view, tell)

    def _result(self, task, view, tell=lambda: None, given_up=None):
        """Of a task of the view. Other views may hold its thread for long: the artist's wish to cancel is seen
        meanwhile, or whatever else given_up() tells. Raises grace.GivenUp where it cannot be followed soon."""
        cancelled, given_up = None, given_up or self.test_break
        while not task.wait(grace.POLL_SECONDS):
            now = time.perf_counter()
            if cancelled is None and given_up():
                view.cancel()
                cancelled = now
            if cancelled is not None and now - cancelled > grace.GRACE_SECONDS:
                raise grace.GivenUp
            tell()
        return task.result()

    def _sign(self, metadata):
        """metadata: {field: text} that goes into the picture's file."""
        whole = self.get_result() if metadata else None  # begin_result's is a part that was handed in
        for field, text in metadata.items():
            whole.stamp_data_add_field(field, text)

    def _read(self, view):
        """As native.Reading.result gives it."""
        return self._result(view.start_read(), view)

    def _show(self, result, view, opaque):
        """Gives what it read."""
        picture = self._read(view)
        if opaque:
            picture["pixels"][..., 3] = 1.0  # premultiplied, so this is the picture over black
        _set_pass(result, "Combined", picture["pixels"])
        return picture

    def _show_passes(self, result, view, view_layer, exposure, read_camera):
        """Those that are asked for; what a cancelled render has no time to draw stays empty."""
        try:
            for name, pixels in passes.pixels(view, view_layer, exposure, read_camera, grace.Grace(self.test_break)):
                _set_pass(result, name, pixels)
        except grace.GivenUp:
            self.report({"WARNING"}, "Indices, Cryptomatte or Denoising Data are empty: it was cancelled before.")

    # Rendered viewports

    def view_update(self, _context, depsgraph):
        self._error = ""
        try:
            self._view_update(depsgraph)
        except _sentences() as error:
            self._complain(status.VIEWPORT, status.Status(error=str(error)))
        self.tag_redraw()

    def _view_update(self, depsgraph):
        material_preview.note_change()
        native_module.get()
        if self._session is None or self._session.stopped:
            self._session = viewport.Session()
            _sessions.add(self._session)
        if any(_replaces_geometry(update) for update in depsgraph.updates):
            self._session.cache.forget()
        before = self._session.values
        values = before and export.with_new_materials(before, depsgraph)
        if values is None:
            values = export.read_scene(depsgraph, self._session.cache)
            material_preview.note_grains(values)
        self._session.set_scene(values)
        self._warnings = values.warnings

    def view_draw(self, context, depsgraph):
        try:
            self._view_draw(context, depsgraph)
        except _sentences() as error:
            self._complain(status.VIEWPORT, status.Status(error=str(error)))
        if self._error:
            self._write_error(context)

    def _write_error(self, context):
        """Over the picture, where Blender's text line is hidden or too short."""
        hidden = viewport_text.is_hidden(context.space_data)
        if not hidden and len(self._error) <= viewport_text.columns(context):
            return
        self.update_stats("", "")
        viewport_text.draw(context, self._error, below=not hidden)

    def _view_draw(self, context, depsgraph):
        session, region, scene = self._session, context.region, depsgraph.scene
        if session is not None and session.has_scene:
            session.set_camera(_viewport_camera(context, depsgraph), region.width, region.height)
            pixels = session.advance(scene.mesograin.viewport_samples)
            if session.settling or session.seconds_behind > 0.0:
                material_preview.note_change()
            if pixels is None and self._texture is not None and scene.render.film_transparent != self._transparent:
                pixels = session.picture()  # at rest nothing new would come
            if pixels is not None:
                self._take(pixels, context, scene)
            elif session.seconds_behind > BEHIND_SECONDS:
                self.update_stats("", f"Drawing, {duration(session.seconds_behind)}")
            # The text line of a redraw is what was said before it: a coarse picture's comes with the sharp one.
            if (pixels is not None and not session.settling) or (session.busy and not session.waits):
                self.tag_redraw()
            elif session.waits and not bpy.app.timers.is_registered(_look):
                bpy.app.timers.register(_look, first_interval=LOOK_SECONDS)
        if self._texture is not None:
            self._draw_texture(scene, region)

    def _take(self, pixels, context, scene):
        self._transparent = scene.render.film_transparent
        if not self._transparent:
            pixels[..., 3] = 1.0
        self._texture = _texture(pixels)
        session = self._session
        self._error = ""
        warnings = (*self._warnings, *session.warnings)
        self.update_stats("", _line(session, scene.mesograin.viewport_samples, warnings,
                                    viewport_text.columns(context)))
        height, width, _ = pixels.shape
        if status.put(status.VIEWPORT, status.Status(session.samples, width, height, session.timings,
                                                     warnings, exchange=session.exchange)):
            status.redraw_panels()

    def _draw_texture(self, scene, region):
        import gpu
        from gpu_extras.presets import draw_texture_2d

        gpu.state.blend_set("ALPHA_PREMULT")
        self.bind_display_space_shader(scene)
        # A negative height turns our top row up, without a copy.
        draw_texture_2d(self._texture, (0, region.height), region.width, -region.height)
        self.unbind_display_space_shader()
        gpu.state.blend_set("NONE")

    def _complain(self, kind, complaint):
        """Puts one sentence where the artist is looking: the panel, the picture's own text line and the reports."""
        self.update_stats("", complaint.error)
        news = status.put(kind, complaint)
        if news or kind == status.RENDER:
            self.report({"ERROR"}, complaint.error)
        if kind == status.RENDER:
            self.error_set(complaint.error)
            return
        if complaint.error != self._error:  # the line above is part of the next redraw only
            self._error = complaint.error
            self.tag_redraw()
        if news:
            status.redraw_panels()


def _set_pass(result, name, pixels):
    # Blender's rows begin at the bottom.
    compat.set_pass_pixels(result.layers[0].passes[name], np.ascontiguousarray(pixels[::-1]))


def _line(session, target, warnings, columns):
    """The text over a viewport: how far it is, and what the artist has to know of it."""
    share = session.preparing
    parts = [] if share is None else [waiting.line(session.awaited, share)]
    parts.append(f"Sample {session.samples}/{target}")
    # Not of first samples: in a drag there is one for each step, and a thousand grains take time to be asked.
    if session.samples > 1:
        said = viewport_text.facts(session.values.models_drawn, session.timings,
                                   native_module.get().device_info()["renderer"])
        room = columns - len(" | ".join((*parts, said)))
        if room >= (viewport_text.LEAST if warnings else 0):
            parts.append(said)
    if warnings:
        parts.append(viewport_text.line(warnings, columns - len(" | ".join((*parts, "")))))
    return " | ".join(parts)


def _look():
    """Redraws the viewports once one that waits has something new; gives when to look again, if any still waits."""
    waiting = [session for session in _sessions if session.waits]
    try:
        news = [session for session in waiting if session.look()]
    except _sentences():  # which the redraw says
        news = waiting
    if news:
        _redraw_viewports()
    return LOOK_SECONDS if len(news) < len(waiting) else None


def _redraw_viewports():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D" and area.spaces.active.shading.type == "RENDERED":
                area.tag_redraw()


def _eyes(render):
    """The names of the views of a stereoscopic picture that are asked for; one empty name where it is not one."""
    if not render.use_multiview:
        return ("",)
    views = render.stereo_views if render.views_format == "STEREO_3D" else render.views
    return tuple(view.name for view in views if view.use)


def _replaces_geometry(update):
    # Blender flags geometry on a material or scene whose properties changed, too.
    return update.is_updated_geometry and not isinstance(update.id, (bpy.types.Material, bpy.types.Scene))


def _viewport_camera(context, depsgraph):
    view, space = context.region_data, context.space_data
    to_view = np.array(view.view_matrix, dtype=np.float64)
    shown = None
    if view.view_perspective == "CAMERA":
        camera = (space.camera if space.use_local_camera else None) or depsgraph.scene.camera
        if camera is not None:
            export.require_placed(camera, to_view)
        if camera is not None and camera.type == "CAMERA":
            shown = lens.of_camera(camera.evaluated_get(depsgraph), view.view_matrix.inverted_safe())
    return native_module.get().Camera(to_view, np.array(view.window_matrix, dtype=np.float64), shown)


def _texture(pixels):
    import gpu

    height, width, channels = pixels.shape
    buffer = gpu.types.Buffer("FLOAT", height * width * channels, pixels.ravel())
    return gpu.types.GPUTexture((width, height), format="RGBA32F", data=buffer)


def _sentences():
    """What may go wrong by a user's doing; each is one sentence. Anything else is a bug and may show its traceback."""
    try:
        return (native_module.Unavailable, native_module.get().Error)
    except native_module.Unavailable:
        return (native_module.Unavailable,)


@bpy.app.handlers.persistent
def _forget_meshes(*_arguments):
    # Undo and redo may put other data at the same address.
    for session in _sessions:
        session.cache.forget()


@bpy.app.handlers.persistent
def _stop_sessions(*_arguments):
    for session in list(_sessions):
        session.stop()
    _sessions.clear()
    status.clear()
    material_preview.forget()


@bpy.app.handlers.persistent
def _note_change(_scene, depsgraph):
    if depsgraph.id_type_updated("MATERIAL") or (depsgraph.id_type_updated("OBJECT") and material_preview.shows_own()):
        material_preview.note_change()


HANDLERS = (("depsgraph_update_post", _note_change), ("undo_post", _forget_meshes), ("redo_post", _forget_meshes),
            ("load_pre", _stop_sessions))


def register():
    bpy.utils.register_class(MesograinRenderEngine)
    for panel in compat.borrowed_panels():
        panel.COMPAT_ENGINES.add(MesograinRenderEngine.bl_idname)
    for event, handler in HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)


def unregister():
    for event, handler in HANDLERS:
        getattr(bpy.app.handlers, event).remove(handler)
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)
    _stop_sessions()
    for panel in compat.borrowed_panels():
        panel.COMPAT_ENGINES.discard(MesograinRenderEngine.bl_idname)
    bpy.utils.unregister_class(MesograinRenderEngine)
