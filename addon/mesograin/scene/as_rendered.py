# What a render (F12) shows, for all that is compared or baked: Python may evaluate a scene for the viewport only.
"""See `depsgraph`."""

import contextlib

SAME_FOR_ALL = (
    ("objects", "hide_viewport", "hide_render"),
    ("objects", "show_instancer_for_viewport", "show_instancer_for_render"),
    ("collections", "hide_viewport", "hide_render"),
    ("curves", "resolution_u", "render_resolution_u"),
    ("curves", "resolution_v", "render_resolution_v"),
    ("metaballs", "resolution", "render_resolution"),
    ("particles", "child_nbr", "rendered_child_count"),
    ("particles", "child_percent", "rendered_child_count"),
)
"""(a collection of bpy.data, what the viewport goes by, what a render goes by); the resolution of a curve's render is 0
where it is the viewport's."""

OF_MODIFIERS = (
    ("show_viewport", "show_render"),
    ("levels", "render_levels"),
    ("viewport_resolution", "resolution"),
)
OF_SIMPLIFY = (
    ("simplify_subdivision", "simplify_subdivision_render"),
    ("simplify_child_particles", "simplify_child_particles_render"),
)
MODEL_FOR = ("VERTS", "FACES")
"""How an object repeats its children, so that a render does not show the children themselves."""


@contextlib.contextmanager
def depsgraph(context):
    """A context manager: inside, the evaluated dependency graph of a bpy.types.Context shows what a render shows, its
    visibility, modifiers and resolutions; afterwards the file is as it was."""
    data, layer = context.blend_data, context.view_layer
    before = []

    def change(owner, name, value):
        if getattr(owner, name) != value:
            before.append((owner, name, getattr(owner, name)))
            setattr(owner, name, value)

    def close_eye(thing, closed):
        if thing.hide_get(view_layer=layer) != closed:
            thing.hide_set(closed, view_layer=layer)

    layer.update()  # until then it lists objects that were removed, as None
    # The eye in the outliner, which is the viewport's alone; a render hides what stands model for its parent's corners.
    eyes = {thing: thing.hide_get(view_layer=layer) for thing in layer.objects}
    try:
        for owner, name, value in list(_differences(data, context.scene)):
            change(owner, name, value)
        for shown in _layer_collections(layer.layer_collection):
            change(shown, "hide_viewport", False)
        for thing in eyes:
            close_eye(thing, thing.parent is not None and thing.parent.instance_type in MODEL_FOR)
        layer.update()
        yield context.evaluated_depsgraph_get()
    finally:
        for owner, name, value in reversed(before):
            setattr(owner, name, value)
        for thing, closed in eyes.items():
            close_eye(thing, closed)
        layer.update()


def _differences(data, scene):
    """(owner, property, value) of everything that a render may take differently."""
    for blocks, viewport, render in SAME_FOR_ALL:
        for owner in getattr(data, blocks):
            if hasattr(owner, viewport) and hasattr(owner, render):
                value = getattr(owner, render)
                if value or "resolution" not in render:
                    yield owner, viewport, value
    for modifier in (each for owner in data.objects for each in owner.modifiers):
        for viewport, render in OF_MODIFIERS:
            if hasattr(modifier, viewport) and hasattr(modifier, render):
                yield modifier, viewport, getattr(modifier, render)
    for particles in data.particles:
        yield particles, "display_percentage", 100
        yield particles, "display_method", "RENDER"
    for viewport, render in OF_SIMPLIFY:
        yield scene.render, viewport, getattr(scene.render, render)


def _layer_collections(root):
    yield root
    for child in root.children:
        yield from _layer_collections(child)
