# What a viewport's session draws while changes come as fast as in a drag, without a window.
import random
import threading
import time
import weakref

import bpy
import held_device
import numpy as np
import pytest
from mesograin.engine import viewport
from mesograin.scene import export, meshes

SIZE = (64, 48)
CHANGES = 12


class Slow:
    """A native.Rendering that takes at least so long."""

    def __init__(self, task, seconds):
        self._task, self._seconds, self._end = task, seconds, time.monotonic() + seconds

    @property
    def done(self):
        return self.wait(0.0)

    def wait(self, seconds=None):
        left = max(self._end - time.monotonic(), 0.0)
        time.sleep(left if seconds is None else min(left, seconds))
        return time.monotonic() >= self._end and self._task.wait(seconds)

    def result(self):
        self._task.result()
        return self._seconds

    def picture(self):
        return self._task.picture()


class Withheld:
    """A native.View of which what becomes known is told only once it may be: machines differ in how soon it is."""

    def __init__(self, view):
        self._view, self.told = view, False

    def __getattr__(self, name):
        return getattr(self._view, name)

    @property
    def preparing(self):
        return self._view.preparing if self.told else 0.5

    def start_news(self):
        return self._view.start_news() if self.told else Withheld.None_()

    class None_:
        """News that are none."""

        def wait(self, seconds=None):
            return True

        def result(self):
            return False


class Known:
    """A native.View of which something becomes known whenever it is asked, and how often that was."""

    class News:
        def wait(self, seconds=None):
            return True

        def result(self):
            return True

    def __init__(self, view):
        self._view, self.asked = view, 0

    def __getattr__(self, name):
        return getattr(self._view, name)

    @property
    def preparing(self):
        return 0.5

    def start_news(self):
        self.asked += 1
        return Known.News()


class Taken:
    """A native.View that has taken a scene once `open` is set: as one of very many instances."""

    class Taking:
        def __init__(self, taking, is_open):
            self._taking, self._open = taking, is_open

        def wait(self, seconds=None):
            return self._open.wait(seconds) and self._taking.wait(seconds)

        def result(self):
            assert self._open.is_set()
            return self._taking.result()

    def __init__(self, view):
        self._view, self.open = view, threading.Event()

    def __getattr__(self, name):
        assert self.open.is_set() or name in ("width", "height", "cancel"), f"{name} waits for the scene"
        return getattr(self._view, name)

    def start_scene(self, scene):
        return Taken.Taking(self._view.start_scene(scene), self.open)


class Telling:
    """A native.View that has taken in what has become known once `open` is set: of very many instances."""

    def __init__(self, view):
        self._view, self.open, self._asked = view, threading.Event(), False

    def __getattr__(self, name):
        assert not self._asked or self.open.is_set() or name in ("width", "height", "cancel"), f"{name} waits for news"
        return getattr(self._view, name)

    def start_news(self):
        self._asked = True
        return Taken.Taking(self._view.start_news(), self.open)


class Late:
    """A native.View whose scenes, cameras and news are never taken by the redraw that asks for them."""

    class Taking:
        def __init__(self, taking):
            self._taking, self._asked = taking, False

        def wait(self, seconds=None):
            asked, self._asked = self._asked, True
            return asked and self._taking.wait()

        def result(self):
            return self._taking.result()

    def __init__(self, view):
        self._view = view

    def __getattr__(self, name):
        found = getattr(self._view, name)
        if name not in ("start_scene", "start_camera", "start_news"):
            return found
        return lambda *arguments: Late.Taking(found(*arguments))


@pytest.fixture
def busy_device(native):
    """A native.Rendering of another view whose one sample holds the device's thread for seconds, as a program does that
    is being compiled, until a test has asked all it wants of others. Nothing else may be asked of the device before."""
    if native.device_info()["hardware"]:
        pytest.skip("a GPU is through too soon")
    view = held_device.view(native, 64)
    return lambda: view.start(1)


