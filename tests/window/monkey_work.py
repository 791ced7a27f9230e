# What a monkey may do in Blender's window: each function with @work is one operation, which draws its choices from `m`.
import math
import os

import bpy
from mesograin.schema import models, parameters
from mesograin.ui import presets
from mesograin.ui.bake_panel import session as baking
from mesograin.ui.compare_panel import session as comparing

WORK = []  # (weight, function)
COLOURS = [name for name, each in parameters.PARAMETERS.items() if each.kind == "rgb"]
MOST_OBJECTS = 14
MANY_VERTICES = 2000  # of a mesh that is not multiplied
# MESOGRAIN_ENGINE=BLENDER_WORKBENCH tells what Blender keeps of the same day without us: the engine of each file, then.
OURS = "MESOGRAIN"
ENGINE = os.environ.get("MESOGRAIN_ENGINE", OURS)
ENGINES = (ENGINE, ENGINE, ENGINE, "BLENDER_WORKBENCH", "CYCLES")
FILES = ("sphere", "grain", "heap", "studio")


def work(weight):
    """Marks an operation. What it returns, or what its generator waits for, is the monkey's."""
    def mark(function):
        WORK.append((weight, function))
        return function
    return mark


# Materials

def _grain(m):
    material = m.one_of(bpy.data.materials)
    return material and material.mesograin


@work(20)
def change_parameter(m):
    grain = _grain(m)
    if grain is None:
        return
    name = m.random.choice([name for name in models.CHOICES[grain.model].parameters if name != "profile"])
    parameter = parameters.PARAMETERS[name]
    if parameter.kind == "switch":
        setattr(grain, name, m.random.random() < 0.5)
    elif parameter.kind == "choice":
        setattr(grain, name, m.random.choice(parameter.choices).name)
    else:
        most = min(parameter.most, 10.0)
        values = [max(parameter.least, 0.01) * (most / max(parameter.least, 0.01)) ** m.random.random()
                  for _ in range(3)]
        setattr(grain, name, values if parameter.kind == "rgb" else values[0])


@work(3)
def change_parameter_to_an_extreme(m):
    grain = _grain(m)
    if grain is not None:
        name = m.random.choice(COLOURS)
        value = m.random.choice((0.0, 1e-9, 1e6, 1e12, math.inf, math.nan))
        setattr(grain, name, (value, 0.5, 0.5))


@work(8)
def choose_model(m):
    grain = _grain(m)
    if grain is not None:
        grain.model = m.random.choice(list(models.CHOICES))


@work(3)
def choose_profile(m):
    grain = _grain(m)
    if grain is not None:
        grain.profile = m.random.choice(parameters.profiles_of(grain.model))


@work(5)
def change_look(m):
    material = m.one_of(bpy.data.materials)
    if material is None:
        return
    look = material.mesograin_look
    which = m.random.randrange(3)
    if which == 0:
        look.colour = [m.random.random() for _ in range(3)]
    elif which == 1:
        look.mean_free_path = [0.01 * 1e3 ** m.random.random() for _ in range(3)]
    else:
        look.surroundings = m.random.choice(("air", "water", "oil"))


@work(3)
def take_preset(m):
    grain = _grain(m)
    if grain is not None:
        presets.apply(m.random.choice(list(presets.BY_IDENTIFIER.values())), grain)


@work(2)
def let_advice_choose(m):
    yield from m.operator("mesograin", "choose_model")


@work(3)
def give_another_material(m):
    thing, material = m.mesh_object(), m.one_of(bpy.data.materials)
    if thing is not None and thing.mode == "OBJECT":
        thing.active_material = m.random.choice((material, material, None))


@work(2)
def new_material(m):
    thing = m.mesh_object()
    if thing is not None and len(bpy.data.materials) < 20:
        material = bpy.data.materials.new("New")
        material.mesograin.model = m.random.choice(list(models.CHOICES))
        thing.data.materials.append(material)


