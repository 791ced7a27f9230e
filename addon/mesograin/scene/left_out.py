# What an object asks for that is not done for it, each as a sentence.

ROLES = {"is_holdout": "a holdout", "is_shadow_catcher": "a shadow catcher"}
RAYS = ("camera", "diffuse", "glossy", "transmission", "shadow")


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
