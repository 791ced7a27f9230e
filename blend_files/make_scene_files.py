# Makes scenes/*.blend, scenes as artists have them, of Cycles' nodes alone, that docs/scenes.md shows. Run it with the
# oldest Blender served:
#   blender -b --factory-startup --python-exit-code 1 --python blend_files/make_scene_files.py [-- FOLDER]
import math
import pathlib
import sys

import bpy
import numpy as np
from mathutils import Euler, Matrix, Vector

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "addon")]

import parts  # noqa: E402

FOLDER = HERE / "scenes"
SIZE = (400, 300)


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


def mesh_lights():
    """A studio lit by shining rectangles."""
    parts.begin(SIZE)
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
    parts.begin(SIZE)
    width, height = 256, 128
    turn, rise = np.meshgrid(np.linspace(-math.pi, math.pi, width), np.linspace(-0.5 * math.pi, 0.5 * math.pi, height))
    up = np.clip(np.sin(rise), 0.0, 1.0)[..., None]
    sky = np.where(rise[..., None] > 0.0, np.array((0.8, 0.75, 0.7)) * (1.0 - up) + np.array((0.12, 0.25, 0.6)) * up,
                   np.array((0.12, 0.1, 0.08)))
    sky = sky + np.exp(-((turn - 0.8) ** 2 + (rise - 0.7) ** 2) / 0.01)[..., None] * np.array((60.0, 50.0, 35.0))
    clouds = 0.15 * (1.0 + np.sin(5.0 * turn + 3.0 * np.sin(4.0 * rise))) * (rise > 0.05)
    parts.surround(*world(), "Sky", sky + clouds[..., None])
    shape("plane", principled("Ground", (0.3, 0.28, 0.25), Roughness=0.9)[0], (0.0, 0.0, 0.0), smooth=False, size=14.0)
    for place, made in (((-2.1, 0.0, 0.9), principled("Plaster", (0.7, 0.7, 0.7), Specular=0.0)[0]),
                        ((0.0, 0.0, 0.9), principled("Plastic", (0.5, 0.05, 0.04), Roughness=0.4)[0]),
                        ((2.1, 0.0, 0.9), principled("Metal", (0.8, 0.8, 0.85), Metallic=1.0, Roughness=0.4)[0])):
        shape("uv_sphere", made, place, segments=64, ring_count=32, radius=0.9)
    look_from((0.0, -9.0, 3.0), (0.0, 0.0, 0.9), 45.0)


def scatter():
    """Two thousand pebbles on a ground with a texture, under a sun and a sky."""
    parts.begin(SIZE)
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


SCENES = (mesh_lights, environment, scatter)


def main():
    import addon_utils

    addon_utils.enable("mesograin", default_set=True)
    folder = pathlib.Path(sys.argv[sys.argv.index("--") + 1]) if "--" in sys.argv else FOLDER
    for make in SCENES:
        make()
        bpy.ops.wm.save_as_mainfile(filepath=str(folder / f"{make.__name__}.blend"), compress=True)


if __name__ == "__main__":
    main()