@work(1)
def remove_material(m):
    if len(bpy.data.materials) > 1:
        bpy.data.materials.remove(m.one_of(bpy.data.materials))


@work(1)
def undo_nodes(m):
    material = m.one_of(bpy.data.materials)
    if material is not None and material.node_tree is not None and material.node_tree.nodes:
        material.node_tree.nodes.remove(m.one_of(material.node_tree.nodes))


# Objects

@work(9)
def move(m):
    thing = m.one_of(bpy.context.scene.objects)
    if thing is not None:
        thing.location = [m.random.uniform(-2.0, 2.0) for _ in range(3)]


@work(4)
def turn_or_scale(m):
    thing = m.one_of(bpy.context.scene.objects)
    if thing is None:
        return
    if m.random.random() < 0.5:
        thing.rotation_euler = [m.random.uniform(-math.pi, math.pi) for _ in range(3)]
    else:
        scale = [m.random.choice((-1.0, 0.0, 0.3, 0.6, 1.0, 1.5)) for _ in range(3)]
        thing.scale = scale if bpy.context.scene.render.engine != "CYCLES" else [each or 1.0 for each in scale]


def _select(m):
    thing = m.one_of(bpy.context.view_layer.objects)
    if thing is not None:
        for other in bpy.context.view_layer.objects:
            other.select_set(other == thing)
        bpy.context.view_layer.objects.active = thing
    return thing


@work(5)
def select(m):
    _select(m)


@work(4)
def duplicate(m):
    if _select(m) is not None and len(bpy.context.scene.objects) < MOST_OBJECTS:
        yield from m.operator("object", "duplicate", linked=m.random.random() < 0.5)


@work(4)
def delete(m):
    if _select(m) is not None and len(bpy.context.scene.objects) > 1:
        yield from m.operator("object", "delete", use_global=m.random.random() < 0.3)


@work(1)
def remove_mesh(m):
    if len(bpy.data.meshes) > 1:
        bpy.data.meshes.remove(m.one_of(bpy.data.meshes))


@work(3)
def add_grain(m):
    if len(bpy.context.scene.objects) < MOST_OBJECTS:
        kind = m.random.choice(("sand", "salt", "rice", "bead"))
        yield from m.operator("mesograin", "add_grain", kind=kind, segments=8, seed=m.random.randrange(9))


@work(2)
def add_pile(m):
    if len(bpy.context.scene.objects) < MOST_OBJECTS:
        yield from m.operator("mesograin", "add_pile", count=m.random.choice((10, 80)), size=0.2, segments=4,
                              place=m.random.choice(("HEAP", "BOX", "ACTIVE")))


@work(3)
def add_light(m):
    if len(bpy.context.scene.objects) < MOST_OBJECTS:
        kind = m.random.choice(("SUN", "POINT", "SPOT", "AREA"))
        yield from m.operator("object", "light_add", type=kind, location=(2, 2, 2))


@work(4)
def change_light(m):
    light = m.one_of(bpy.data.lights)
    if light is None:
        return
    which = m.random.randrange(3)
    if which == 0:
        light.energy = m.random.choice((0.0, 1.0, 10.0, 100.0))
    elif which == 1:
        light.color = [m.random.random() for _ in range(3)]
    else:
        light.type = m.random.choice(("SUN", "POINT", "SPOT", "AREA"))


@work(2)
def hide(m):
    thing = m.one_of(bpy.context.view_layer.objects)
    if thing is not None:
        setattr(thing, m.random.choice(("hide_viewport", "hide_render")), m.random.random() < 0.5)


@work(3)
def add_or_remove_modifier(m):
    thing = m.mesh_object()
    if thing is None:
        return
    if thing.modifiers:
        thing.modifiers.clear()
    elif len(thing.data.vertices) < MANY_VERTICES:
        modifier = thing.modifiers.new("Modifier", m.random.choice(("ARRAY", "SUBSURF", "DECIMATE", "WIREFRAME")))
        if modifier.type == "ARRAY":
            modifier.count = m.random.choice((2, 10))


