# All that differs between the Blenders we serve (3.4 to 5.2), asked for by feature and never by version.
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


def bend_corner_normals(mesh, normals):
    """Gives the corners of `mesh` these normals, as corner_normals() gives them, of their own."""
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = True
    mesh.normals_split_custom_set(normals.tolist())


def set_pass_pixels(render_pass, pixels):
    """Fills a render pass from (h, w, 4) float32 with row 0 at the bottom, in one copy; `rect = ...` takes seconds."""
    try:
        render_pass.rect.foreach_set(pixels.reshape(-1, pixels.shape[2]))
    except TypeError:  # 4.x counts numbers where 3.x counts pixels
        render_pass.rect.foreach_set(pixels.ravel())


def borrowed_panels():
    """Panels of Blender that serve any engine: those of the built-in one, but for what we draw ourselves, and the slot
    list, preview and viewport settings of materials and the lens of cameras, which Blender ties to engines by name."""
    import bpy

    drawn_by_us = {"DATA_PT_light", "DATA_PT_area", "DATA_PT_spot", "DATA_PT_falloff_curve", "DATA_PT_preview"}
    tied_by_name = {"EEVEE_MATERIAL_PT_context_material", "MATERIAL_PT_preview", "DATA_PT_camera_dof",
                    "DATA_PT_camera_dof_aperture"}
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None:
            continue
        # The Node Editor's copy of a panel is another class with the very same set of engines.
        name = panel.__name__.removeprefix("NODE_")
        if ("BLENDER_RENDER" in engines and name not in drawn_by_us) or panel.__name__ in tied_by_name:
            yield panel


def redraw_preview(material):
    """Has the preview in a material's tab rendered anew: its icon follows every tag, that one a property of Blender's
    own, whatever is said."""
    material.preview_render_type = material.preview_render_type


def ask_for_layers(image_settings):
    """Makes a render's file an EXR of one part that holds many layers."""
    if hasattr(image_settings, "media_type"):  # which has become a choice of its own
        image_settings.media_type = "MULTI_LAYER_IMAGE"
    image_settings.file_format = "OPEN_EXR_MULTILAYER"
    if hasattr(image_settings, "use_exr_interleave"):
        image_settings.use_exr_interleave = True


def relative_path_options():
    """`options` of a path property that may begin with //, where this Blender wants to be told."""
    import bpy

    known = "is_path_supports_blend_relative" in bpy.types.Property.bl_rna.properties
    return {"options": {"ANIMATABLE", "PATH_SUPPORTS_BLEND_RELATIVE"}} if known else {}


def set_linear(image):
    """Marks an image's pixels as scene-linear with Rec. 709 primaries, whatever this Blender calls that."""
    for name in ("Linear Rec.709", "Linear"):
        try:
            image.colorspace_settings.name = name
            return
        except TypeError:  # no such item
            continue


def add_group_socket(group, name, in_out, kind):
    """A socket of a node group; in_out: INPUT or OUTPUT. From Blender 4 on groups have an interface."""
    if hasattr(group, "interface"):
        return group.interface.new_socket(name, in_out=in_out, socket_type=kind)
    return (group.inputs if in_out == "INPUT" else group.outputs).new(kind, name)


def eevee():
    """The name of the engine that Blender calls EEVEE: from 4.2 to 4.5 it is another one."""
    import bpy

    names = bpy.types.RenderSettings.bl_rna.properties["engine"].enum_items.keys()
    return "BLENDER_EEVEE_NEXT" if "BLENDER_EEVEE_NEXT" in names else "BLENDER_EEVEE"


def has_choice_of_nodes(datablock):
    """Whether a material, light or world may be without nodes. From Blender 5 on all have them, and asking warns."""
    return not getattr(datablock.bl_rna.properties["use_nodes"], "is_deprecated", False)


def uses_nodes(datablock):
    return datablock.use_nodes if has_choice_of_nodes(datablock) else datablock.node_tree is not None


def use_nodes(datablock):
    """Makes nodes say what a material, light or world is."""
    if has_choice_of_nodes(datablock):
        datablock.use_nodes = True


def names_of_index_passes():
    """What Blender calls the passes of object and material indices; from Blender 5 on as its panels do."""
    import bpy

    # That shows in no property; scenes' compositing groups came with the same version.
    if "compositing_node_group" in bpy.types.Scene.bl_rna.properties:
        return "Object Index", "Material Index"
    return "IndexOB", "IndexMA"


def has_printed_statistics():
    """Whether a Blender without a window prints how far a render is; from Blender 5 on it tells its handlers alone."""
    import bpy

    # That shows in no property; scenes' compositing groups came with the same version.
    return "compositing_node_group" not in bpy.types.Scene.bl_rna.properties


def draw_progress(layout, owner, name, text):
    """A bar for the property `name` of `owner`, a percentage."""
    if hasattr(layout, "progress"):
        percent = getattr(owner, name)
        layout.progress(factor=percent / 100.0, text=f"{percent:.0f} %, {text}")
    else:
        layout.prop(owner, name, text=text, slider=True)


def refuses_writing(error):
    """Whether an AttributeError or RuntimeError says that Blender lets timers write nothing at present: so it is while
    an engine written in Python renders, and for good where that began amid the drawing of a panel (engine/writing.py
    mends that)."""
    return any(part in str(error) for part in ("Writing to ID classes in this context", "can't modify blend data"))


