# Makes docs/images/scene_*.jpg and their lines of docs/scenes.md: scenes as artists have them, by both engines:
#   blender -b --factory-startup --python-exit-code 1 --python docs/make_side_by_side.py [-- NAME ...]
import math
import pathlib
import sys
import tempfile

import bpy
import numpy as np
from mathutils import Euler, Matrix, Vector

DOCS = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(DOCS.parent / "addon"), str(DOCS.parent / "blend_files")]

import parts  # noqa: E402

SIZE = (400, 300)
BLOCK = 10
SAMPLES = {"MESOGRAIN": 64, "CYCLES": 128}


def start(empty=True):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=empty)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    return scene


def put(name, data, place=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0), scale=(1.0, 1.0, 1.0)):
    made = bpy.data.objects.new(name, data)
    made.matrix_world = Matrix.LocRotScale(Vector(place), Euler(turn), Vector(scale))
    bpy.context.scene.collection.objects.link(made)
    return made


def look_from(place, at, lens):
    camera = bpy.data.cameras.new("Camera")
    camera.lens = lens
    turn = (Vector(place) - Vector(at)).to_track_quat("Z", "Y").to_euler()
    bpy.context.scene.camera = put("Camera", camera, place, turn)


def shape(operator, material, place, turn=(0.0, 0.0, 0.0), smooth=True, **size):
    getattr(bpy.ops.mesh, f"primitive_{operator}_add")(location=place, rotation=turn, **size)
    made = bpy.context.object
    made.data.polygons.foreach_set("use_smooth", [smooth] * len(made.data.polygons))
    made.data.materials.append(material)
    return made


def principled(name, colour, **inputs):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = next(each for each in material.node_tree.nodes if each.type == "BSDF_PRINCIPLED")
    node.inputs["Base Color"].default_value = (*colour, 1.0)
    for key, value in inputs.items():
        node.inputs[key].default_value = value
    return material, node


