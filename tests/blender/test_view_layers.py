# What a view layer asks for: one material for all, no world, another world; and what of it is left out is said.
import bpy
import pytest
from test_export import add_cube, read_scene
from test_lights import add_light, assert_as_in_cycles, ground, make_world  # noqa: F401 (a fixture)

from mesograin import compat


@pytest.fixture
def layer(ground):  # noqa: F811
    return bpy.context.view_layer


def colour(material, reflectance):
    compat.use_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    diffuse, output = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (*reflectance, 1.0)
    tree.links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
    return material


def test_one_material_for_all(ground, layer, render):  # noqa: F811
    add_light("POINT", (0.4, -0.3, 3.0))
    add_cube()  # without any
    layer.material_override = colour(bpy.data.materials.new("Clay"), (0.7, 0.3, 0.1))
    assert {values.material.name for values in read_scene().instances} == {"Clay"}
    assert_as_in_cycles(ground, render)


def test_no_world(ground, layer, render):  # noqa: F811
    ground.camera.data.ortho_scale = 6.0
    make_world(ground, (0.1, 0.4, 0.2), 2.0)
    add_light("POINT", (0.4, -0.3, 3.0))
    layer.use_sky = False
    theirs = assert_as_in_cycles(ground, render)
    assert theirs[0, 0, :3].max() == 0.0


def test_another_world(ground, layer, render):  # noqa: F811
    if not hasattr(layer, "world_override"):
        pytest.skip("this Blender's view layers have the scene's world")
    make_world(ground, (0.5, 0.1, 0.7), 1.0)
    layer.world_override = ground.world
    make_world(ground, (0.1, 0.4, 0.2), 2.0)
    assert_as_in_cycles(ground, render)


@pytest.mark.parametrize("role, words", [("holdout", "holdouts"), ("indirect_only", "indirect only")])
def test_what_is_asked_of_a_collection_is_said(ground, layer, role, words):  # noqa: F811
    add_light("POINT", (0.4, -0.3, 3.0))
    made = bpy.data.collections.new("Props")
    ground.collection.children.link(made)
    assert read_scene().warnings == ()
    setattr(layer.layer_collection.children["Props"], role, True)
    [sentence] = read_scene().warnings
    assert f"View layer '{layer.name}'" in sentence and "'Props'" in sentence and words in sentence


@pytest.mark.parametrize("rays", ["diffuse", "glossy"])
def test_a_light_that_some_rays_do_not_see_is_said(ground, rays):  # noqa: F811
    light = add_light("POINT", (0.4, -0.3, 3.0))
    assert read_scene().warnings == ()
    setattr(light, f"visible_{rays}", False)
    [sentence] = read_scene().warnings
    assert "Light 'Point'" in sentence and f"{rays} rays" in sentence and "left out" in sentence


def test_lights_for_some_objects_are_said(ground):  # noqa: F811
    light = add_light("POINT", (0.4, -0.3, 3.0))
    if not hasattr(light, "light_linking"):
        pytest.skip("this Blender's lights are for all objects")
    light.light_linking.receiver_collection = bpy.data.collections.new("Lit")
    [sentence] = read_scene().warnings
    assert "Light 'Point'" in sentence and "linked" in sentence
