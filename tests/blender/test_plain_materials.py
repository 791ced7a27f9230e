# Materials of which nothing of Mesograin was ever chosen: what their nodes say, and what is left out by name.
import bmesh
import bpy
import numpy as np
import pytest
from test_export import add_camera, add_cube, add_sun, read_scene

from mesograin import compat

COLOUR = (0.1, 0.4, 0.7)


@pytest.fixture
def material():
    made = bpy.data.materials.new("Paint")
    compat.use_nodes(made)
    made.node_tree.nodes.clear()
    add_cube().data.materials.append(made)
    add_sun((0.0, 0.0, 1.0), 3.0)
    return made


def shade(material, kind, **inputs):
    """A node of this kind as the material's surface."""
    tree = material.node_tree
    output = tree.get_output_node("CYCLES") or tree.nodes.new("ShaderNodeOutputMaterial")
    node = tree.nodes.new(kind)
    for name, value in inputs.items():
        node.inputs[name.replace("_", " ")].default_value = value
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return node


def drawn():
    """({parameter: value}, sentences) of the one cube."""
    values = read_scene()
    return dict(values.instances[0].material.values), values.warnings


def test_diffuse_is_lambert(material):
    shade(material, "ShaderNodeBsdfDiffuse", Color=(*COLOUR, 1.0))
    values, sentences = drawn()
    assert values["model"] == "lambert" and values["reflectance"] == pytest.approx(COLOUR)
    assert sentences == ()


def test_glossy_is_a_conductor_of_the_same_facets(material):
    node = shade(material, "ShaderNodeBsdfGlossy" if hasattr(bpy.types, "ShaderNodeBsdfGlossy") else
                 "ShaderNodeBsdfAnisotropic", Color=(*COLOUR, 1.0), Roughness=0.5)
    values, _ = drawn()
    assert node.type in ("BSDF_GLOSSY", "BSDF_ANISOTROPIC")
    assert values["model"] == "conductor" and values["roughness"] == pytest.approx(0.25)


@pytest.mark.parametrize("metallic, model", [(0.0, "lambert"), (1.0, "conductor")])
def test_principled_is_what_it_mostly_is(material, metallic, model):
    shade(material, "ShaderNodeBsdfPrincipled", Base_Color=(*COLOUR, 1.0), Metallic=metallic, Roughness=0.3)
    values, sentences = drawn()
    assert values["model"] == model and values["reflectance"] == pytest.approx(COLOUR)
    assert sentences == ()


def test_what_varies_is_said_and_the_viewport_colour_stands_for_it(material):
    material.diffuse_color = (*COLOUR, 1.0)
    node = shade(material, "ShaderNodeBsdfDiffuse")
    texture = material.node_tree.nodes.new("ShaderNodeTexChecker")
    material.node_tree.links.new(texture.outputs["Color"], node.inputs["Color"])
    values, [sentence] = drawn()
    assert values["reflectance"] == pytest.approx(COLOUR)
    assert "Material 'Paint'" in sentence and "texture of its color" in sentence and "flat" in sentence


def test_emission_is_seen(material, render):
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.render.resolution_percentage = 100
    add_camera((0.0, 0.0, 4.0))
    shade(material, "ShaderNodeEmission", Color=(*COLOUR, 1.0), Strength=2.5)
    assert render()[4, 4, :3] == pytest.approx([2.5 * channel for channel in COLOUR], rel=1e-5)
    assert drawn()[1] == ()


@pytest.mark.parametrize("kind", ["ShaderNodeBsdfToon", "ShaderNodeMixShader"])
def test_none_is_black(material, kind):
    material.diffuse_color = (*COLOUR, 1.0)
    shade(material, kind)
    values, [sentence] = drawn()
    assert min(values["reflectance"]) > 0.0 and "Material 'Paint'" in sentence


@pytest.mark.parametrize("kind, mirrors", [("ShaderNodeBsdfGlass", True), ("ShaderNodeBsdfRefraction", False)])
def test_glass_is_a_clear_grain(material, kind, mirrors):
    shade(material, kind, Color=(1.0, 1.0, 1.0, 1.0), IOR=1.4, Roughness=0.3)
    values, sentences = drawn()
    assert sentences == ()
    assert values["sigma_s"] == values["sigma_a"] == (0.0, 0.0, 0.0) and values["boundary"] == "dielectric"
    assert values["eta"] == pytest.approx(1.4) and values["roughness"] == pytest.approx(0.09)
    assert values["specular"] is mirrors


def transmission(node):
    return node.inputs["Transmission Weight" if "Transmission Weight" in node.inputs else "Transmission"]


@pytest.mark.parametrize("weight, metallic, what", [(1.0, 0.0, ()), (0.8, 0.0, ("what of it is no glass",)),
                                                    (0.3, 0.0, None), (1.0, 1.0, None)])
