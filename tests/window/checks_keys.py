# An artist with a hand at the keys alone: what is to be done by them begins, can be given up, and is done.
import bpy
from mesograin.engine import status
from mesograin.ui.compare_panel.session import session as comparing


def search(window, area, words):
    """Asks Blender's menu search (F3) for words and takes what it finds first."""
    yield from window.press(area, "F3")
    yield from window.seconds(0.5)
    yield from window.write(words)
    yield from window.seconds(0.5)
    yield from window.press(area, "RET")
    yield from window.seconds(0.5)


def check_a_grain_is_made_and_tweaked_by_keys(window):
    area = yield from window.open("sphere")
    before = set(bpy.data.objects)
    yield from search(window, area, "add grain salt")
    [cube] = set(bpy.data.objects) - before
    assert bpy.context.object == cube, "the new grain is not the active object"
    salt = cube.active_material.mesograin
    assert salt.model == "auto"
    yield from search(window, area, "choose model")
    assert salt.model != "auto", "Choose Model was not found"
    yield from window.press(area, "Z", ctrl=True)
    yield from window.seconds(0.5)
    assert bpy.context.object.active_material.mesograin.model == "auto", "Undo did not take it back"


def check_what_is_left_out_is_selected_by_keys(window):
    area = yield from window.open("sphere")
    flat = bpy.data.objects.new("Bare", bpy.data.objects["Sphere"].data)
    flat.scale = (0.0, 0.0, 0.0)
    bpy.context.scene.collection.objects.link(flat)
    yield from window.until(status.complaints)
    assert bpy.context.object != flat
    yield from search(window, area, "select 'bare")
    assert bpy.context.object == flat and flat.select_get()
    bpy.data.objects.remove(flat)


def check_a_comparison_begins_and_ends_by_keys(window):
    area = yield from window.open("sphere")
    bpy.context.scene.mesograin_compare.out = str(window.folder / "out")
    bpy.context.preferences.addons["mesograin"].preferences.cache_folder = str(window.folder / "cache")
    yield from search(window, area, "compare with cycles")
    assert comparing.running, comparing.error or "Compare with Cycles was not found"
    yield from search(window, area, "cancel comparison")
    yield from window.until(lambda: not comparing.running)


def check_diagnostics_are_copied_by_keys(window):
    area = yield from window.open("sphere")
    bpy.context.window_manager.clipboard = ""
    yield from search(window, area, "copy diagnostics")
    yield from window.until(lambda: "Self-test" in bpy.context.window_manager.clipboard)