@work(3)
def edit_mode(m):
    _select(m)
    if (yield from m.operator("object", "editmode_toggle")):
        yield from m.pause()
        if bpy.context.mode == "EDIT_MESH":
            yield from m.operator("mesh", "select_all", action="SELECT")
            yield from m.operator("transform", "resize", value=(1.0, m.random.choice((0.7, 1.4)), 1.0))
            yield from m.pause()
            yield from m.operator("ed", "undo_push", message="edit")
        if m.random.random() < 0.7:
            yield from m.operator("object", "editmode_toggle")


@work(2)
def edit_vertices(m):
    mesh = m.one_of(bpy.data.meshes)
    if mesh is not None and not mesh.is_editmode and mesh.vertices:
        m.one_of(mesh.vertices).co.z += m.random.uniform(-0.5, 0.5)
        mesh.update()
        mesh.update_tag()


# The scene

@work(3)
def change_world(m):
    world = bpy.context.scene.world
    if world is None or m.random.random() < 0.2:
        bpy.context.scene.world = m.random.choice((None, *bpy.data.worlds)) or bpy.data.worlds.new("World")
    elif world.node_tree is None:
        world.color = [m.random.random() for _ in range(3)]
    else:
        node = world.node_tree.nodes.get("Background")
        if node is not None:
            node.inputs["Strength"].default_value = m.random.choice((0.0, 0.5, 1.0))


@work(4)
def change_settings(m):
    scene = bpy.context.scene
    which = m.random.randrange(5)
    if which == 0:
        scene.mesograin.viewport_samples = m.random.choice((1, 4, 64, 1 << 14))
    elif which == 1:
        scene.mesograin.exchange = m.random.choice(parameters.SCENE["exchange"].choices).name
    elif which == 2:
        scene.mesograin.millimetres_per_unit = m.random.choice((0.01, 1.0, 1000.0))
    elif which == 3:
        scene.render.film_transparent = not scene.render.film_transparent
    else:
        scene.view_settings.exposure = m.random.uniform(-1.0, 1.0)


@work(4)
def change_frame(m):
    thing = m.one_of(bpy.context.scene.objects)
    if thing is not None and m.random.random() < 0.5:
        thing.keyframe_insert(m.random.choice(("location", "scale")))
    bpy.context.scene.frame_set(m.random.randrange(1, 50))


@work(2)
def play(m):
    yield from m.operator("screen", "animation_play")


@work(1)
def new_or_other_scene(m):
    scenes = [scene for scene in bpy.data.scenes if scene != bpy.context.scene]
    if not scenes:
        yield from m.operator("scene", "new", type=m.random.choice(("LINK_COPY", "FULL_COPY")))
    elif m.random.random() < 0.5:
        bpy.context.window_manager.windows[0].scene = scenes[0]
    else:
        yield from m.operator("scene", "delete")


@work(1)
def purge(m):
    bpy.data.orphans_purge()


# History and files

@work(12)
def undo(m):
    for _ in range(m.random.choice((1, 1, 2, 4))):
        yield from m.operator("ed", "undo")
    return False


@work(8)
def redo(m):
    for _ in range(m.random.choice((1, 1, 2))):
        yield from m.operator("ed", "redo")
    return False


@work(2)
def save(m):
    yield from m.operator("wm", "save_as_mainfile", filepath=str(m.folder / "monkey.blend"), check_existing=False)
    return False


@work(2)
def load(m):
    saved = m.folder / "monkey.blend"
    m.open(saved if saved.exists() and m.random.random() < 0.6 else m.blend_file(m.random.choice(FILES)))
    return False


@work(1)
def load_with_its_windows(m):
    saved = m.folder / "monkey.blend"
    if saved.exists():
        m.open(saved, load_ui=True)
    return False


