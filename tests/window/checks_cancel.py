# F12 ended by the Escape key, as the X server delivers it: Blender looks for that key before it looks at any event, and
# takes none from the server where it is to simulate events.
import subprocess
import time

import bpy
import held_device
import numpy as np
from mesograin.engine import identities, motion, passes, status

DISTANCES = (6.0, 5.0, 4.0)

HELD_SIZE = 104
"""Pixels on each side of what holds the device, for some nine seconds of two cores."""


def hold_device(window):
    """A native.View and its native.Rendering, whose one sample holds the device's thread for many seconds."""
    view = held_device.view(window.native, HELD_SIZE)
    return view, view.start(1)


def press_escape():
    """Without a window manager nobody but us gives Blender's window the focus."""
    subprocess.run("xdotool search --onlyvisible --class Blender windowfocus --sync key Escape".split(), check=True,
                   timeout=20)


def start_endless_render(window, area):
    """F12 with more samples than could ever end; waits until it renders."""
    bpy.context.preferences.view.render_display_type = "NONE"
    bpy.context.scene.mesograin.samples = 1 << 20
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 64
    status.clear()
    assert (yield from window.press_f12(area)) == {"RUNNING_MODAL"}
    yield from window.until(lambda: bpy.app.is_job_running("RENDER"))
    yield from window.seconds(1.0)
    assert bpy.app.is_job_running("RENDER") and status.get(status.RENDER) is None


def check_escape_ends_a_render_at_once_and_keeps_what_it_has(window):
    area = yield from window.open("sphere")
    area.spaces.active.shading.type = "SOLID"
    for _ in range(2):  # and the next one can be rendered, and ended, too
        yield from start_endless_render(window, area)
        press_escape()
        yield from window.until(lambda: not bpy.app.is_job_running("RENDER"), timeout=5.0)
        ended = status.get(status.RENDER)
        assert ended is not None and ended.error == "" and 0 < ended.samples < 1 << 20, ended
        result = bpy.data.images["Render Result"]
        result.save_render(str(window.folder / "cancelled.png"))
        kept = bpy.data.images.load(str(window.folder / "cancelled.png"))
        assert tuple(kept.size) == (64, 64) and np.array(kept.pixels[:]).reshape(64, 64, 4)[..., :3].max() > 0.1
        bpy.data.images.remove(kept)
    area.spaces.active.shading.type = "RENDERED"
    status.clear()
    picture = yield from window.converged_picture(area)
    window.assert_same(picture, window.expected_picture(area))


def check_the_window_and_escape_answer_while_the_device_is_busy(window):
    """As where F12, or another viewport, compiles a program. A GPU is through with what is to keep it busy too soon."""
    area = yield from window.open("sphere")
    yield from window.converged_picture(area)
    if window.native.device_info()["hardware"]:
        return
    space = area.spaces.active
    bpy.context.preferences.view.render_display_type = "NONE"
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 64
    bpy.context.scene.mesograin.samples = 4
    status.clear()
    view, held = hold_device(window)
    for distance in DISTANCES:
        space.region_3d.view_distance = distance
        yield from window.seconds(0.1)
    bpy.data.materials["Translucent"].mesograin.reflectance = (0.3, 0.4, 0.5)
    yield from window.press_f12(area)
    yield from window.until(lambda: bpy.app.is_job_running("RENDER"))
    space.shading.type = "SOLID"  # ends a session, and begins one
    yield from window.seconds(0.2)
    space.shading.type = "RENDERED"
    yield from window.seconds(0.2)
    press_escape()
    yield from window.until(lambda: not bpy.app.is_job_running("RENDER"))
    assert not held.done, "something waited for the device"
    assert status.get(status.RENDER) == status.Status(), "the picture was drawn, or what ended it is an error"
    assert status.get(status.VIEWPORT) is None and window.session(area).seconds_behind > 0.0, "nothing was drawn yet"
    yield from window.until(lambda: held.done, timeout=600.0)
    del view
    picture = yield from window.converged_picture(area)
    window.assert_same(picture, window.expected_picture(area))
    status.clear()
    yield from window.press_f12(area)
    yield from window.until(lambda: status.get(status.RENDER) is not None and not bpy.app.is_job_running("RENDER"))
    assert status.get(status.RENDER).samples == 4 and status.complaints() == []


def end_render_where_the_device_gets_busy(window, owner, name, blurred=False, matted=False):
    """Escape, once owner.name, which a final render calls, was called and the device's thread has been held since."""
    area = yield from window.open("sphere")
    area.spaces.active.shading.type = "SOLID"
    bpy.context.scene.mesograin.samples = 4
    bpy.context.view_layer.use_pass_cryptomatte_object = matted
    if window.native.device_info()["hardware"]:
        return
    render = bpy.context.scene.render
    bpy.context.preferences.view.render_display_type = "NONE"
    render.resolution_x = render.resolution_y = 64
    render.use_motion_blur = blurred
    status.clear()
    view, held = held_device.view(window.native, HELD_SIZE), []
    called = getattr(owner, name)

    def hold_and_call(*arguments):
        if not held:
            held.append(view.start(1))
            time.sleep(0.3)  # the thread takes what is asked of it next before it begins a sample
        return called(*arguments)

    setattr(owner, name, hold_and_call)
    try:
        yield from window.press_f12(area)
        yield from window.until(lambda: held)
        yield from window.seconds(0.5)
        press_escape()
        yield from window.until(lambda: not bpy.app.is_job_running("RENDER"))
    finally:
        setattr(owner, name, called)
    assert not held[0].done, "the render waited for the device"
    ended = status.get(status.RENDER)
    if matted:
        assert ended.samples == 4 and ended.error == "", ended
    else:
        assert ended == status.Status(), "the picture was drawn, or what ended it is an error"
    yield from window.until(lambda: held[0].done, timeout=600.0)
    del view


def check_escape_ends_a_render_that_asks_a_busy_device_for_portions(window):
    yield from end_render_where_the_device_gets_busy(window, passes, "portions")


def check_escape_ends_a_render_that_gives_a_busy_device_a_moment(window):
    yield from end_render_where_the_device_gets_busy(window, motion, "moved", blurred=True)


def check_escape_ends_a_render_whose_cryptomatte_a_busy_device_is_to_draw(window):
    yield from end_render_where_the_device_gets_busy(window, identities, "things_of", matted=True)
