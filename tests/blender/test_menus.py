# Object > Grain and the Render menu: what keys and Blender's menu search find of Mesograin, and that it works there.
import types

import bpy
import pytest
from mesograin.scene import plain_materials
from mesograin.ui import copy_grain, grain_tools, menus

ELSEWHERE = {"cancel_bake", "cancel_compare", "cancel_match", "show_bake", "show_picture", "show_match", "open_report",
             "apply_match", "apply_preset", "add_preset", "match", "select_named", "self_test", "copy_diagnostics",
             "add_asset_library", "clear_references", "nothing", "hand"}
"""Of results, of what a panel chose first, of a menu's own entries, and the preferences'."""


class Layout:
    """Remembers the operators and menus that are drawn in it."""

    def __init__(self):
        self.operators, self.menus = [], []
        self.operator_context = "INVOKE_DEFAULT"

    def separator(self):
        pass

    def operator(self, name, **_options):
        self.operators.append(name)
        return types.SimpleNamespace()

    def operator_menu_enum(self, name, _property, **_options):
        self.operators.append(name)

    def menu(self, name, **_options):
        self.menus.append(name)


def drawn(menu):
    layout = Layout()
    menu.draw(types.SimpleNamespace(layout=layout), bpy.context)
    return layout.operators


def appended(draw):
    layout = Layout()
    draw(types.SimpleNamespace(layout=layout), bpy.context)
    return layout


def test_every_operator_is_in_a_menu_but_those_that_belong_elsewhere(native):
    bpy.context.scene.render.engine = "MESOGRAIN"
    found = {name.removeprefix("mesograin.") for name in (*drawn(menus.MESOGRAIN_MT_grain),
                                                          *drawn(grain_tools.MESOGRAIN_MT_add),
                                                          *appended(menus._draw_in_render).operators)}
    assert appended(menus._draw_in_object).menus == ["MESOGRAIN_MT_grain"]
    assert found | ELSEWHERE >= set(dir(bpy.ops.mesograin))
    assert not found & ELSEWHERE


def test_other_engines_menus_stay_as_they_are(native):
    bpy.context.scene.render.engine = "CYCLES"
    assert appended(menus._draw_in_object).menus == [] and appended(menus._draw_in_render).operators == []


@pytest.mark.parametrize("step", ["choose_model", "from_cycles", "to_cycles", "copy_grain", "paste_grain"])
def test_they_work_without_a_materials_tab(native, step):
    bpy.ops.mesh.primitive_uv_sphere_add()
    assert bpy.ops.mesograin.make_grain(preset="sugar") == {"FINISHED"}
    material = bpy.context.object.active_material
    assert not plain_materials.is_plain(material)
    copy_grain.copy(material)
    if step == "from_cycles":
        bpy.ops.mesograin.to_cycles()
    assert getattr(bpy.ops.mesograin, step).poll()
    assert getattr(bpy.ops.mesograin, step)() == {"FINISHED"}