@pytest.fixture
def drag(native, blend_files, monkeypatch):
    """drag(sample_seconds, redraw_seconds): a new reflectance for each redraw, which takes as long, or with None as
    long as the sample under way; gives what the session returned at each redraw, and the session."""
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    grain = bpy.data.materials["Translucent"].mesograin
    grain.model = "lambert"
    sessions, cache = [], meshes.MeshCache()

    def run(sample_seconds, redraw_seconds):
        session = viewport.Session()
        sessions.append(session)
        monkeypatch.setattr(viewport, "_start",
                            lambda view, samples: Slow(view.start(samples, read=True), sample_seconds))
        returned = []
        for change in range(CHANGES):
            grain.reflectance = (reflectance(change),) * 3
            depsgraph = bpy.context.evaluated_depsgraph_get()
            session.set_scene(export.read_scene(depsgraph, cache))
            session.set_camera(export.camera_from_scene(depsgraph, *SIZE), *SIZE)
            picture = session.advance(64)
            returned.append(None if picture is None else picture.copy())
            if redraw_seconds is None:
                while session._task is None:  # the scene is still being taken: the machine does other things
                    session._apply()
                session._task.wait()
            else:
                time.sleep(redraw_seconds)
        return returned, session

    yield run
    for session in sessions:
        session.stop()


def reflectance(change):
    return 0.2 + 0.05 * change


def brightness(picture):
    return float(picture[..., :3].mean())


def test_without_a_device_each_update_says_so_and_redraws_draw_nothing(native, blend_files, monkeypatch):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))

    def refuse(*_, **__):
        raise native.Error("there is no device")

    monkeypatch.setattr(native, "View", refuse)
    session, cache = viewport.Session(), meshes.MeshCache()
    for _ in range(2):
        depsgraph = bpy.context.evaluated_depsgraph_get()
        with pytest.raises(native.Error, match="no device"):
            session.set_scene(export.read_scene(depsgraph, cache))
        assert not session.has_scene and session.advance(64) is None
    session.stop()


def test_every_redraw_of_a_drag_shows_a_new_picture(drag):
    returned, _ = drag(sample_seconds=0.08, redraw_seconds=None)
    assert returned[0] is None, "a sample takes longer than a redraw waits"
    shown = [brightness(picture) for picture in returned[1:]]
    assert len(set(shown)) == CHANGES - 1
    # Each is the picture of the change before.
    expected = np.array([reflectance(change) for change in range(CHANGES - 1)])
    np.testing.assert_allclose(np.array(shown) / shown[0], expected / expected[0], rtol=0.02)


def test_a_drag_faster_than_the_samples_shows_one_for_each_sample(drag):
    returned, _ = drag(sample_seconds=0.2, redraw_seconds=0.05)
    shown = [picture for picture in returned if picture is not None]
    assert shown, "changes throw away every sample under way"