def shining(name, colour, strength):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value, emission.inputs["Strength"].default_value = (*colour, 1.0), strength
    tree.links.new(emission.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    return material


def checkered(first, second, scale, **inputs):
    material, node = principled("Checks", first, **inputs)
    checker = material.node_tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (*first, 1.0), (*second, 1.0)
    checker.inputs["Scale"].default_value = scale
    material.node_tree.links.new(checker.outputs["Color"], node.inputs["Base Color"])
    return material


def world(colour=None):
    made = bpy.context.scene.world = bpy.data.worlds.new("World")
    made.use_nodes = True
    background = next(node for node in made.node_tree.nodes if node.type == "BACKGROUND")
    if colour:
        background.inputs["Color"].default_value = (*colour, 1.0)
    return made.node_tree, background


def default():
    """Blender's default scene."""
    start(empty=False)


def mesh_lights():
    """A studio lit by shining rectangles."""
    start()
    shape("plane", checkered((0.6, 0.6, 0.6), (0.3, 0.3, 0.32), 12.0, Roughness=0.7), (0.0, 0.0, 0.0), smooth=False,
          size=12.0)
    shape("monkey", principled("Clay", (0.55, 0.25, 0.12), Roughness=0.6)[0], (-1.3, 0.0, 0.95), (-0.6, 0.0, -0.4))
    shape("uv_sphere", principled("Gold", (0.9, 0.6, 0.2), Metallic=1.0, Roughness=0.35)[0], (1.2, 0.2, 0.9),
          segments=64, ring_count=32, radius=0.9)
    shape("cube", principled("Plastic", (0.05, 0.2, 0.5), Roughness=0.3)[0], (0.2, -1.6, 0.4), (0.0, 0.0, 0.6),
          smooth=False, size=0.8)
    shape("plane", shining("Key", (1.0, 0.9, 0.8), 12.0), (-3.0, -2.5, 4.0), (0.6, -0.5, 0.0), smooth=False, size=1.6)
    shape("plane", shining("Rim", (0.5, 0.7, 1.0), 14.0), (3.5, 2.5, 3.0), (-0.7, 0.8, 0.0), smooth=False, size=1.2)
    world((0.02, 0.02, 0.025))
    look_from((0.4, -8.0, 3.6), (0.0, 0.0, 0.7), 45.0)


def environment():
    """Balls of plaster, plastic and metal under an image of a sky."""
    start()
    width, height = 256, 128
    turn, rise = np.meshgrid(np.linspace(-math.pi, math.pi, width), np.linspace(-0.5 * math.pi, 0.5 * math.pi, height))
    up = np.clip(np.sin(rise), 0.0, 1.0)[..., None]
    sky = np.where(rise[..., None] > 0.0, np.array((0.8, 0.75, 0.7)) * (1.0 - up) + np.array((0.12, 0.25, 0.6)) * up,
                   np.array((0.12, 0.1, 0.08)))
    sky = sky + np.exp(-((turn - 0.8) ** 2 + (rise - 0.7) ** 2) / 0.01)[..., None] * np.array((60.0, 50.0, 35.0))
    clouds = 0.15 * (1.0 + np.sin(5.0 * turn + 3.0 * np.sin(4.0 * rise))) * (rise > 0.05)
    pixels = np.ones((height, width, 4), dtype=np.float32)
    pixels[..., :3] = sky + clouds[..., None]
    image = bpy.data.images.new("Sky", width, height, float_buffer=True)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    tree, background = world()
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    shape("plane", principled("Ground", (0.3, 0.28, 0.25), Roughness=0.9)[0], (0.0, 0.0, 0.0), smooth=False, size=14.0)
    for place, made in (((-2.1, 0.0, 0.9), principled("Plaster", (0.7, 0.7, 0.7), Specular=0.0)[0]),
                        ((0.0, 0.0, 0.9), principled("Plastic", (0.5, 0.05, 0.04), Roughness=0.4)[0]),
                        ((2.1, 0.0, 0.9), principled("Metal", (0.8, 0.8, 0.85), Metallic=1.0, Roughness=0.4)[0])):
        shape("uv_sphere", made, place, segments=64, ring_count=32, radius=0.9)
    look_from((0.0, -9.0, 3.0), (0.0, 0.0, 0.9), 45.0)


def scatter():
    """Two thousand pebbles on a ground with a texture, under a sun and a sky."""
    start()
    ground, node = principled("Ground", (0.4, 0.3, 0.2), Roughness=0.9)
    size = 64
    random = np.random.default_rng(1)
    pixels = np.ones((size, size, 4), dtype=np.float32)
    pixels[..., :3] = np.array((0.45, 0.33, 0.2)) * random.uniform(0.6, 1.1, (size, size, 1))
    image = bpy.data.images.new("Earth", size, size)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    texture = ground.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    ground.node_tree.links.new(texture.outputs["Color"], node.inputs["Base Color"])
    plane = shape("plane", ground, (0.0, 0.0, 0.0), smooth=False, size=10.0)
    pebble = shape("ico_sphere", principled("Pebble", (0.5, 0.45, 0.42), Roughness=0.6)[0], (0.0, 0.0, -5.0),
                   subdivisions=3, radius=1.0)
    pebble.scale = (1.0, 0.8, 0.6)
    for vertex in pebble.data.vertices:
        x, y, z = vertex.co
        vertex.co *= 1.0 + 0.15 * math.sin(4.0 * x + 1.0) * math.cos(5.0 * y - 3.0 * z)
    settings = plane.modifiers.new("Scatter", "PARTICLE_SYSTEM").particle_system.settings
    settings.type, settings.count, settings.use_advanced_hair = "HAIR", 2000, True
    settings.render_type, settings.instance_object = "OBJECT", pebble
    settings.particle_size, settings.size_random = 0.02, 0.6
    settings.use_rotations, settings.rotation_factor_random, settings.phase_factor_random = True, 0.3, 2.0
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle = 3.0, 0.02
    put("Sun", sun, turn=(0.8, 0.2, 0.6))
    world((0.3, 0.38, 0.5))
    look_from((0.0, -6.5, 3.4), (0.0, 0.0, 0.0), 50.0)


SCENES = (default, mesh_lights, environment, scatter)


def render(engine, folder, mirrored=False):
    """(picture as it looks, (h, w, 3) 0 to 1; linear, (h, w, 3)), row 0 at the bottom."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.mesograin.samples = SAMPLES["MESOGRAIN"]
    scene.mesograin.exchange = "off"  # it is of heaps
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = SAMPLES["CYCLES"], False, False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = 1 if mirrored else 12
    cycles.diffuse_bounces, cycles.glossy_bounces = (0, 1) if mirrored else (4, 4)
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    scene.render.filepath = str(folder / f"{engine}.exr")
    bpy.ops.render.render(write_still=True)
    linear = parts.pixels_of(scene.render.filepath)[..., :3]
    settings.file_format, settings.color_depth = "PNG", "8"
    looks = str(folder / f"{engine}.png")
    bpy.data.images["Render Result"].save_render(looks)
    return parts.pixels_of(looks)[..., :3], linear


def difference(ours, theirs):
    """Relative L1 of the means of blocks."""
    found, right = (parts.blocks(each, BLOCK) for each in (ours, theirs))
    return np.abs(found - right).sum() / right.sum()


def take(make):
    """One line of the table."""
    from mesograin.scene import export, meshes

    name = make.__name__
    make()
    warnings = export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache()).warnings
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        looks, ours = render("MESOGRAIN", folder)
        full_looks, full = render("CYCLES", folder)
        _, mirrored = render("CYCLES", folder, mirrored=True)
    parts.save_beside(DOCS / "images" / f"scene_{name}.jpg", (looks, full_looks), 88)
    for warning in warnings:
        print(f"{name}: {warning}", flush=True)
    return (f"| {make.__doc__.rstrip('.')} | {100.0 * difference(ours, mirrored):.1f} % | "
            f"{100.0 * difference(ours, full):.1f} % | ![](images/scene_{name}.jpg) |\n")


def write_row(name, row):
    """Puts a scene's line in place of the one that docs/scenes.md has."""
    page = DOCS / "scenes.md"
    lines = page.read_text(encoding="utf-8").splitlines(keepends=True)
    kept = [row if f"images/scene_{name}.jpg" in line else line for line in lines]
    page.write_text("".join(kept), encoding="utf-8")


def main():
    import addon_utils

    addon_utils.enable("mesograin", default_set=True)
    asked = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    for make in SCENES:
        if not asked or make.__name__ in asked:
            write_row(make.__name__, take(make))


main()
