# All that differs between the Blenders we serve (3.4 to 4.3), asked for by feature and never by version.
import numpy as np


def calculate_corners(mesh):
    """Makes `mesh` compute its loop triangles and its corner normals, where this Blender wants to be asked."""
    if hasattr(mesh, "calc_normals_split"):
        mesh.calc_normals_split()
    if hasattr(mesh, "calc_loop_triangles"):
        mesh.calc_loop_triangles()


def corner_normals(mesh):
    """One normal for each corner of `mesh`, (loops, 3) float32; flat faces keep theirs."""
    normals = np.empty((len(mesh.loops), 3), dtype=np.float32)
    if hasattr(mesh, "corner_normals"):
        mesh.corner_normals.foreach_get("vector", normals.ravel())
    else:
        mesh.loops.foreach_get("normal", normals.ravel())
    return normals


def set_pass_pixels(render_pass, pixels):
    """Fills a render pass from (h, w, 4) float32 with row 0 at the bottom, in one copy; `rect = ...` takes seconds."""
    try:
        render_pass.rect.foreach_set(pixels.reshape(-1, pixels.shape[2]))
    except TypeError:  # 4.x counts numbers where 3.x counts pixels
        render_pass.rect.foreach_set(pixels.ravel())


def borrowed_panels():
    """Panels of Blender that serve any engine: those of the built-in one, but for what we draw ourselves, and the slot
    list and viewport settings of materials, which Blender ties to engines by name."""
    import bpy

    drawn_by_us = {"DATA_PT_light", "DATA_PT_area", "DATA_PT_spot", "DATA_PT_falloff_curve", "DATA_PT_preview"}
    tied_by_name = {"EEVEE_MATERIAL_PT_context_material"}
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None:
            continue
        if ("BLENDER_RENDER" in engines and panel.__name__ not in drawn_by_us) or panel.__name__ in tied_by_name:
            yield panel


def set_linear(image):
    """Marks an image's pixels as scene-linear with Rec. 709 primaries, whatever this Blender calls that."""
    for name in ("Linear Rec.709", "Linear"):
        try:
            image.colorspace_settings.name = name
            return
        except TypeError:  # no such item
            continue


def draw_progress(layout, owner, name, text):
    """A bar for the property `name` of `owner`, a percentage."""
    if hasattr(layout, "progress"):
        percent = getattr(owner, name)
        layout.progress(factor=percent / 100.0, text=f"{percent:.0f} %, {text}")
    else:
        layout.prop(owner, name, text=text, slider=True)