@pytest.mark.parametrize("dragged", ["camera", "scene", "both"])
def test_a_drag_whose_changes_are_taken_late_shows_pictures_before_its_end(drag, native, dragged):
    """As beside an F12 whose samples take longer than a redraw waits."""
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.0)
    session._view = Late(session._view)
    shown = 0
    for step in range(CHANGES):
        if dragged != "camera":
            bpy.data.materials["Translucent"].mesograin.reflectance = (reflectance(step),) * 3
            session.set_scene(export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache()))
        if dragged != "scene":
            eye = (0.0, 0.0, 9.0 + step)
            session.set_camera(native.Camera.look_at(eye, (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0), *SIZE)
        shown += session.advance(64) is not None
        if session._task is not None:
            session._task.wait()
    assert shown >= CHANGES // 4


def settled(session, target):
    """The pictures until none is to come."""
    pictures, deadline = [], time.monotonic() + 60.0
    while session.busy or session.samples < target:
        assert time.monotonic() < deadline
        picture = session.advance(target)
        pictures += [] if picture is None else [picture.copy()]
    return pictures


@pytest.mark.parametrize("dragged", ["camera", "scene"])
def test_a_drag_is_followed_by_coarse_pictures_and_sharp_at_its_end(drag, native, monkeypatch, dragged):
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.0)
    settled(session, 1)
    begun = []

    def start(view, samples):
        begun.append((view.width, view.height))
        return Slow(view.start(samples, read=True), view.width * view.height / (SIZE[0] * SIZE[1]))

    monkeypatch.setattr(viewport, "_start", start)  # a sharp one takes a second from now on, as of another material
    session.set_camera(native.Camera.look_at((0.0, 0.0, 8.9), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0), *SIZE)
    settled(session, 1)
    begun.clear()
    shown = []
    for step in range(CHANGES):
        if dragged == "scene":
            bpy.data.materials["Translucent"].mesograin.reflectance = (reflectance(step),) * 3
            session.set_scene(export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache()))
        else:
            eye = (0.0, 0.0, 9.0 + step)
            session.set_camera(native.Camera.look_at(eye, (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0), *SIZE)
        deadline = time.monotonic() + 60.0
        while (picture := session.advance(2)) is None:  # Blender redraws
            assert time.monotonic() < deadline
        shown.append(picture.copy())
        while not session.waits:  # the machine does other things, and what may become known is not asked for yet
            assert time.monotonic() < deadline and session.advance(2) is None
        assert session.busy and session.settling
    coarse = shown[0].shape[:2]
    assert begun == [coarse[::-1]] * CHANGES, "something else was drawn while changes came"
    assert coarse[1] <= SIZE[0] / 3  # where a sharp one takes a second
    assert len({brightness(picture) for picture in shown}) == CHANGES
    for _ in range(3):  # redraws for other reasons, at once
        assert not session.look()
    pictures = settled(session, 2)
    widths = [picture.shape[1] for picture in pictures]
    assert widths == sorted(widths) and widths[0] < SIZE[0] and widths.count(SIZE[0]) == 2
    right = native.View(*SIZE)
    right.set_scene(export.scene_from_depsgraph(bpy.context.evaluated_depsgraph_get())[0])
    right.set_camera(session._camera)
    right.render(2)
    np.testing.assert_allclose(pictures[-1], right.read(), atol=1e-5)


@pytest.mark.parametrize("sample_seconds, rests", [(0.03, True), (0.0, False)])
def test_samples_that_hold_up_a_redraw_follow_once_no_change_comes(drag, native, monkeypatch, sample_seconds, rests):
    _, session = drag(sample_seconds=sample_seconds, redraw_seconds=0.0)
    settled(session, 2)
    started = viewport._start
    begun = []

    def start(view, samples):
        begun.append((time.monotonic(), view.samples, view.width))
        return started(view, samples)

    monkeypatch.setattr(viewport, "_start", start)
    session.set_camera(native.Camera.look_at((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0), *SIZE)
    deadline = time.monotonic() + 60.0
    while session.advance(4) is None:
        assert time.monotonic() < deadline
    seen = time.monotonic()
    assert session.settling == rests
    settled(session, 4)
    times, samples, widths = zip(*begun)
    assert samples[:2] == (0, 1) and set(widths) == {SIZE[0]}
    assert not rests or times[1] - seen >= 0.9 * viewport.STILL_SECONDS


def test_after_a_drag_the_last_change_is_shown(drag):
    returned, session = drag(sample_seconds=0.08, redraw_seconds=0.0)
    deadline, last = time.monotonic() + 60.0, None
    while session.busy or session.samples < 8:
        assert time.monotonic() < deadline
        picture = session.advance(8)
        last = picture.copy() if picture is not None else last
    first = next(picture for picture in returned if picture is not None)
    assert session.samples == 8 and session.advance(8) is None
    assert brightness(last) / brightness(first) == pytest.approx(reflectance(CHANGES - 1) / reflectance(0), rel=0.02)


def test_a_change_gives_up_samples_that_would_only_refine(drag, native):
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.02)
    deadline = time.monotonic() + 60.0
    while session.samples < 4:
        assert time.monotonic() < deadline
        session.advance(1 << 16)
    assert session.busy
    width, height = SIZE
    session.set_camera(native.Camera.look_at((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0), width, height)
    assert session.samples == 0
    while session.advance(1) is None:
        assert time.monotonic() < deadline
    assert session.samples == 1


def turn(session, native, eye):
    session.set_camera(native.Camera.look_at((0.0, 0.0, eye), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0), *SIZE)


def first_picture(session, target):
    """When it was there."""
    deadline = time.monotonic() + 60.0
    while session.advance(target) is None:
        assert time.monotonic() < deadline
    return time.monotonic()


def test_a_redraw_waits_for_the_picture_of_its_change_that_is_expected_soon(drag, native):
    """Another redraw, which would show it, takes longer."""
    _, session = drag(sample_seconds=0.05, redraw_seconds=0.0)
    settled(session, 1)
    at_once = 0
    for step in range(CHANGES):
        turn(session, native, 9.0 + step)
        if session.advance(2) is None:  # the first of its size, or the machine does other things
            first_picture(session, 2)
        else:
            at_once += 1
    assert at_once >= CHANGES // 2


def test_what_becomes_known_after_a_first_picture_comes_once_no_change_does(drag, native):
    _, session = drag(sample_seconds=0.03, redraw_seconds=0.0)
    settled(session, 2)
    view = session._view = Known(session._view)
    for step in range(4):
        turn(session, native, 9.0 + step)
        seen = first_picture(session, 2)
        assert view.asked == step + 1, "news were taken in before the first picture alone"
    while view.asked == 4:
        assert time.monotonic() < seen + 60.0
        session.look()
    assert time.monotonic() - seen >= 0.9 * viewport.STILL_SECONDS


def test_a_change_gives_up_samples_of_what_became_known_of_a_picture_that_is_shown(drag, native, monkeypatch):
    _, session = drag(sample_seconds=0.03, redraw_seconds=0.0)
    settled(session, 2)
    view = session._view = Known(session._view)
    turn(session, native, 9.0)
    first_picture(session, 2)
    monkeypatch.setattr(viewport, "_start", lambda view, samples: Slow(view.start(samples, read=True), 0.2))
    deadline = time.monotonic() + 60.0
    while session._task is None:
        assert time.monotonic() < deadline
        session.look()
    assert view.asked == 2
    turn(session, native, 10.0)
    assert session._given_up or session._task is None, "the change waits for them"


def test_it_is_known_how_long_a_change_waits_for_its_picture(drag):
    _, session = drag(sample_seconds=0.3, redraw_seconds=0.0)
    time.sleep(0.2)
    assert 0.2 <= session.seconds_behind < 60.0
    deadline = time.monotonic() + 60.0
    while session.busy or session.samples < 2:
        assert time.monotonic() < deadline
        session.advance(2)
    assert session.seconds_behind == 0.0


def test_no_redraw_waits_for_a_scene_to_be_taken(drag, native):
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.0)
    while session.busy or session.samples < 2:
        session.advance(2)
    grain = bpy.data.materials["Translucent"].mesograin
    view = session._view = Taken(session._view)
    for step in range(3):  # a change that comes meanwhile is another
        grain.reflectance = (0.9 - 0.1 * step,) * 3
        session.set_scene(export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache()))
        session.set_camera(native.Camera.look_at((0.0, 0.0, 9.0 + step), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0), *SIZE)
        assert session.advance(2) is None and session.busy and not session.waits
        assert session.picture() is None and session.preparing == 0.0 and session.warnings == ()
    view.open.set()
    pictures = []
    while session.busy or session.samples < 2:
        picture = session.advance(2)
        pictures += [] if picture is None else [picture.copy()]
    right = native.View(*SIZE)
    right.set_scene(export.scene_from_depsgraph(bpy.context.evaluated_depsgraph_get())[0])
    right.set_camera(native.Camera.look_at((0.0, 0.0, 11.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0))
    right.render(2)
    np.testing.assert_allclose(pictures[-1], right.read(), atol=1e-5)


def test_no_redraw_waits_for_news_to_be_taken(drag, native):
    """A scene that comes meanwhile is taken after them."""
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.0)
    while session.busy or session.samples < 2:
        session.advance(2)
    view = session._view = Telling(session._view)
    session._preparing = True
    for _ in range(3):
        assert session.advance(2) is None and session.busy and not session.waits
    bpy.data.materials["Translucent"].mesograin.reflectance = (0.3,) * 3
    session.set_scene(export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache()))
    assert session.advance(2) is None and session.picture() is None
    view.open.set()
    while session.busy or session.samples < 2:
        session.advance(2)
    right = native.View(*SIZE)
    right.set_scene(export.scene_from_depsgraph(bpy.context.evaluated_depsgraph_get())[0])
    right.set_camera(export.camera_from_scene(bpy.context.evaluated_depsgraph_get(), *SIZE))
    right.render(2)
    np.testing.assert_allclose(session.picture(), right.read(), atol=1e-5)