def test_a_transmissive_principled_is_glass(material, weight, metallic, what):
    node = shade(material, "ShaderNodeBsdfPrincipled", Base_Color=(1.0, 1.0, 1.0, 1.0), IOR=1.3, Roughness=0.5,
                 Metallic=metallic)
    transmission(node).default_value = weight
    values, sentences = drawn()
    if what is None:
        assert values["model"] != "auto" and "its transmission" in sentences[0]
        return
    assert values["model"] == "auto" and values["sigma_s"] == (0.0, 0.0, 0.0)
    assert (values["eta"], values["roughness"], values["specular"]) == pytest.approx((1.3, 0.25, True))
    assert sentences == tuple(f"Material 'Paint' is no grain and is drawn as clear glass; left out: {each}."
                              for each in what)


def test_what_transmissive_principled_is_drawn_without_is_said(material):
    node = shade(material, "ShaderNodeBsdfPrincipled", Base_Color=(*COLOUR, 1.0), Alpha=0.5)
    transmission(node).default_value = 1.0
    node.inputs["Emission Color" if "Emission Color" in node.inputs else "Emission"].default_value = (1, 1, 1, 1)
    node.inputs["Emission Strength"].default_value = 2.0
    said = "its emission, its transparency"
    if "Thin Wall" in node.inputs:
        node.inputs["Thin Wall"].default_value = True
        said = "its emission, that its wall is thin, its transparency"
    assert drawn()[1][0].endswith(f"left out: {said}.")


def test_what_glass_is_drawn_without_is_said(material):
    node = shade(material, "ShaderNodeBsdfGlass", Color=(1.0, 1.0, 1.0, 1.0))
    material.node_tree.links.new(material.node_tree.nodes.new("ShaderNodeBump").outputs[0], node.inputs["Normal"])
    assert drawn()[1] == ("Material 'Paint' is no grain and is drawn as clear glass; left out: what bends its normal.",)


def hollow_box(half, thick):
    """A closed box around room for others; its walls are as thick."""
    shell = bmesh.new()
    for size, inner in ((half, False), (half - thick, True)):
        made = bmesh.ops.create_cube(shell, size=2.0 * size)
        if inner:
            bmesh.ops.reverse_faces(shell, faces=list({face for corner in made["verts"] for face in corner.link_faces}))
    mesh = bpy.data.meshes.new("Jar")
    shell.to_mesh(mesh)
    shell.free()
    jar = bpy.data.objects.new("Jar", mesh)
    bpy.context.scene.collection.objects.link(jar)
    return jar


@pytest.fixture
def jar(material):
    """Of glass, under a world but no sun. Called with the world's radiance, pixels a side and samples."""
    glass = bpy.data.materials.new("Glass")
    compat.use_nodes(glass)
    glass.node_tree.nodes.clear()
    shade(glass, "ShaderNodeBsdfGlass", Color=(1.0, 1.0, 1.0, 1.0), IOR=1.5, Roughness=0.0)
    hollow_box(2.0, 0.05).data.materials.append(glass)
    bpy.data.lights["Sun"].energy = 0.0
    add_camera((0.0, 0.0, 8.0), lens=200.0)

    def stand(radiance, side, samples):
        scene = bpy.context.scene
        scene.world = bpy.data.worlds.new("Even")
        compat.use_nodes(scene.world)
        background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
        background.inputs["Color"].default_value = (radiance, radiance, radiance, 1.0)
        scene.render.resolution_x = scene.render.resolution_y = side
        scene.render.resolution_percentage, scene.mesograin.samples = 100, samples

    return stand


LEFT_BY_A_WALL = (1.0 - 0.04) / (1.0 + 0.04)
"""Of light straight through glass, after its two interfaces and all reflections between them: (1 - R) / (1 + R), R that
of each."""


@pytest.mark.parametrize("away, walls", [(0.0, 1), (-4.0, 2)])
@pytest.mark.parametrize("reflectance", [1.0, 0.3])
def test_what_stands_in_a_jar_or_behind_it_is_seen(material, jar, render, away, walls, reflectance):
    """In an even white world, which makes a cube as bright as it reflects. What is not left of that is what the world
    gives, and little else: half of what the cube inside sends meets it again."""
    shade(material, "ShaderNodeBsdfDiffuse", Color=(*3 * [reflectance], 1.0))
    bpy.data.objects["Cube"].location.z = away
    jar(1.0, 8, 64)
    left = LEFT_BY_A_WALL**walls
    assert render()[3:5, 3:5, :3].mean() == pytest.approx(left * reflectance + 1.0 - left, abs=0.015)


def shine(material, shape):
    """Puts what `shape` adds to a bmesh in place of the cube, shining, under nothing else."""
    shade(material, "ShaderNodeEmission", Color=(1.0, 1.0, 1.0, 1.0), Strength=0.5)
    made = bmesh.new()
    shape(made)
    made.to_mesh(bpy.data.objects["Cube"].data)
    made.free()
    bpy.data.objects["Cube"].data.materials.append(material)


def test_what_shines_in_a_jar_is_seen_with_edges(material, jar, render):
    """A ball, which is no light to others: it fills a disc of few samples, one pixel wide at its edge."""
    shine(material, lambda ball: bmesh.ops.create_uvsphere(ball, u_segments=96, v_segments=48, radius=0.5))
    jar(0.0, 48, 4)
    shown = render()[..., :3].mean(axis=2) / (0.5 * LEFT_BY_A_WALL)
    assert shown[20:28, 20:28].mean() == pytest.approx(1.0, abs=0.03)
    inside, outside = shown > 0.7, shown < 0.15
    radius = np.sqrt(inside.sum() / np.pi)
    assert (~inside & ~outside).sum() < 1.2 * 2.0 * np.pi * radius and inside.sum() > 300


