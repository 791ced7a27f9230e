# Copy Grain and Paste Grain: all that Mesograin keeps of a material goes with it, and nothing of what was there stays.
import types

import bpy
import pytest
from mesograin.scene import plain_materials
from mesograin.ui import copy_grain


@pytest.fixture(autouse=True)
def nothing_copied():
    copy_grain._kept.clear()


def worn(name):
    bpy.ops.mesh.primitive_uv_sphere_add()
    material = bpy.data.materials.new(name)
    bpy.context.object.data.materials.append(material)
    return material


def told(material):
    groups = [getattr(material, name) for name in copy_grain.GROUPS]
    return [{each: (group.is_property_set(each), copy_grain._plain(getattr(group, each)))
             for each in copy_grain._names(group)} for group in groups] + [material.mesograin_preview]


def sand():
    material = worn("Sand")
    grain, look, colours = material.mesograin, material.mesograin_look, material.mesograin_colours
    grain.model, grain.boundary, grain.profile = "model_3", "dielectric", "dipole"
    grain.sigma_s, grain.sigma_a, grain.scale = (7.1, 5.3, 2.9), (0.031, 0.17, 0.7), 1.3
    grain.g, grain.roughness, grain.eta = 0.4, 0.2, 1.54
    look.way, look.surroundings = "look", "water"
    colours.vary, colours.source, colours.colour_attribute = True, "ATTRIBUTE", "tint"
    material.mesograin_preview = "grain"
    return material


def test_a_grain_is_pasted_whole_over_another(native):
    expected = told(sand())
    assert bpy.ops.mesograin.copy_grain() == {"FINISHED"}
    material = worn("Salt")
    material.mesograin.model, material.mesograin.reflectance = "lambert", (0.1, 0.2, 0.3)
    material.mesograin_look.surroundings, material.mesograin_colours.colour_to = "oil", (2.0, 2.0, 2.0)
    assert bpy.ops.mesograin.paste_grain() == {"FINISHED"}
    assert told(material) == expected
    material.mesograin_look.surroundings = "air"  # what it lies in counts from there on as it did
    assert material.mesograin.eta == pytest.approx(1.54, rel=1e-6)


def test_it_outlives_its_material_and_its_file(native):
    expected = told(sand())
    bpy.ops.mesograin.copy_grain()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    material = worn("Salt")
    assert plain_materials.is_plain(material)
    bpy.ops.mesograin.paste_grain()
    assert told(material) == expected


def test_pasting_can_be_undone(native):
    assert "UNDO" in copy_grain.MESOGRAIN_OT_paste_grain.bl_options
    sand()
    bpy.ops.mesograin.copy_grain()
    worn("Salt")
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.mesograin.paste_grain()
    assert bpy.data.materials["Salt"].mesograin.model == "model_3"
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert plain_materials.is_plain(bpy.data.materials["Salt"])


def test_it_is_refused_where_there_is_nothing_to_copy_or_to_paste(native):
    material = worn("Wall")
    for operator in (bpy.ops.mesograin.copy_grain, bpy.ops.mesograin.paste_grain):
        assert not operator.poll()
    material.mesograin.model = "model_1"
    assert bpy.ops.mesograin.copy_grain.poll() and not bpy.ops.mesograin.paste_grain.poll()
    bpy.ops.mesograin.copy_grain()
    assert bpy.ops.mesograin.paste_grain.poll()


def test_a_linked_material_is_copied_and_not_pasted_on(native, tmp_path):
    sand()
    library = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(library, link=True) as (_, to):
        to.materials = ["Sand"]
    bpy.ops.mesh.primitive_uv_sphere_add()
    bpy.context.object.data.materials.append(to.materials[0])
    assert bpy.ops.mesograin.copy_grain() == {"FINISHED"}
    assert not bpy.ops.mesograin.paste_grain.poll()


@pytest.mark.parametrize("engine, shown", [("MESOGRAIN", ["mesograin.copy_grain", "mesograin.paste_grain"]),
                                           ("CYCLES", [])])
def test_both_stand_beside_blenders_own(engine, shown):
    assert copy_grain._draw in bpy.types.MATERIAL_MT_context_menu.draw._draw_funcs
    found = []
    layout = types.SimpleNamespace(separator=lambda: None, operator=lambda name, icon: found.append(name))
    copy_grain._draw(types.SimpleNamespace(layout=layout), types.SimpleNamespace(engine=engine))
    assert found == shown
