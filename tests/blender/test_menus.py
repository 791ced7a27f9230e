# Object > Grain and the Render menu: what keys and Blender's menu search find of Mesograin, and that it works there.
import types

import bpy
import pytest
from mesograin.engine import status
from mesograin.scene import plain_materials
from mesograin.ui import copy_grain, grain_tools, menus
from mesograin.ui.bake_panel.session import session as baking
from mesograin.ui.compare_panel.session import session as comparing
from mesograin.ui.match_panel.session import session as matching

ELSEWHERE = {"show_bake", "show_picture", "show_match", "apply_preset", "add_preset", "add_asset_library",
             "clear_references", "nothing", "hand"}
"""Of pictures that show themselves when they are done, of the preset menu's own entries, and the preferences'."""

WHEN_THERE_IS_ONE = {"cancel_bake", "cancel_compare", "cancel_match", "open_report", "apply_match", "select_named"}
"""A task, a result, a complaint."""

TASKS = {"compare": comparing, "bake": baking, "match": matching}


class Layout:
    """Remembers the operators and menus that are drawn in it."""

    def __init__(self):
        self.operators, self.menus = [], []
        self.operator_context = "INVOKE_DEFAULT"

    def separator(self):
        pass

    def label(self, text):
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
                                                          *drawn(menus.MESOGRAIN_MT_help),
                                                          *appended(menus._draw_in_render).operators)}
    assert appended(menus._draw_in_object).menus == ["MESOGRAIN_MT_grain"]
    assert appended(menus._draw_in_help).menus == ["MESOGRAIN_MT_help"]
    assert found | ELSEWHERE | WHEN_THERE_IS_ONE >= set(dir(bpy.ops.mesograin))
    assert not found & (ELSEWHERE | WHEN_THERE_IS_ONE)


@pytest.mark.parametrize("task", TASKS)
def test_what_is_under_way_can_be_cancelled_in_the_menu_that_began_it(native, monkeypatch, task):
    bpy.context.scene.render.engine = "MESOGRAIN"
    began = appended(menus._draw_in_render).operators
    monkeypatch.setattr(type(TASKS[task]), "running", True)
    meanwhile = appended(menus._draw_in_render).operators
    assert set(meanwhile) - set(began) == {f"mesograin.cancel_{task}"}
    assert set(began) - set(meanwhile) == {f"mesograin.{task}"}


def test_the_menu_offers_what_a_comparison_and_a_match_found(native, monkeypatch, tmp_path):
    bpy.context.scene.render.engine = "MESOGRAIN"
    (tmp_path / "report.html").write_text("")
    for session in comparing, matching:
        monkeypatch.setattr(session, "results", {})
        monkeypatch.setattr(session, "task", types.SimpleNamespace(out=tmp_path, running=False))
    assert {"mesograin.open_report", "mesograin.apply_match"} <= set(appended(menus._draw_in_render).operators)


def test_what_is_left_out_is_selected_from_a_menu(native, monkeypatch):
    bpy.ops.mesh.primitive_cube_add()
    name = bpy.context.object.name
    monkeypatch.setattr(status, "complaints", lambda: [f"'{name}' is left out.", f"'{name}' has no faces."])
    assert drawn(menus.MESOGRAIN_MT_left_out) == ["mesograin.select_named"]
    monkeypatch.setattr(status, "complaints", list)
    assert drawn(menus.MESOGRAIN_MT_left_out) == []


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
