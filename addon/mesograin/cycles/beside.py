# What is no grain and stays what it is beside grains: a ground, a wall.
"""Both sides of a comparison draw it in its mean colour; pixels that show it do not count."""

from ..scene import meshes, plain_materials


def drawn_materials(depsgraph):
    """{full name: bpy.types.Material} of all that a reference draws; None stands for faces that have none."""
    found, known = {}, {}
    for instance in depsgraph.object_instances:
        # Blender 3.4 crashes at the slots of an object that can have none.
        if not (instance.show_self and meshes.is_drawn(instance.object, instance.matrix_world)):
            continue
        slots = instance.object.material_slots
        key = (instance.object.data.as_pointer(), len(slots))
        if key not in known:
            known[key] = meshes.used_slots(instance.object.data, len(slots))
        for slot in known[key]:
            material = slots[slot].material.original if slots and slots[slot].material else None
            found[material and material.name_full] = material
    return found


def stays(materials):
    """Full names of those of `materials`, as `drawn_materials` has them, that stay what they are: those for which
    nothing of Mesograin was ever chosen, if others are there. (Not under direct light alone: the kinds of reference
    that show nothing else say what everything is.)"""
    plain = {name for name, material in materials.items() if material and plain_materials.is_plain(material)}
    return frozenset() if len(plain) == len(materials) else frozenset(plain)


def recipe_name(kind, model):
    """Of what stays, drawn by a model of plain materials: the row of `recipes` in a kinds.Kind."""
    return _OF_NO_LIGHT.get(kind.recipe) or _OF_PLAIN[model]


_OF_PLAIN = {plain_materials.PLAIN: "diffuse", plain_materials.METAL: "glossy",
             plain_materials.GLASS: "volume_dielectric"}
_OF_NO_LIGHT = {"coverage": "holdout", "normal": "normal", "mirrored": "mirrored"}
