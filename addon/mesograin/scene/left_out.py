# What an object or a scene asks for that is not done for it, each as a sentence.

ROLES = {"is_holdout": "a holdout", "is_shadow_catcher": "a shadow catcher"}
RAYS = ("camera", "diffuse", "glossy", "transmission", "shadow")


def of_scene(scene):
    """Of a bpy.types.Scene."""
    exposure = getattr(getattr(scene, "cycles", None), "film_exposure", 1.0)
    if exposure == 1.0:
        return []
    return [f"Cycles' exposure of the film, {exposure:.3g}, is left out: the Exposure of Color Management is every "
            "engine's."]


def of_layer(layer):
    """Of a bpy.types.ViewLayer."""
    found = []
    if not layer.use_solid:
        found.append(f"View layer '{layer.name}' shows its surfaces, though it should not.")
    for role, name in (("holdout", "holdouts"), ("indirect_only", "indirect only")):
        collections = [each.name for each in _below(layer.layer_collection) if getattr(each, role)]
        if collections:
            found.append(f"View layer '{layer.name}' draws collection '{collections[0]}' as others are: that it is "
                         f"{name} is left out.")
    return found


def _below(collection):
    for each in collection.children:
        if not each.exclude:
            yield each
            yield from _below(each)


def of_light(thing):
    """Of a bpy.types.Object that is a light."""
    hidden = [rays for rays in ("diffuse", "glossy", "transmission") if not getattr(thing, f"visible_{rays}")]
    found = []
    if hidden:
        found.append(f"Light '{thing.name}' lights as others do: that it is hidden from {' and '.join(hidden)} rays is "
                     "left out.")
    linking = getattr(thing, "light_linking", None)
    if linking and (linking.receiver_collection or linking.blocker_collection):
        found.append(f"Light '{thing.name}' lights all objects: which it is linked to is left out.")
    return found


def sentences(thing):
    """Of a bpy.types.Object that is drawn."""
    found = [f"Object '{thing.name}' has the hair '{system.name}', which is left out: convert it to a mesh."
             for system in thing.particle_systems
             if system.settings.type == "HAIR" and system.settings.render_type == "PATH"]
    asked = [f"is {role}" for name, role in ROLES.items() if getattr(thing, name)]
    hidden = [rays for rays in RAYS if not getattr(thing, f"visible_{rays}")]
    if hidden:
        asked.append(f"is hidden from {' and '.join(hidden)} rays")
    if asked:
        found.append(f"Object '{thing.name}' is drawn as others are: that it {' and '.join(asked)} is left out.")
    return found
