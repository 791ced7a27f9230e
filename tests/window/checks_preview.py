# The preview in a material's tab and its icon: a grain on the stage that Blender sets, drawn anew when it changes.
import bpy
from mesograin.engine import material_preview

PANEL = "MATERIAL_PT_preview"


def open_panel():
    """Has Blender's panel begin open."""
    panel = getattr(bpy.types, PANEL)
    bpy.utils.unregister_class(panel)
    panel.bl_options = set()
    bpy.utils.register_class(panel)


def colourful(picture):
    """Share of the pixels that are yellow; of Blender's own theme hardly any are."""
    return (picture[..., :2].min(axis=-1) > picture[..., 2] + 0.15).mean()


def prepare(window):
    """The sphere's tab; gives the Properties editor's area and the material."""
    open_panel()
    main = max(window._window().screen.areas, key=lambda area: area.width * area.height)
    main.type = "VIEW_3D"
    area = yield from window.open("sphere", samples=1)
    area.spaces.active.shading.type = "SOLID"
    bpy.context.view_layer.objects.active = bpy.data.objects["Sphere"]
    area.type = "PROPERTIES"
    yield from window.seconds(0.5)  # it has its tabs once it was drawn
    area.spaces.active.context = "MATERIAL"
    material = bpy.data.materials["Translucent"]
    material.mesograin.model, material.mesograin.boundary = "model_2", "index_matched"
    material.mesograin.scale = 1.0
    return area, material


def check_a_material_is_previewed_and_again_when_it_changes(window):
    area, material = yield from prepare(window)
    area.tag_redraw()
    yield from window.until(lambda: not bpy.app.is_job_running("RENDER_PREVIEW"))
    grey = yield from window.picture(area)
    size = material_preview._sizes["Translucent"]
    assert abs(size - 4.8) < 1e-4, f"the sphere is as large as it is in the scene, not {size} mm"
    material.mesograin.sigma_a = (0.01, 0.02, 2.0)

    def icon_is_yellow():
        # Not as Blender has it: who asks for an icon again and again has none rendered.
        icons = [icon.reshape(-1, 4) for (name, _, _), icon in material_preview._icons.items() if name == material.name]
        return any(icon[:, 3].min() < 0.1 and colourful(icon[icon[:, 3] > 0.9]) > 0.5 for icon in icons)

    yield from window.until(icon_is_yellow)
    yield from window.until(lambda: not bpy.app.is_job_running("RENDER_PREVIEW"))
    picture = yield from window.picture(area)
    assert colourful(picture) > colourful(grey) + 0.01, "the preview shows the grain as it was"


def covered(material):
    """Share of the material's icon that the grain covers; 0 of none."""
    icons = [icon for (name, _, _), icon in material_preview._icons.items() if name == material.name]
    return max(((icon[..., 3] > 0.5).mean() for icon in icons), default=0.0)


def check_a_preview_shows_the_artists_own_grain_as_it_is_turned(window):
    area, material = yield from prepare(window)
    yield from window.until(lambda: covered(material) > 0.2)
    ball = covered(material)
    sphere = bpy.data.objects["Sphere"]
    sphere.scale = (0.3, 0.3, 1.0)
    material.mesograin_preview = material_preview.OWN
    area.tag_redraw()
    yield from window.until(lambda: 0.1 * ball < covered(material) < 0.6 * ball)
    upright = covered(material)
    sphere.rotation_euler[1] = 1.5707963  # along the stage's line of sight, seen from above
    yield from window.until(lambda: covered(material) != upright)
    material.mesograin_preview = "stage"
    yield from window.until(lambda: covered(material) > 0.9 * ball)


def check_what_is_wrong_leaves_no_preview_and_no_traceback(window):
    area, material = yield from prepare(window)
    material.mesograin.boundary = "lambert_refracted"
    material.mesograin.model = "model_3"
    material.mesograin["profile"] = 2
    area.tag_redraw()
    yield from window.seconds(1.0)
    yield from window.until(lambda: not bpy.app.is_job_running("RENDER_PREVIEW"))
