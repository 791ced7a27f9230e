# What is no grain and stays what it is beside grains: a ground, a wall.
"""Both sides of a comparison draw it in its mean colour; pixels that show it do not count."""

from ..scene import meshes, plain_materials


def drawn_materials(depsgraph):
    """{full name: bpy.types.Material} of all that a reference draws; None stands for faces that have none."""
    found = {}
    for instance in depsgraph.object_instances:
        # Blender 3.4 crashes at the slots of an object that can have none.
        if not (instance.show_self and meshes.is_drawn(instance.object, instance.matrix_world)):
            continue
        slots = [slot.material.original if slot.material else None for slot in instance.object.material_slots] or [None]
        found.update((material and material.name_full, material) for material in slots)
    return found


def stays(kind, materials):
    """Full names of those of `materials`, as `drawn_materials` has them, that stay what they are in a kinds.Kind: those
    for which nothing of Mesograin was ever chosen, if others are there. Under direct light alone none does: the kinds
    that show nothing else say what everything is."""
    plain = {name for name, material in materials.items() if material and plain_materials.is_plain(material)}
    return frozenset() if kind.direct or len(plain) == len(materials) else frozenset(plain)


def recipe_name(kind, model):
    """Of what stays, drawn by a model of plain materials: the row of `recipes` in a kinds.Kind."""
    return _OF_NO_LIGHT.get(kind.recipe) or ("glossy" if model == plain_materials.METAL else "diffuse")


_OF_NO_LIGHT = {"coverage": "holdout", "normal": "normal", "mirrored": "mirrored"}