def test_no_call_of_a_session_waits_for_a_device_that_is_busy(drag, native, busy_device):
    """Neither one of a session that draws already, as where F12 compiles a program beside a viewport, nor of a new one,
    nor the end of one."""
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.0)
    while session.busy or session.samples < 2:
        session.advance(2)
    begun, ended = viewport.Session(), viewport.Session()
    held = busy_device()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    values = export.read_scene(depsgraph, meshes.MeshCache())
    for step in range(3):
        camera = native.Camera.look_at((0.0, 0.0, 9.0 + step), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0)
        for each in (session, begun, ended):
            each.set_scene(values)
            each.set_camera(camera, 40 + step, 30)  # and a window that is resized
            assert each.advance(2) is None and each.busy and not each.waits
            assert each.picture() is None and each.warnings == () and each.awaited == () and each.seconds_behind > 0.0
    session.set_scene(export.read_scene(depsgraph, meshes.MeshCache()))
    gone = weakref.ref(ended)
    del ended, each
    assert gone() is None, "Blender lets go of an engine, and nothing else ends its session"
    assert not held.done, "something waited for the device"
    right = native.View(42, 30)
    right.set_scene(export.scene_from_depsgraph(depsgraph)[0])
    right.set_camera(camera)
    right.render(2)
    for each in (session, begun):
        while each.busy or each.samples < 2:
            each.advance(2)
        np.testing.assert_allclose(each.picture(), right.read(), atol=1e-5)
    begun.stop()