# What is shown

@work(4)
def switch_engine(m):
    engine = m.random.choice(ENGINES)
    # Cycles, without us too, ends Blender at an object that is scaled to nothing (an assertion of Embree's).
    if engine != "CYCLES" or all(all(thing.scale) for thing in bpy.data.objects):
        bpy.context.scene.render.engine = engine


@work(6)
def switch_shading(m):
    area = m.viewport()
    if area is not None:
        area.spaces.active.shading.type = m.random.choice(("WIREFRAME", "SOLID", "RENDERED", "RENDERED", "RENDERED"))
    return False


@work(8)
def orbit(m):
    area = m.viewport()
    if area is not None:
        view = area.spaces.active.region_3d
        view.view_rotation = [m.random.gauss(0.0, 1.0) for _ in range(4)]
        view.view_distance = m.random.uniform(3.0, 20.0)
    return False


@work(4)
def orbit_by_mouse(m):
    yield from m.drag_in_viewport()
    return False


@work(3)
def look_through_camera(m):
    area = m.viewport()
    if area is not None:
        yield from m.operator("view3d", "view_camera")
    return False


@work(2)
def change_overlays(m):
    area = m.viewport()
    if area is not None:
        area.spaces.active.overlay.show_overlays = not area.spaces.active.overlay.show_overlays
        area.spaces.active.show_region_ui = not area.spaces.active.show_region_ui
    return False


@work(2)
def local_view(m):
    yield from m.operator("view3d", "localview")
    return False


@work(3)
def quad_view(m):
    yield from m.operator("screen", "region_quadview")
    return False


@work(3)
def full_screen(m):
    yield from m.operator("screen", "screen_full_area", use_hide_panels=m.random.random() < 0.5)
    return False


@work(3)
def split_or_join(m):
    yield from m.split_or_join()
    return False


@work(2)
def resize_window(m):
    yield from m.resize_window()
    return False


@work(2)
def show_properties(m):
    for area in m.areas("PROPERTIES"):
        known = {item.identifier for item in area.spaces.active.bl_rna.properties["context"].enum_items}
        try:
            area.spaces.active.context = m.random.choice(sorted(known & {"RENDER", "MATERIAL", "DATA", "VIEW_LAYER"}))
        except TypeError:  # a tab that the active object lacks
            pass
    return False


@work(2)
def change_kind_of_area(m):
    areas = [area for area in m.areas() if area.type not in ("VIEW_3D", "PROPERTIES")]
    if areas:
        m.random.choice(areas).type = m.random.choice(("IMAGE_EDITOR", "OUTLINER", "NODE_EDITOR", "INFO"))
    return False


# Long work

@work(4)
def render(m):
    yield from m.start_render()
    return False


@work(3)
def render_and_escape(m):
    yield from m.start_render()
    yield from m.pause()
    m.press_escape()
    return False


@work(1)
def render_animation(m):
    yield from m.start_render(animation=True)
    return False


@work(2)
def bake(m):
    if ENGINE != OURS:
        return
    asked = bpy.context.scene.mesograin_bake
    asked.samples, asked.width, asked.height = m.random.choice((2, 1 << 14)), 32, 32
    asked.compare = False
    asked.out = str(m.folder / "baked.exr")
    if _select(m) is not None:
        yield from m.operator("mesograin", "bake")


@work(2)
def cancel_bake(m):
    if baking.session.running:
        yield from m.operator("mesograin", "cancel_bake")
    return False


@work(1)
def compare(m):
    if ENGINE != OURS:
        return
    asked = bpy.context.scene.mesograin_compare
    asked.models, asked.size_percent, asked.out = {"lambert"}, 2, str(m.folder / "compared")
    yield from m.operator("mesograin", "compare")


@work(3)
def cancel_compare(m):
    if comparing.session.running:
        yield from m.operator("mesograin", "cancel_compare")
    return False
