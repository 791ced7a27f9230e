# From Cycles' nodes to a grain and back: what is written is read again, what artists build is what Cycles walks in.
import bpy
import pytest
from cycles_scenes import make_sphere

from mesograin import compat
from mesograin.cycles import inversion, nodes, reading
from mesograin.scene import export
from mesograin.ui import conversion

SIGMA_A, SIGMA_S = (0.003, 0.034, 0.46), (2.29, 2.39, 1.97)


def grain(boundary, g=0.3, roughness=0.0):
    material = bpy.data.materials.new("Grain")
    material.mesograin.model, material.mesograin.boundary = "model_3", boundary
    material.mesograin.sigma_a, material.mesograin.sigma_s = SIGMA_A, SIGMA_S
    material.mesograin.g, material.mesograin.eta, material.mesograin.roughness = g, 1.45, roughness
    return material


@pytest.mark.parametrize("unit", [1.0, 10.0])
@pytest.mark.parametrize("boundary", ["dielectric", "index_matched", "lambert"])
def test_there_and_back(native, boundary, unit):
    if boundary == "lambert":
        boundary = "lambert_refracted" if nodes.features().subsurface_refracts else "lambert_lambert"
    material = grain(boundary, roughness=0.25 if boundary == "dielectric" else 0.0)
    conversion.to_cycles(material, unit)
    made = material.mesograin
    made.sigma_a = made.sigma_s = (1.0, 1.0, 1.0)
    made.g, made.boundary, made.roughness = 0.0, "dielectric", 0.5
    if boundary != "index_matched":
        made.eta = 1.0
    assert conversion.to_grain(material, unit) == []
    assert tuple(made.sigma_a) == pytest.approx(SIGMA_A, rel=2e-3)
    assert tuple(made.sigma_s) == pytest.approx(SIGMA_S, rel=2e-3)
    assert (made.g, made.eta) == pytest.approx((0.3, 1.45), rel=1e-4)
    assert made.boundary == boundary
    if boundary == "dielectric":
        assert made.roughness == pytest.approx(0.25, rel=1e-4)


def tree_of(name):
    material = bpy.data.materials.new(name)
    compat.use_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial")


def principled():
    material, tree, output = tree_of("Skin")
    node = tree.nodes.new("ShaderNodeBsdfPrincipled")
    tree.links.new(node.outputs["BSDF"], output.inputs["Surface"])
    return material, tree, node


def test_a_principled_material_becomes_what_cycles_walks_in(native):
    material, _, node = principled()
    weight = next(name for name in reading.WEIGHTS if name in node.inputs)
    colour = "Subsurface Color" if "Subsurface Color" in node.inputs else "Base Color"
    node.inputs[weight].default_value = 1.0
    node.inputs[colour].default_value = (0.8, 0.4, 0.2, 1.0)
    node.inputs["Subsurface Radius"].default_value = (1.0, 0.5, 0.25)
    if "Subsurface Scale" in node.inputs:
        node.inputs["Subsurface Scale"].default_value = 1.0
    node.inputs["Subsurface Anisotropy"].default_value = 0.0
    node.inputs["IOR"].default_value, node.inputs["Roughness"].default_value = 1.4, 0.5
    node.subsurface_method = nodes.WALKS[0] if nodes.WALKS[0] in reading._methods() else "RANDOM_WALK"
    assert conversion.to_grain(material, 1.0) == []
    made = material.mesograin
    sigma_t = [a + s for a, s in zip(made.sigma_a, made.sigma_s)]
    assert sigma_t == pytest.approx([inversion.FIXED_RADIUS_FACTOR / radius for radius in (1.0, 0.5, 0.25)], rel=1e-5)
    assert [s / t for s, t in zip(made.sigma_s, sigma_t)] == pytest.approx(
        [inversion.single_scattering_albedo(channel) for channel in (0.8, 0.4, 0.2)], rel=1e-5)
    assert (made.model, made.boundary) == ("auto", "dielectric")
    assert (made.eta, made.roughness) == pytest.approx((1.4, 0.25))