def test_samples_that_a_busy_device_goes_on_with_after_they_were_given_up_are_not_shown(drag, native, busy_device):
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.0)
    while session.busy or session.samples < 2:
        session.advance(2)
    shown = session.picture().copy()
    held = busy_device()
    assert session.advance(session.samples + 1) is None and session.busy  # another one, which waits for the device
    bpy.data.materials["Translucent"].mesograin.reflectance = (0.1,) * 3
    session.set_scene(export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache()))
    assert session.advance(2) is None and session.samples == 0 and not held.done
    pictures = []
    while session.busy or session.samples < 2:
        picture = session.advance(2)
        pictures += [] if picture is None else [picture.copy()]
    assert all(brightness(picture) < 0.5 * brightness(shown) for picture in pictures)


def test_an_error_of_what_was_shown_before_is_not_that_of_what_is_shown(drag, native, monkeypatch):
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.02)
    session.advance(64)

    class Failed(Slow):
        def result(self):
            super().result()
            raise native.Error("The device is gone: find it.")

    monkeypatch.setattr(viewport, "_start", lambda view, samples: Failed(view.start(samples, read=True), 0.0))
    camera = native.Camera.look_at((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0)
    session.set_camera(camera, *SIZE)
    with pytest.raises(native.Error, match="The device is gone"):
        for _ in range(3):
            session.advance(64)
    session.stop()


def test_a_view_that_cannot_become_sharp_says_so_and_is_asked_anew_by_the_next_redraw(drag, native):
    _, session = drag(sample_seconds=0.2, redraw_seconds=None)
    deadline = time.monotonic() + 60.0
    while not session.waits or session._divisor == 1:
        assert time.monotonic() < deadline
        session.advance(1)

    class Small:
        """A native.View without memory for more."""

        class Taking:
            def wait(self, seconds=None):
                return True

            def result(self):
                raise native.Error("Out of memory: close something.")

        def __init__(self, view):
            self._view = view

        def __getattr__(self, name):
            return getattr(self._view, name)

        def start_camera(self, *arguments):
            return Small.Taking()

    view, session._view = session._view, Small(session._view)
    with pytest.raises(native.Error, match="Out of memory"):
        while True:
            session.look()
    for _ in range(3):
        session.look()
    session._view = view
    session.set_camera(native.Camera.look_at((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0), *SIZE)
    assert settled(session, 1)[-1].shape[:2] == SIZE[::-1]


def test_no_thread_of_python_draws(drag):
    # One beside an operator that looks something up in an overridden context crashes Blender before Python 3.12.
    before = set(threading.enumerate())
    _, session = drag(sample_seconds=0.05, redraw_seconds=0.0)
    assert session.busy and set(threading.enumerate()) == before


def test_what_is_said_about_a_picture_is_asked_before_the_next_samples_begin(drag):
    # The view would answer once these are drawn, and Blender's window would wait for that.
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.01)
    view, session._view = session._view, None
    try:
        assert session.timings and all(milliseconds >= 0.0 for _, milliseconds in session.timings)
        assert session.exchange is None
    finally:
        session._view = view


def test_transport_is_waited_for_by_nobody_and_comes_into_the_picture(native, blend_files):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / "sphere.blend"))
    grain = bpy.data.materials["Translucent"].mesograin
    grain.model = "transport"
    grain.scale = 0.0613 * (1.0 + 1e-4 * random.random())  # of which no run before has left anything in the cache
    session, shown = viewport.Session(), []
    try:
        depsgraph = bpy.context.evaluated_depsgraph_get()
        started = time.monotonic()
        session.set_scene(export.read_scene(depsgraph, meshes.MeshCache()))
        assert time.monotonic() - started < 2.0, "computing it takes longer"
        session._view = Withheld(session._view)
        session.set_camera(export.camera_from_scene(depsgraph, *SIZE), *SIZE)
        while session.busy and time.monotonic() - started < 300.0:
            picture = session.advance(4)
            if picture is not None and picture.shape[:2] == SIZE[::-1]:  # those before are coarse
                shown.append(picture.copy())
                session._view.told = True
        assert not session.busy and session.samples == 4 and session.warnings == ()
        # The first is drawn without transport; what comes next fades in from it.
        steps = [np.abs(after - before).mean() for before, after in zip(shown, shown[1:])]
        assert len(shown) >= 3 and np.abs(shown[-1] - shown[0]).mean() > 0.0
        assert max(steps) < 0.1 * brightness(shown[-1])
        view = native.View(*SIZE)
        view.set_scene(export.scene_from_depsgraph(depsgraph)[0])
        view.set_camera(export.camera_from_scene(depsgraph, *SIZE))
        view.render(4)
        np.testing.assert_allclose(shown[-1], view.read(), atol=1e-5)
    finally:
        session.stop()


