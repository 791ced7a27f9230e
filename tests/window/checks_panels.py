# Every panel of Mesograin as an artist has it on a screen 1920 wide, drawn without a complaint and kept as a picture:
# look_at_panels.py is how they are made, by hand.
import os

import bpy
from mesograin import compat
from mesograin.engine import status
from mesograin.schema import models
from mesograin.ui.bake_panel.session import session as baking
from mesograin.ui.compare_panel.session import session as comparing

THEME = os.environ.get("MESOGRAIN_THEME", "dark")


def open_panels():
    """Has ours begin open that a click would open: to be called before any is drawn. They come last then, and one that
    shows Blender's own large curve would push others over the edge."""
    for panel in bpy.types.Panel.__subclasses__():
        if (panel.__module__.startswith("mesograin.") and "DEFAULT_CLOSED" in getattr(panel, "bl_options", ())
                and panel.bl_label != "Motion Blur"):
            bpy.utils.unregister_class(panel)
            panel.bl_options = set(panel.bl_options) - {"DEFAULT_CLOSED"}
            bpy.utils.register_class(panel)


def prepare(window, viewport=False):
    """The sphere, active, beside a viewport or what is drawn faster; gives the Properties editor's area."""
    open_panels()
    main = max(window._window().screen.areas, key=lambda area: area.width * area.height)
    main.type = "VIEW_3D"
    area = yield from window.open("sphere", samples=1)
    use_theme()
    area.spaces.active.shading.type = "SOLID"
    with window.override(area):
        area.spaces.active.show_region_header = True
    if not viewport:
        main.type = "TEXT_EDITOR"
    bpy.context.view_layer.objects.active = bpy.data.objects["Sphere"]
    bpy.data.materials["Translucent"].mesograin.model = "model_2"
    yield from window.seconds(0.5)
    return window.area_of_type("PROPERTIES")


def use_theme():
    if THEME == "light":
        [path] = [path for folder in bpy.utils.preset_paths("interface_theme")
                  for path in [os.path.join(folder, "Blender_Light.xml")] if os.path.exists(path)]
        bpy.ops.script.execute_preset(filepath=path, menu_idname="USERPREF_MT_interface_theme_presets")


def show(properties, tab):
    properties.spaces.active.context = tab


def keep(window, area, name):
    """A picture of an area of this name; it is not empty."""
    window.check = name
    yield from window.seconds(1.0)  # panels that move have got there
    picture = yield from window.picture(area, whole=True)
    assert picture.std() > 0.02, f"{name}: nothing is drawn"


def check_materials(window):
    properties = yield from prepare(window)
    show(properties, "MATERIAL")
    material = bpy.data.materials["Translucent"]
    for model in models.CHOICES:
        material.mesograin.model = model
        yield from keep(window, properties, f"material_{model}")
    material.mesograin.model = "model_3"
    material.mesograin_look.way = "look"
    material.mesograin.boundary = "dielectric"
    material.mesograin_colours.vary = True
    yield from keep(window, properties, "material_look")
    material.mesograin.profile = "photon_beam"
    material.mesograin.roughness = 0.5
    material.mesograin.masking = "separable"
    material.mesograin.keyframe_insert("sigma_a")
    material.mesograin_look.way = "coefficients"
    yield from keep(window, properties, "material_complaint")
    plain = bpy.data.materials.new("Plain")
    compat.use_nodes(plain)
    bpy.data.objects["Sphere"].active_material = plain
    yield from keep(window, properties, "material_plain")


def check_render_settings(window):
    properties = yield from prepare(window)
    for tab in ("RENDER", "VIEW_LAYER", "WORLD"):
        show(properties, tab)
        yield from keep(window, properties, tab.lower())


def check_a_final_render(window):
    properties = yield from prepare(window)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.mesograin.samples = 96, 64, 4
    bpy.context.preferences.view.render_display_type = "NONE"
    status.clear()
    show(properties, "RENDER")
    yield from window.press_f12(properties)
    yield from window.until(lambda: status.get(status.RENDER) is not None and not bpy.app.is_job_running("RENDER"))
    yield from keep(window, properties, "render_done")


def check_lights_and_camera(window):
    properties = yield from prepare(window)
    thing = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    yield from window.seconds(0.3)
    show(properties, "DATA")
    for kind in ("SUN", "POINT", "SPOT", "AREA"):
        thing.data.type = kind
        yield from keep(window, properties, f"light_{kind.lower()}")
    bpy.context.view_layer.objects.active = bpy.context.scene.camera
    yield from keep(window, properties, "camera")


