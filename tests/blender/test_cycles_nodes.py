# Cycles materials carry the parameters they should, on the Blender that runs this.
import bpy
import pytest

from mesograin.cycles import grain_values, kinds, nodes, recipes

GRAIN = grain_values.GrainValues(
    reflectance=(0.1, 0.2, 0.3), sigma_a=(0.1, 0.2, 0.3), sigma_s=(0.9, 0.5, 0.1), g=0.2, roughness=0.25
)


def value(material, node, socket):
    found = material.node_tree.nodes[node].inputs[socket].default_value
    return tuple(found)[:3] if hasattr(found, "__len__") else found


CYCLES_KINDS = [*(kind.name for kind in kinds.KINDS.values() if not kind.referee), "coverage", "normal", "mirrored"]


@pytest.mark.parametrize("kind", CYCLES_KINDS)
def test_every_kind_builds_and_leaves_no_socket_open(kind):
    groups, recipe = len(bpy.data.node_groups), recipes.recipe(kind, GRAIN, nodes.features())
    material = nodes.build("Grain", recipe)
    assert {node.name for node in material.node_tree.nodes} == set(recipe["nodes"])
    for name, description in recipe["nodes"].items():
        for socket, expected in description["inputs"].items():
            assert value(material, name, socket) == pytest.approx(expected, rel=1e-6)
        for name_, expected in description["properties"].items():
            assert getattr(material.node_tree.nodes[name], name_) == expected
    assert material.node_tree.nodes["Output"].inputs["Surface"].is_linked == (kind != "volume_index_matched")
    assert material.node_tree.nodes["Output"].inputs["Volume"].is_linked == kind.startswith("volume")
    assert len(bpy.data.node_groups) == groups


def test_material_of_the_panel_in_millimetres():
    material = bpy.data.materials.new("Sand")
    material.mesograin.sigma_s, material.mesograin.sigma_a = (0.9,) * 3, (0.1,) * 3
    material.mesograin.scale = 2.0
    made = nodes.build_material(material, "volume_index_matched", millimetres_per_unit=10.0)
    assert value(made, "Scatter", "Density") == pytest.approx(18.0)
    assert value(made, "Absorption", "Density") == pytest.approx(2.0)


def test_photons_have_no_material():
    with pytest.raises(ValueError, match="none for 'photon'"):
        nodes.build_material(bpy.data.materials.new("Sand"), "photon")


def test_a_socket_nobody_knows_is_refused():
    recipe = recipes.recipe("glossy", GRAIN, nodes.features())
    del recipe["nodes"]["Glossy"]["inputs"]["Roughness"]
    before = len(bpy.data.materials)
    with pytest.raises(RuntimeError, match="socket 'Roughness'"):
        nodes.build("Grain", recipe)
    assert len(bpy.data.materials) == before


def test_features_are_those_of_the_nodes():
    features = nodes.features()
    tree = bpy.data.node_groups.new("Probe", "ShaderNodeTree")
    walk = tree.nodes.new("ShaderNodeSubsurfaceScattering")
    assert features.subsurface_refracts == ("Roughness" in walk.inputs)
    walk.falloff = features.subsurface_method
    assert tree.nodes.new(features.glossy_type).bl_label == "Glossy BSDF"