@pytest.mark.parametrize("seed", range(2))
def test_whatever_comes_when_the_last_change_is_shown(drag, native, monkeypatch, seed):
    """Samples of any duration, scenes and cameras taken soon or late, and regions of any size."""
    _, session = drag(sample_seconds=0.0, redraw_seconds=0.0)
    drawn, grain = random.Random(seed), bpy.data.materials["Translucent"].mesograin
    cameras = [native.Camera.look_at((0.0, 0.0, eye), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 45.0) for eye in (9.0, 11.0)]
    times, camera, size = (0.0, 0.01, 0.05, 0.4), cameras[0], SIZE

    def start(view, samples):
        return Slow(view.start(samples, read=True), drawn.choice(times))

    monkeypatch.setattr(viewport, "_start", start)
    session._view = Late(session._view)
    for step in range(150):
        what = drawn.randrange(6)
        if what == 0:
            grain.reflectance = (reflectance(step % CHANGES),) * 3
            session.set_scene(export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache()))
        elif what == 1:
            camera = drawn.choice(cameras)
        elif what == 2:
            size = drawn.choice((SIZE, (SIZE[0] // 2, SIZE[1]), (1, 1)))
        elif what == 3:
            session.look()
        elif what == 4:
            time.sleep(drawn.random() ** 3 * 2.0 * viewport.STILL_SECONDS)
        session.set_camera(camera, *size)
        picture = session.advance(4)
        assert picture is None or (np.isfinite(picture).all() and picture.ndim == 3)
    times = (0.0,)
    session.set_camera(cameras[0], *SIZE)
    last = settled(session, 4)[-1]
    right = native.View(*SIZE)
    right.set_scene(export.scene_from_depsgraph(bpy.context.evaluated_depsgraph_get())[0])
    right.set_camera(cameras[0])
    right.render(4)
    np.testing.assert_allclose(last, right.read(), atol=1e-5)
