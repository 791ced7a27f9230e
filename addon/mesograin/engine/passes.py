# The passes of a final render beside the picture: where rays through the pixels' middles meet what, facing where.
import typing

import numpy as np

NOWHERE = 1e10
"""Depth where nothing is seen, as Cycles has it."""


class Pass(typing.NamedTuple):
    """A pass as Blender knows it. asked_for: the view layer's property."""

    name: str
    asked_for: str
    channels: str
    kind: str


DEPTH = Pass("Depth", "use_pass_z", "Z", "VALUE")
POSITION = Pass("Position", "use_pass_position", "XYZ", "VECTOR")
NORMAL = Pass("Normal", "use_pass_normal", "XYZ", "VECTOR")
PASSES = (DEPTH, POSITION, NORMAL)


def of(view_layer):
    """Those that a view layer asks for."""
    return tuple(one for one in PASSES if getattr(view_layer, one.asked_for, False))


def tell_compositor(engine, scene, view_layer):
    """Has the compositor's Render Layers node show them."""
    for one in of(view_layer):
        engine.register_pass(scene, view_layer, one.name, len(one.channels), one.channels, one.kind)


def add(engine, view_layer):
    """Makes room for them in the picture that is begun next."""
    for one in of(view_layer):
        engine.add_pass(one.name, len(one.channels), one.channels, layer=view_layer.name)


def pixels(view, view_layer, world_to_camera):
    """{name: (h, w, channels) float32 with row 0 at the top} of a native.View whose camera is known."""
    asked = of(view_layer)
    if not asked:
        return {}
    surfaces = view.read_surfaces()
    places, seen = surfaces["position"][..., :3], surfaces["position"][..., 3] > 0.0
    found = {POSITION.name: places, NORMAL.name: surfaces["normal"]}
    # Along the camera's axis, not along the ray.
    depth = -(places.astype(np.float64) @ world_to_camera[2, :3] + world_to_camera[2, 3])
    found[DEPTH.name] = np.where(seen, depth, NOWHERE).astype(np.float32)[..., None]
    return {one.name: found[one.name] for one in asked}