def test_what_is_lost_is_said(native):
    material, tree, node = principled()
    weight = next(name for name in reading.WEIGHTS if name in node.inputs)
    node.inputs[weight].default_value, node.inputs["Metallic"].default_value = 0.25, 0.5
    texture = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(texture.outputs["Color"], node.inputs["Base Color"])
    tree.links.new(texture.outputs["Fac"], node.inputs["Roughness"])
    lost = " ".join(conversion.to_grain(material, 1.0))
    assert "75%" in lost and "metal" in lost and "Roughness" in lost


def test_faces_that_keep_light_in_cycles_are_said(native):
    material = make_sphere([], segments=8, rings=4, model="model_2", boundary="index_matched")
    assert conversion.to_cycles(material, 1.0) == []
    bpy.data.objects["Sphere"].data.polygons[0].use_smooth = False
    (said,) = conversion.to_cycles(material, 1.0)
    assert "'Sphere'" in said and "flat faces" in said


def test_what_a_principled_material_does_beside_the_walk_is_lost_and_said(native):
    material, tree, node = principled()
    names = {socket.name for socket in node.inputs}
    for choices, value in ((reading.WEIGHTS, 1.0), (("Coat Weight", "Clearcoat"), 1.0),
                           (("Sheen Weight", "Sheen"), 0.5), (("Alpha",), 0.5), (reading.TRANSMISSION, 0.5),
                           (("Emission Strength",), 2.0),
                           (("Emission Color", "Emission"), (1.0, 0.5, 0.2, 1.0))):
        node.inputs[next(name for name in choices if name in names)].default_value = value
    tree.links.new(tree.nodes.new("ShaderNodeBump").outputs["Normal"], node.inputs["Normal"])
    output = tree.get_output_node("CYCLES")
    tree.links.new(tree.nodes.new("ShaderNodeDisplacement").outputs[0], output.inputs["Displacement"])
    lost = " ".join(conversion.to_grain(material, 1.0))
    for what in ("coat", "sheen", "transparency", "transmission", "emission", "bumps", "displacement"):
        assert what in lost, what


WAYS = {"SubsurfaceScattering": "falloff", "BsdfPrincipled": "subsurface_method"}


@pytest.mark.parametrize("kind, method", [
    (kind, item.identifier) for kind, name in WAYS.items()
    for item in getattr(bpy.types, f"ShaderNode{kind}").bl_rna.properties[name].enum_items])
def test_every_way_of_subsurface_scattering_is_read_past_a_reroute(native, kind, method):
    material, tree, output = tree_of("Skin")
    node, way = tree.nodes.new(f"ShaderNode{kind}"), tree.nodes.new("NodeReroute")
    tree.links.new(node.outputs[0], way.inputs[0])
    tree.links.new(way.outputs[0], output.inputs["Surface"])
    for name in reading.WEIGHTS if kind == "BsdfPrincipled" else ():
        if name in node.inputs:
            node.inputs[name].default_value = 1.0
    setattr(node, WAYS[kind], method)
    assert conversion.to_grain(material, 1.0) == []
    assert min(material.mesograin.sigma_s) > 0.0


def test_a_principled_volume_in_glass(native):
    material, tree, output = tree_of("Juice")
    glass, volume = tree.nodes.new("ShaderNodeBsdfGlass"), tree.nodes.new("ShaderNodeVolumePrincipled")
    tree.links.new(glass.outputs[0], output.inputs["Surface"])
    tree.links.new(volume.outputs[0], output.inputs["Volume"])
    glass.inputs["IOR"].default_value, glass.inputs["Roughness"].default_value = 1.33, 0.0
    glass.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    volume.inputs["Color"].default_value = (0.5, 0.25, 0.75, 1.0)
    volume.inputs["Absorption Color"].default_value = (0.25, 0.0, 1.0, 1.0)
    volume.inputs["Density"].default_value, volume.inputs["Anisotropy"].default_value = 4.0, -0.5
    volume.inputs["Emission Strength"].default_value = 0.0
    assert conversion.to_grain(material, 2.0) == []
    made = material.mesograin
    assert tuple(made.sigma_s) == pytest.approx((1.0, 0.5, 1.5))
    assert tuple(made.sigma_a) == pytest.approx((0.5, 1.5, 0.0))
    assert (made.g, made.eta, made.boundary) == (pytest.approx(-0.5), pytest.approx(1.33), "dielectric")