def test_a_light_that_is_a_surface_is_seen_as_one_through_glass(material, jar, render):
    """A rectangle, and no disc of its area."""
    shine(material, lambda plane: bmesh.ops.create_grid(plane, x_segments=1, y_segments=1, size=0.5))
    bpy.data.objects["Cube"].scale = (1.6, 0.6, 1.0)
    jar(0.0, 48, 16)
    shown = render()[..., :3].mean(axis=2) / (0.5 * LEFT_BY_A_WALL)
    rows, columns = np.nonzero(shown > 0.7)
    assert shown[rows, columns].mean() == pytest.approx(1.0, abs=0.03)
    wide, high = np.ptp(columns) + 1, np.ptp(rows) + 1
    assert wide / high == pytest.approx(1.6 / 0.6, rel=0.12) and len(rows) > 0.95 * wide * high > 250


def test_a_chosen_model_makes_it_a_grain(material):
    shade(material, "ShaderNodeBsdfGlossy")
    material.mesograin.model = "lambert"
    values, sentences = drawn()
    assert values["model"] == "lambert" and values["reflectance"] == tuple(material.mesograin.reflectance)
    assert sentences == ()


def test_a_muted_shader_is_black(material):
    shade(material, "ShaderNodeBsdfDiffuse", Color=(*COLOUR, 1.0)).mute = True
    values, sentences = drawn()
    assert values["model"] == "lambert" and values["reflectance"] == (0.0, 0.0, 0.0) and sentences == ()


def test_a_muted_mix_shows_its_first(material):
    mix = shade(material, "ShaderNodeMixShader", Fac=0.9)
    tree = material.node_tree
    for number, colour in ((1, (*COLOUR, 1.0)), (2, (0.9, 0.1, 0.1, 1.0))):
        node = tree.nodes.new("ShaderNodeBsdfDiffuse")
        node.inputs["Color"].default_value = colour
        tree.links.new(node.outputs[0], mix.inputs[number])
    mix.mute = True
    values, sentences = drawn()
    assert values["reflectance"] == pytest.approx(COLOUR) and sentences == ()


def glossy(material, **inputs):
    return shade(material, "ShaderNodeBsdfGlossy" if hasattr(bpy.types, "ShaderNodeBsdfGlossy") else
                 "ShaderNodeBsdfAnisotropic", **inputs)


def choose(node, distribution):
    try:
        node.distribution = distribution
    except TypeError:
        pytest.skip(f"this Blender's Glossy has no {distribution}")


def test_sharp_glossy_has_no_roughness(material):
    choose(glossy(material, Roughness=0.5), "SHARP")
    values, sentences = drawn()
    assert values["model"] == "conductor" and values["roughness"] == 0.0 and sentences == ()


@pytest.mark.parametrize("distribution, name", [("BECKMANN", "Beckmann"), ("ASHIKHMIN_SHIRLEY", "Ashikhmin-Shirley")])
def test_other_facets_than_ggx_are_said(material, distribution, name):
    choose(glossy(material, Roughness=0.5), distribution)
    values, [sentence] = drawn()
    assert values["roughness"] == pytest.approx(0.25)
    assert "Material 'Paint'" in sentence and name in sentence and "GGX" in sentence


def make_mist(material):
    tree = material.node_tree
    volume, output = tree.nodes.new("ShaderNodeVolumeScatter"), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(volume.outputs[0], output.inputs["Volume"])


def test_a_volume_without_a_surface_hides_nothing(material):
    make_mist(material)
    values = read_scene()
    assert values.instances == ()
    assert any("Material 'Paint'" in sentence and "volume" in sentence and "left out" in sentence
               for sentence in values.warnings)


@pytest.mark.parametrize("kind, inputs", [("ShaderNodeBsdfTransparent", {}),
                                          ("ShaderNodeBsdfPrincipled", {"Alpha": 0.0})])
def test_what_is_transparent_hides_nothing(material, kind, inputs):
    shade(material, kind, **inputs)
    values = read_scene()
    assert values.instances == ()
    assert any("Material 'Paint' is transparent" in sentence for sentence in values.warnings)


def test_a_grain_that_is_a_volume_for_cycles_is_drawn(material):
    make_mist(material)
    material.mesograin.model = "model_3"
    values, sentences = drawn()
    assert values["model"] == "model_3" and sentences == ()


def test_a_volume_under_a_surface_is_said(material):
    shade(material, "ShaderNodeBsdfDiffuse")
    volume = material.node_tree.nodes.new("ShaderNodeVolumeScatter")
    material.node_tree.links.new(volume.outputs[0], material.node_tree.get_output_node("CYCLES").inputs["Volume"])
    values, [sentence] = drawn()
    assert values["model"] == "lambert" and "its volume" in sentence