def casts_shadows(light):
    """As Cycles has it: by a choice of its own, or, where it has none any more, by Blender's."""
    own = getattr(light, "cycles", None)
    return own.cast_shadow if hasattr(own, "cast_shadow") else light.use_shadow


def has_even_lights():
    """Whether Cycles takes an area light's watts for those of a Lambertian emitter, a spot for a point light in a cone,
    and a sun for a disc in the sky that is as bright all over, of which a plane that faces it receives the strength.
    Before Blender 4.0 an area light had pi / 4 of that, a spot weakened with the cosine from its axis, and a sun was a
    flat disc, brighter towards its rim: a plane received 2 cos(angle / 2) / (1 + cos(angle / 2)) of its strength."""
    import bpy

    # That shows in no property; lights for some objects alone came with the same version.
    return "light_linking" in bpy.types.Object.bl_rna.properties


def frees_first_instances():
    """Whether `foreach_get` of a dependency graph's instances frees those of the first object, which it looks at once
    more beforehand; before Blender 5 it keeps them until Blender quits."""
    import bpy

    # That shows in no property; scenes' compositing groups came no earlier.
    return "compositing_node_group" in bpy.types.Scene.bl_rna.properties


def geometry_set(evaluated_object):
    """What the modifiers of an evaluated object have made, instances too, or None where this Blender does not tell."""
    return evaluated_object.evaluated_geometry() if hasattr(evaluated_object, "evaluated_geometry") else None


def facets_masking():
    """How facets of Cycles' rough surfaces hide one another: that changed with its lights."""
    return "correlated" if has_even_lights() else "separable"


def owner_of_motion_blur_position(scene):
    """Whose property `motion_blur_position` says when a frame's shutter is open: from the frame on (START), about it
    (CENTER) or up to it (END). Cycles', until Blender made it every engine's; None where neither is there."""
    owners = (scene.render, getattr(scene, "cycles", None))
    return next((owner for owner in owners if hasattr(owner, "motion_blur_position")), None)


def principled_layers():
    """How the Principled node's metal, coat and base are layered, as native.Finish has it: up to Blender 3 as by
    Burley."""
    return {"coat_shades_base": True, "metal_whitens": True} if has_even_lights() else {"retro_reflective": True}


def principled_tint_power(node):
    """Of a Principled node's base colour, which is left of light that goes into its glass and out: up to Blender 3 each
    of both surfaces has it whole, as a Glass node's has, then its root."""
    return 1.0 if "Transmission Weight" in node.inputs else 2.0


def facets(node):
    """Whether the facets of a Principled or Glossy node keep what one bounce loses, as native.Finish has it."""
    # Up to Blender 3 Cycles follows walks among the facets (Heitz et al., "Multiple-Scattering Microfacet BSDFs with
    # the Smith Model", 2016), which tell about as much light another way round.
    return {"facets_keep_energy": True} if node.distribution == "MULTI_GGX" else {}


def rough_diffuse_keeps_energy():
    """Whether Cycles' rough Diffuse node has the light of further bounces between its facets, too."""
    import bpy

    return bpy.app.version >= (4, 2, 0)


def has_principled_default():
    """Whether Cycles gives a Principled node to what wears no material; before Blender 5 it is a Diffuse one."""
    import bpy

    # That shows in no property; scenes' compositing groups came no earlier.
    return "compositing_node_group" in bpy.types.Scene.bl_rna.properties


def bumps():
    """How bent normals shade, as native.Finish has it. Nothing bends those of diffuse shares back where a material may
    do without such a correction; they shade themselves as facets do from Blender 5 on, and by the cubic before."""
    import bpy

    settings = getattr(bpy.types.Material.bl_rna.properties.get("cycles"), "fixed_type", None)
    found = {"bent_normals_stay": True} if settings and "use_bump_map_correction" in settings.properties else {}
    return {**found, "facets_shade_bumps": True} if has_principled_default() else found


def cells_by_lookup3():
    """Whether the Voronoi Texture's points are hashed by Jenkins' lookup3; Blender 5, whose skies are others too,
    hashes them otherwise."""
    import bpy

    kinds = bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items
    return "NISHITA" in {kind.identifier for kind in kinds}


def import_by_appending(library):
    """Makes what is dragged from an asset library a copy, where this Blender asks how: an add-on that is gone takes no
    links with it."""
    if not hasattr(library, "import_method"):
        return
    try:
        library.import_method = "APPEND_REUSE"
    except TypeError:  # Blender 5 has that no more
        library.import_method = "APPEND"


def set_modifier_input(modifier, name, value):
    """Sets an input of a geometry nodes modifier by its name. Blender 5 keeps them apart from the modifier's own
    properties."""
    group = modifier.node_group
    if hasattr(group, "interface"):
        sockets = [item for item in group.interface.items_tree if getattr(item, "in_out", "") == "INPUT"]
    else:
        sockets = group.inputs
    identifier = next(socket.identifier for socket in sockets if socket.name == name)
    inputs = getattr(getattr(modifier, "properties", None), "inputs", None)
    if inputs is None:
        modifier[identifier] = value
    else:
        getattr(inputs, identifier).value = value
