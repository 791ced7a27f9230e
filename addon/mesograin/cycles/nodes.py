# Builds Cycles materials from recipes, every socket set explicitly, and tells what this Blender's nodes can do.
"""The only room that touches Cycles' shader nodes; differences between Blenders are found by looking at the nodes."""

import functools

import bpy

from .. import compat
from ..scene import export
from . import kinds, recipes
from .grain_values import GrainValues


def build_material(material, reference, millimetres_per_unit=1.0):
    """A new Cycles material that means, for this kind of reference, what `material.mesograin` means.

    material: bpy.types.Material with the add-on's properties. reference: a name in `kinds.KINDS`.
    Returns a new bpy.types.Material, which belongs to the caller.
    """
    values = GrainValues.from_parameters(dict(export.material_values(material, millimetres_per_unit).values))
    return build(f"{material.name} ({reference})", recipes.recipe(reference, values, features()))


def build(name, recipe):
    """A new material from a recipe. Raises RuntimeError if a node has a socket that the recipe leaves open."""
    material = bpy.data.materials.new(name)
    try:
        build_into(material, recipe)
    except BaseException:
        bpy.data.materials.remove(material)
        raise
    return material


def build_into(material, recipe):
    """Gives a material the nodes of a recipe in place of its own. Raises RuntimeError as `build`."""
    compat.use_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    nodes = {label: _build_node(tree, label, description) for label, description in recipe["nodes"].items()}
    for source, output, target, socket in recipe["links"]:
        tree.links.new(nodes[source].outputs[output], nodes[target].inputs[socket])
    for column, (label, node) in enumerate(nodes.items()):
        _check_sockets(node, recipe["nodes"][label])
        node.location = (300.0 * column - 300.0 * len(nodes), 0.0)
    for name, value in recipe["material"].items():
        if hasattr(material.cycles, name):  # Blender 5 finds out by itself which volumes are homogeneous
            setattr(material.cycles, name, value)


def _build_node(tree, label, description):
    node = tree.nodes.new(description["type"])
    node.name = node.label = label
    for name, value in description["properties"].items():
        setattr(node, name, value)
    for name, value in description["inputs"].items():
        _set(node.inputs[name], value)
    for name, value in description["optional"].items():
        if name in node.inputs:
            _set(node.inputs[name], value)
    return node


def _set(socket, value):
    """A colour socket has an alpha that no shader reads."""
    socket.default_value = (*value, 1.0) if socket.type == "RGBA" else value


def _check_sockets(node, description):
    """Sockets without a value of their own (normal, tangent, an absent shader) and disabled ones need none."""
    known = {**description["inputs"], **description["optional"]}
    for number, socket in enumerate(node.inputs):
        valueless = socket.hide_value or socket.type == "SHADER" or not socket.enabled
        if not (valueless or socket.is_linked or socket.name in known or number in known):
            raise RuntimeError(
                f"Blender {bpy.app.version_string} has a socket '{socket.name}' on {node.bl_idname} that Mesograin does"
                " not know: the reference would depend on its default."
            )


WALKS = ("RANDOM_WALK_FIXED_RADIUS", "RANDOM_WALK_LEGACY", "RANDOM_WALK")
"""Of the Subsurface Scattering node: names of the random walk whose mean free path is the radius / 4 pi, the surest
first. Where one of the first two is there, the last is another."""


@functools.lru_cache(maxsize=1)
def features():
    """What this Blender's nodes can do: kinds.NodeFeatures. Looks at nodes in a tree that it removes again."""
    tree = bpy.data.node_groups.new("Mesograin probe", "ShaderNodeTree")
    try:
        glossy_type, merged = _glossy_node(tree)
        subsurface = tree.nodes.new("ShaderNodeSubsurfaceScattering")
        methods = {item.identifier for item in subsurface.bl_rna.properties["falloff"].enum_items}
        glass = tree.nodes.new("ShaderNodeBsdfGlass").bl_rna.properties["distribution"].enum_items
        return kinds.NodeFeatures(
            glossy_type=glossy_type,
            # The two glossy nodes became one when Cycles' microfacet code went over to height-correlated masking.
            glossy_masking="correlated" if merged else "separable",
            # It has borne all three names; each that is there and comes first here is the one.
            subsurface_method=next(name for name in WALKS if name in methods),
            subsurface_refracts="Roughness" in subsurface.inputs,
            glass_distribution="SHARP" if "SHARP" in glass else "GGX",
            # That came with the same rewrite.
            facets_have_fresnel=merged,
            has_phase_choice=hasattr(tree.nodes.new("ShaderNodeVolumeScatter"), "phase"),
            even_suns=merged,  # came with Blender 4.0, too, and shows in no property
        )
    finally:
        bpy.data.node_groups.remove(tree)


def _glossy_node(tree):
    """(type, whether the anisotropic and the plain glossy node are one)."""
    anisotropic = tree.nodes.new("ShaderNodeBsdfAnisotropic")
    if anisotropic.bl_label == "Glossy BSDF":
        return "ShaderNodeBsdfAnisotropic", True
    return "ShaderNodeBsdfGlossy", False