def check_what_is_left_out(window):
    properties = yield from prepare(window, viewport=True)
    area = window.area_of_type("VIEW_3D")
    bare = bpy.data.objects.new("Bare", bpy.data.objects["Sphere"].data.copy())
    bare.data.materials.clear()
    bare.scale = (0.0, 0.0, 0.0)
    bpy.context.scene.collection.objects.link(bare)
    bpy.context.view_layer.objects.active = bare
    area.spaces.active.shading.type = "RENDERED"
    yield from window.until(status.complaints, timeout=600.0)
    show(properties, "RENDER")
    yield from keep(window, properties, "render_complaints")
    yield from keep(window, area, "viewport")
    yield from menu(window, area, "notes", bpy.ops.wm.call_panel, "MESOGRAIN_PT_notes")


def menu(window, area, name, call, what):
    """A picture of an area while a menu or popover is open in the middle of it."""
    yield from window.point_at(area)
    with window.override(area):
        call("INVOKE_DEFAULT", name=what)
    yield from keep(window, area, name)
    yield from window.press(area, "ESC")


def check_menus(window):
    yield from prepare(window, viewport=True)
    area = window.area_of_type("VIEW_3D")
    for name in ("presets", "conversion", "add", "grain"):
        yield from menu(window, area, f"menu_{name}", bpy.ops.wm.call_menu, f"MESOGRAIN_MT_{name}")
    with window.override(area):
        bpy.ops.wm.search_menu("INVOKE_DEFAULT")
    at = yield from window.point_at(area)
    for letter in "grain":
        window._window().event_simulate(type=letter.upper(), value="PRESS", unicode=letter, **at)
        yield 0.05
    yield from keep(window, area, "searched")
    yield from window.press(area, "ESC")


def check_tools(window):
    yield from prepare(window, viewport=True)
    area = window.area_of_type("VIEW_3D")
    for letter in "SP":  # sand, a pile
        with window.override(area):
            bpy.ops.wm.call_menu("INVOKE_DEFAULT", name="MESOGRAIN_MT_add")
        yield from window.press(area, letter)
        yield from window.seconds(3.0)
        yield from keep(window, area, f"added_{letter}")


def check_comparison_and_bake(window):
    properties = yield from prepare(window, viewport=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 96, 64, 100
    compared, baked = scene.mesograin_compare, scene.mesograin_bake
    compared.models, compared.size_percent, compared.out = {"lambert", "model_1"}, 50, str(window.folder / "out")
    bpy.context.preferences.addons["mesograin"].preferences.cache_folder = str(window.folder / "cache")
    show(properties, "RENDER")
    window.call(properties, "compare")
    yield from window.until(lambda: comparing.task.step is not None)
    yield from keep(window, properties, "compare_running")
    yield from window.until(lambda: not comparing.running and not bpy.app.timers.is_registered(comparing.poll), 240.0)
    yield from keep(window, properties, "compare_done")
    baked.width, baked.height, baked.samples, baked.compare = 64, 32, 4, True
    baked.reference_samples, baked.out = 4, str(window.folder / "bake.exr")
    window.call(properties, "bake")
    yield from window.until(lambda: not baking.running and not bpy.app.timers.is_registered(baking.poll), 240.0)
    yield from keep(window, properties, "bake_done")
    area = window.area_of_type("VIEW_3D")
    area.type = "IMAGE_EDITOR"
    try:
        area.spaces.active.show_region_ui = True
        with window.override(area):
            bpy.ops.mesograin.show_picture(case="lambert.diffuse", picture="error colours")
        yield from keep(window, area, "pictures")
    finally:
        area.type = "VIEW_3D"


def check_preferences(window):
    yield from prepare(window, viewport=True)
    area = window.area_of_type("VIEW_3D")
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Mesograin"
    area.type = "PREFERENCES"
    try:
        yield from window.seconds(0.3)
        bpy.ops.preferences.addon_expand(module="mesograin")
        yield from keep(window, area, "preferences")
        with window.override(area):
            assert bpy.ops.mesograin.self_test() == {"FINISHED"}
        yield from keep(window, area, "preferences_tested")
    finally:
        area.type = "VIEW_3D"