@pytest.mark.parametrize("boundary, had, has", [
    ("dielectric", "auto", "auto"), ("index_matched", "transport", "transport"), ("dielectric", "model_3", "model_3"),
    ("lambert_lambert", "auto", "auto"), ("lambert_lambert", "transport", "auto"),
    ("dielectric", "lambert", "auto")])
def test_there_and_back_the_model_stays_if_it_answers_what_the_nodes_say(native, boundary, had, has):
    material = grain(boundary)
    conversion.to_cycles(material, 1.0)
    material.mesograin.model = had
    conversion.to_grain(material, 1.0)
    assert material.mesograin.model == has
    export.material_values(material, 1.0).to_native(native)  # which says what it does not answer


def mixed(kind, *shaders, share=0.5):
    """(material, nodes): a mix or a sum of two shaders; the first has the rest of the share."""
    material, tree, output = tree_of("Skin")
    both, *made = [tree.nodes.new(f"ShaderNode{name}") for name in (f"{kind}Shader", *shaders)]
    for socket, node in zip(both.inputs[-2:], made):
        tree.links.new(node.outputs[0], socket)
    tree.links.new(both.outputs[0], output.inputs["Surface"])
    if kind == "Mix":
        both.inputs[0].default_value = share
    return material, made


@pytest.mark.parametrize("share, said", [(0.25, "75%"), (0.9, "10%"), (1.0, None)])
@pytest.mark.parametrize("beside", ["BsdfGlossy", "BsdfDiffuse"])
def test_the_subsurface_part_of_a_mix_is_read_and_what_is_beside_it_said(native, beside, share, said):
    material, (other, walk) = mixed("Mix", beside, "SubsurfaceScattering", share=share)
    walk.inputs["Radius"].default_value = (1.0, 0.5, 0.25)
    lost = conversion.to_grain(material, 1.0)
    alone, tree, output = tree_of("Alone")
    same = tree.nodes.new("ShaderNodeSubsurfaceScattering")
    same.inputs["Radius"].default_value = (1.0, 0.5, 0.25)
    tree.links.new(same.outputs[0], output.inputs["Surface"])
    assert conversion.to_grain(alone, 1.0) == []
    for name in ("sigma_a", "sigma_s"):
        assert tuple(getattr(material.mesograin, name)) == tuple(getattr(alone.mesograin, name))
    assert lost == ([f"the {said} of '{other.name}' beside it"] if said else [])


def test_of_a_sum_the_subsurface_part_is_read_and_the_other_said(native):
    material, (_, glossy) = mixed("Add", "SubsurfaceScattering", "BsdfGlossy")
    assert conversion.to_grain(material, 1.0) == [f"'{glossy.name}' beside it"]
    assert min(material.mesograin.sigma_s) > 0.0


def test_a_mix_that_follows_a_texture_says_that_too(native):
    material, (_, walk) = mixed("Mix", "BsdfGlossy", "SubsurfaceScattering")
    tree = material.node_tree
    [mix] = [node for node in tree.nodes if node.type == "MIX_SHADER"]
    tree.links.new(tree.nodes.new("ShaderNodeFresnel").outputs[0], mix.inputs[0])
    lost = " ".join(conversion.to_grain(material, 1.0))
    assert f"of '{mix.name}'" in lost and "beside it" in lost


def test_glass_that_is_mixed_lets_light_into_a_volume(native):
    material, (glass, other) = mixed("Mix", "BsdfGlass", "BsdfTransparent", share=0.1)
    glass.inputs["Roughness"].default_value, glass.inputs["IOR"].default_value = 0.0, 1.4
    tree = material.node_tree
    volume = tree.nodes.new("ShaderNodeVolumeScatter")
    tree.links.new(volume.outputs[0], tree.get_output_node("CYCLES").inputs["Volume"])
    assert f"the 10% of '{other.name}' beside it" in conversion.to_grain(material, 1.0)
    assert (material.mesograin.boundary, material.mesograin.eta) == ("dielectric", pytest.approx(1.4))


