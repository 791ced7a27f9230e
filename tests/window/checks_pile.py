# A large pile in a real Blender window: it settles beside Blender, and Escape ends it.
import bpy

GRAINS = 1500


def start_pile(window, area):
    with window.override(area):
        bpy.ops.mesograin.add_pile("INVOKE_DEFAULT", count=GRAINS, segments=4, place="HEAP")


def piles():
    return [each for each in bpy.data.objects if each.name.startswith("Pile")]


def check_a_pile_comes_by_itself(window):
    area = yield from window.open("sphere")
    start_pile(window, area)
    assert not piles(), "Blender was kept until the pile lay"
    yield from window.until(piles, 120.0)
    assert len(piles()[0].data.vertices) == GRAINS


def check_escape_ends_a_pile(window):
    area = yield from window.open("sphere")
    start_pile(window, area)
    yield from window.press(area, "ESC")
    yield from window.seconds(6.0)
    assert not piles()
