# A hundred thousand grains, scattered by geometry nodes, in a real Blender window: whatever an artist does answers.
import time

import bpy
import numpy as np
from mesograin.engine import engine, status
from mesograin.grains import objects, pile
from mesograin.scene import export

GRAINS = 100000
RADIUS = 0.012
PATIENT = 180.0  # s without any progress: on a machine that does other things
IDLE_DRAWS = 25  # at most, of a viewport that waits for light between grains: an artist's, and panels' that move


def open_scatter(window):
    """The viewport of a scene with GRAINS on a square of 5 x 5."""
    area = yield from window.open("heap", samples=2)
    scene = bpy.context.scene
    bpy.data.objects.remove(bpy.data.objects["Heap"])
    random = np.random.default_rng(1)
    middles = np.concatenate((random.uniform(-2.5, 2.5, (GRAINS, 2)), np.full((GRAINS, 1), RADIUS)), axis=1)
    placings = pile.Placings(middles, np.full(GRAINS, RADIUS), np.zeros((GRAINS, 3)),
                             random.integers(3, size=GRAINS), 0.0)
    shapes = [objects.add_grain("sand", segments=6, seed=seed) for seed in range(3)]
    for shape in shapes:
        shape.data.materials[0].mesograin.model = "lambert"
        shape.data.materials[0].mesograin.reflectance = (0.6, 0.5, 0.4)
    scatter = objects.add_pile(placings, shapes, "Scatter")
    scene.collection.objects.link(scatter)
    status.clear()
    yield from drawn(window)
    return area, scatter


def drawn(window):
    """Waits for a picture, and says how long that took; what is waited for needs no redraws."""
    started = moved = time.monotonic()
    seen, idle, view_draw = None, [], engine.MesograinRenderEngine._view_draw

    def counted(self, *arguments):
        waits = self._session is not None and self._session.waits
        view_draw(self, *arguments)
        if waits and self._session.waits:
            idle.append(1)

    def there():
        nonlocal seen, moved
        latest = status.get(status.VIEWPORT)
        live = [session for session in engine._sessions if not session.stopped and session.has_scene]
        so_far = latest and latest.samples, [(each.samples, each.preparing) for each in live]
        if so_far != seen:
            seen, moved = so_far, time.monotonic()
        assert time.monotonic() - moved < PATIENT, f"no progress for {PATIENT} s; {status.complaints()}"
        at_rest = not any(each.busy or each.preparing is not None for each in live)
        return latest is not None and latest.samples >= 2 and at_rest

    engine.MesograinRenderEngine._view_draw = counted
    try:
        yield from window.until(there, 5 * PATIENT)
    finally:
        engine.MesograinRenderEngine._view_draw = view_draw
    print(f"{window.check}: a picture after {time.monotonic() - started:.2f} s", flush=True)
    assert len(idle) <= IDLE_DRAWS, f"{len(idle)} redraws showed nothing new"


def check_a_heap_of_100000_answers_plays_and_renders(window):
    area, scatter = yield from open_scatter(window)
    first = yield from window.picture(area)
    assert (window.inner(first).std() > 0.02), "nothing of the heap is seen"
    reads, read_scene = [], export.read_scene

    def counted(*arguments, **options):
        reads.append(1)
        return read_scene(*arguments, **options)

    export.read_scene = counted
    try:
        sent = window.native.sent()
        status.clear()
        yield from window.drag(area, "MIDDLEMOUSE", (90, 50))
        yield from drawn(window)
        turned = yield from window.picture(area)
        assert np.abs(turned - first).mean() > 0.01, "orbiting changed nothing"
        assert window.native.sent() == sent, "orbiting sent scene data"
        reads.clear()

        status.clear()
        for slot in (each for each in bpy.data.materials if each.name.startswith("Sand")):
            slot.mesograin.reflectance = (0.2, 0.2, 0.6)
        yield from drawn(window)
        blue = yield from window.picture(area)
        assert (blue[..., 2] - blue[..., 0]).mean() > (turned[..., 2] - turned[..., 0]).mean() + 0.02
        assert window.native.sent()["meshes"] == sent["meshes"] and not reads, "a slider read the heap"
    finally:
        export.read_scene = read_scene

    with window.override(area):
        bpy.ops.ed.undo_push(message="before")
        status.clear()
        # Near enough to fill much of the view.
        scatter.data.vertices[0].co = (0.0, 0.0, 0.5)
        scatter.data.attributes["size"].data[0].value = 0.4
        scatter.data.update()
        bpy.ops.ed.undo_push(message="one grain moved")
    yield from drawn(window)
    moved = yield from window.picture(area)
    assert np.abs(moved - blue).mean() > 0.001, "moving a grain changed nothing"
    assert window.native.sent()["meshes"] == sent["meshes"], "moving a grain sent a mesh"
    status.clear()
    with window.override(area):
        bpy.ops.ed.undo()
    yield from drawn(window)
    window.assert_same((yield from window.picture(area)), blue)
    yield from plays_and_renders(window, area)


def plays_and_renders(window, area):
    """What the viewport shows is at rest."""
    scatter, scene = bpy.data.objects["Scatter"], bpy.context.scene  # as undoing left them
    scatter.keyframe_insert("rotation_euler", frame=1)
    scatter.rotation_euler.z = 1.0
    scatter.keyframe_insert("rotation_euler", frame=40)
    scene.frame_set(1)
    before = yield from window.picture(area)
    with window.override(area):
        bpy.ops.screen.animation_play()
    yield from window.until(lambda: scene.frame_current >= 4, PATIENT)
    with window.override(area):
        bpy.ops.screen.animation_cancel(restore_frame=False)
    status.clear()
    scene.frame_set(40)
    yield from drawn(window)
    assert np.abs((yield from window.picture(area)) - before).mean() > 0.005, "playing changed nothing"

    scene.render.resolution_percentage, scene.mesograin.samples = 25, 1
    status.clear()
    yield from window.press_f12(area)
    yield from window.until(lambda: status.get(status.RENDER) is not None, PATIENT)
    assert status.get(status.RENDER).samples == 1
