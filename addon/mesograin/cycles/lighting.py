# Lights and the world of a reference: copies of the scene's, told only what both sides can mean alike.
"""See `copy_light` and `fill_world`."""

import bpy
from mathutils import Matrix, Vector

from .. import compat
from ..scene import lights, surroundings

KIND_PROPERTIES = {
    "SUN": (),
    "POINT": ("shadow_soft_size", "use_soft_falloff"),
    "SPOT": ("shadow_soft_size", "use_soft_falloff", "spot_size", "spot_blend"),
    "AREA": ("shape", "size", "size_y", "spread"),
}
"""What is copied as it is, where this Blender has it."""

COMMON_PROPERTIES = ("energy", "color", "angle", "normalize")


def copy_light(source, least_sun):
    """A new light that shines as `source`, a bpy.types.Light, does on our side: what its nodes, exposure and
    temperature make of it is in its colour. least_sun: of a `stage.Stage`."""
    made = bpy.data.lights.new(f"Mesograin {source.type.lower()}", source.type)
    for name in KIND_PROPERTIES[source.type]:
        if hasattr(source, name):
            setattr(made, name, getattr(source, name))
    if hasattr(source, "normalize"):
        made.normalize = source.normalize
    made.cycles.max_bounces = 1024
    made.energy, made.color = lights.energy_and_colour(source)
    if source.type == "SUN":
        made.angle = max(source.angle, least_sun)
        made.energy *= lights.sun_irradiance(source.angle) / lights.sun_irradiance(made.angle)
    return made


def add_sun(values, least_sun):
    """A new light as a lights.SunValues, and its matrix."""
    made = bpy.data.lights.new("Mesograin sun", "SUN")
    made.cycles.max_bounces = 1024
    made.angle = max(values.angle, least_sun)
    made.energy = max(values.irradiance)
    made.color = [channel / made.energy for channel in values.irradiance]
    made.energy /= lights.sun_irradiance(made.angle)
    return made, Vector(values.direction_to_light).to_track_quat("Z", "Y").to_matrix().to_4x4()


def describe(light):
    """JSON-able description of a light that `copy_light` made."""
    found = {"light": light.type}
    for name in (*COMMON_PROPERTIES, *KIND_PROPERTIES[light.type]):
        value = getattr(light, name, None)
        found[name] = list(value) if name == "color" else value
    return found


def fill_world(made, values):
    """Makes the nodes of a new bpy.types.World say what `surroundings.WorldValues` do; returns the image that it needs
    and nobody else has, or None."""
    compat.use_nodes(made)
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputWorld")
    background = tree.nodes.new("ShaderNodeBackground")
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    if values.image is None:
        background.inputs["Color"].default_value[:3] = values.radiance
        return None
    background.inputs["Strength"].default_value = values.radiance[0]
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image, is_new = surroundings.image_of(values, "Mesograin world")
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    mapping = tree.nodes.new("ShaderNodeMapping")
    rotation = Matrix([values.rotation[row:row + 3] for row in (0, 3, 6)])
    mapping.inputs["Rotation"].default_value = rotation.to_euler("XYZ")
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    return texture.image if is_new else None


def describe_world(values):
    """JSON-able description of `surroundings.WorldValues`."""
    return {"radiance": list(values.radiance), "rotation": list(values.rotation), "image": values.image_digest}
