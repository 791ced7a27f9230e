# Blender's depth of field as the native module's lens, with Cycles' meaning of every number.
from .. import native_module

NEAREST = 1e-5
"""Blender lets the focus lie on the lens itself, where no picture is."""


def of_camera(camera, to_world):
    """native.Lens of an evaluated camera object that stands at `to_world`, a mathutils.Matrix without scale; None where
    everything is sharp. An orthographic camera's opening has a radius of half a unit at f/1."""
    data, field = camera.data, getattr(camera.data, "dof", None)
    if field is None or not field.use_dof:
        return None
    diameter = 1.0 if data.type == "ORTHO" else 1e-3 * data.lens
    return native_module.get().Lens(
        0.5 * diameter / max(field.aperture_fstop, NEAREST), max(_focus_distance(field, to_world), NEAREST),
        field.aperture_blades, field.aperture_rotation, field.aperture_ratio)


def _focus_distance(field, to_world):
    """Along the camera's axis, to the object or bone in focus if there is one."""
    target = field.focus_object
    if target is None:
        return field.focus_distance
    place = target.matrix_world
    bone = target.pose.bones.get(field.focus_subtarget) if target.pose and field.focus_subtarget else None
    if bone is not None:
        place = place @ bone.matrix
    axis = to_world.to_3x3().col[2].normalized()
    return abs(axis.dot(to_world.translation - place.translation))
