# What the viewport's header says is missing, and the buttons that mend it; diagnostics for a report.
import types

import bpy
import pytest
from mesograin.engine import status
from mesograin.ui import named_things, notes, preferences


@pytest.fixture(autouse=True)
def quiet():
    status.clear()
    yield
    status.clear()


def dark_scene():
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_uv_sphere_add()
    scene = bpy.context.scene
    scene.render.engine = "MESOGRAIN"
    return scene, bpy.context.object


def test_a_dark_scene_is_lit_by_the_button(native, render):
    from test_export import add_camera

    scene, _ = dark_scene()
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.mesograin.samples = 4
    add_camera((0.0, 0.0, 4.0))
    assert not notes.is_lit(scene) and render()[..., :3].max() == 0.0
    assert bpy.ops.mesograin.add_sun() == {"FINISHED"}
    assert notes.is_lit(scene) and render()[..., :3].max() > 0.1


def test_what_is_no_grain_becomes_one(native):
    _, thing = dark_scene()
    assert notes.lacks_grain(thing) and thing.active_material is None
    assert bpy.ops.mesograin.make_grain(preset="salt") == {"FINISHED"}
    assert not notes.lacks_grain(thing) and thing.active_material.name == "Salt"
    assert thing.active_material.mesograin.eta == pytest.approx(1.544)
    thing.active_material = bpy.data.materials.new("Plain")
    assert notes.lacks_grain(thing)
    assert bpy.ops.mesograin.make_grain(preset="rice") == {"FINISHED"}
    assert not notes.lacks_grain(thing) and thing.active_material.name == "Plain"


class Asked:
    """A layout that remembers which buttons and sentences stand in it."""

    def __init__(self):
        self.operators, self.sentences = [], []
        self.name = ""  # of what a button selects

    def __getattr__(self, name):
        return lambda *_, **__: self

    def operator(self, name, *_, **__):
        self.operators.append(name)
        return self

    operator_menu_enum = operator

    def label(self, text="", **_):
        self.sentences.append(text)


def drawn(thing):
    panel = types.SimpleNamespace(layout=Asked(), bl_ui_units_x=notes.MESOGRAIN_PT_notes.bl_ui_units_x)
    preferences_ = types.SimpleNamespace(system=types.SimpleNamespace(ui_scale=1.0))
    context = types.SimpleNamespace(scene=bpy.context.scene, object=thing, region=None, preferences=preferences_,
                                    view_layer=bpy.context.view_layer)
    notes.MESOGRAIN_PT_notes.draw(panel, context)
    return panel.layout


def test_the_header_offers_what_is_missing_and_nothing_else(native):
    scene, thing = dark_scene()
    assert drawn(thing).operators == ["mesograin.add_sun", "mesograin.make_grain"]
    bpy.ops.mesograin.add_sun()
    bpy.ops.mesograin.make_grain(preset="sand")
    assert drawn(thing).operators == [] and drawn(thing).sentences == ["Nothing is left out."]
    status.put(status.VIEWPORT, status.Status(warnings=("Fog is left out.",)))
    assert drawn(thing).sentences == ["Fog is left out."]


def test_what_a_complaint_names_is_selected_by_a_button(native):
    scene, ball = dark_scene()
    bpy.ops.mesograin.add_sun()
    bpy.ops.mesograin.make_grain(preset="sand")
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    bpy.ops.mesograin.make_grain(preset="salt")
    for sentence, named in ((f"Object '{cube.name}' is scaled to nothing, so it is not drawn.", [cube]),
                            (f"Material '{ball.active_material.name}' is no number.", [ball]),
                            ("Light 'Sun' and object 'Gone' have something.", [bpy.data.objects["Sun"]])):
        assert named_things.find(sentence, bpy.context) == named, sentence
    status.put(status.VIEWPORT, status.Status(warnings=(f"Object '{ball.name}' has no faces.",)))
    layout = drawn(cube)
    assert layout.operators == ["mesograin.select_named"] and layout.name == ball.name
    assert bpy.ops.mesograin.select_named(name=ball.name) == {"FINISHED"}
    assert bpy.context.object == ball and bpy.context.selected_objects == [ball]


def test_diagnostics_name_what_a_maintainer_asks_for(native):
    dark_scene()
    status.put(status.VIEWPORT, status.Status(samples=4, width=8, height=8, warnings=("Fog is left out.",)))
    text = preferences.diagnostics()
    for word in (native.__version__, bpy.app.version_string, native.device_info()["renderer"], "Fog is left out.",
                 "Python", "Self-test"):
        assert word in text, word