def test_mixed_volumes_are_as_thin_as_their_shares(native):
    material, (scatter, absorption) = mixed("Mix", "VolumeScatter", "VolumeAbsorption", share=0.25)
    scatter.inputs["Color"].default_value, scatter.inputs["Density"].default_value = (0.5, 1.0, 0.25, 1.0), 4.0
    absorption.inputs["Color"].default_value, absorption.inputs["Density"].default_value = (0.5, 1.0, 0.0, 1.0), 2.0
    tree = material.node_tree
    [mix] = [node for node in tree.nodes if node.type == "MIX_SHADER"]
    output = tree.get_output_node("CYCLES")
    tree.links.new(mix.outputs[0], output.inputs["Volume"])
    tree.links.remove(output.inputs["Surface"].links[0])
    assert conversion.to_grain(material, 1.0) == []
    assert tuple(material.mesograin.sigma_s) == pytest.approx((1.5, 3.0, 0.75))
    assert tuple(material.mesograin.sigma_a) == pytest.approx((0.25, 0.0, 0.5))


def test_a_node_that_says_coefficients_is_read_as_it_says(native):
    if not hasattr(bpy.types, "ShaderNodeVolumeCoefficients"):
        pytest.skip("this Blender has no such node")
    material, tree, output = tree_of("Milk")
    node = tree.nodes.new("ShaderNodeVolumeCoefficients")
    tree.links.new(node.outputs[0], output.inputs["Volume"])
    for name, value in (("Absorption", (0.1, 0.2, 0.3)), ("Scatter", (2.0, 3.0, 4.0)), ("Emission", (0.0, 0.0, 0.0))):
        node.inputs[f"{name} Coefficients"].default_value = value
    node.inputs["Anisotropy"].default_value = 0.6
    assert conversion.to_grain(material, 10.0) == []
    made = material.mesograin
    assert tuple(made.sigma_a) == pytest.approx((0.01, 0.02, 0.03))
    assert tuple(made.sigma_s) == pytest.approx((0.2, 0.3, 0.4))
    assert (made.g, made.boundary) == (pytest.approx(0.6), "index_matched")
    node.inputs["Emission Coefficients"].default_value = (0.0, 1.0, 0.0)
    assert conversion.to_grain(material, 10.0) == [f"the emission of '{node.name}'"]


@pytest.mark.parametrize("kind, words", [("ShaderNodeBsdfDiffuse", "lets no light through"),
                                         ("ShaderNodeBsdfGlass", "needs a volume")])
def test_what_is_no_grain_says_so_and_stays(native, kind, words):
    material, tree, output = tree_of("Wall")
    tree.links.new(tree.nodes.new(kind).outputs[0], output.inputs["Surface"])
    before = tuple(material.mesograin.sigma_s)
    with pytest.raises(reading.NoGrain, match=words):
        conversion.to_grain(material, 1.0)
    assert tuple(material.mesograin.sigma_s) == before


def test_rough_glass_keeps_what_meets_a_second_facet(native):
    material = grain("dielectric", roughness=0.25)
    conversion.to_cycles(material, 1.0)
    [glass] = [node for node in material.node_tree.nodes if node.type == "BSDF_GLASS"]
    assert glass.distribution == "MULTI_GGX"


def test_operators_convert_the_active_material(native):
    bpy.ops.mesh.primitive_uv_sphere_add()
    material = grain("index_matched")
    bpy.context.object.data.materials.append(material)
    assert bpy.ops.mesograin.to_cycles() == {"FINISHED"}
    material.mesograin.sigma_s = (9.0, 9.0, 9.0)
    assert bpy.ops.mesograin.from_cycles() == {"FINISHED"}
    assert tuple(material.mesograin.sigma_s) == pytest.approx(SIGMA_S, rel=1e-4)
    compat.use_nodes(material)
    material.node_tree.nodes.clear()
    with pytest.raises(RuntimeError, match="lets no light through"):
        bpy.ops.mesograin.from_cycles()
