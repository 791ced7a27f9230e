"""Makes the pictures of tutorial.md, by its own steps.

    blender -b --factory-startup --python-exit-code 1 --python docs/make_tutorial.py -- [FOLDER [WIDTH [SAMPLES]]]

Every step is what an artist clicks, called as an operator or set as a property; a test follows them at a small size.
"""
import pathlib
import sys

import bpy

ROOT = pathlib.Path(__file__).resolve().parents[1]


def begin():
    """File > New > General, and the engine."""
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    bpy.context.scene.render.engine = "MESOGRAIN"


def make_it_sugar():
    """The cube becomes a crystal of sugar, 16 mm wide, with worn edges."""
    scene, cube = bpy.context.scene, bpy.data.objects["Cube"]
    bpy.context.view_layer.objects.active = cube
    bpy.ops.mesograin.make_grain(preset="sugar")
    scene.mesograin.millimetres_per_unit = 8.0
    bevel = cube.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = 0.15, 4
    for polygon in cube.data.polygons:
        polygon.use_smooth = True
    if hasattr(cube.data, "use_auto_smooth"):  # without it Blender keeps what is flat so by itself
        cube.data.use_auto_smooth = True


def choose_the_model():
    bpy.ops.mesograin.choose_model()
    return bpy.data.objects["Cube"].active_material.mesograin.model


def light_from_behind():
    """The lamp becomes a low sun behind the cube."""
    lamp = bpy.data.objects["Light"]
    lamp.data.type = "SUN"
    lamp.data.energy = 4.0
    lamp.rotation_euler = (-1.2, 0.0, 0.5)


def tweak():
    """Set by Look: browner, and clearer."""
    look = bpy.data.objects["Cube"].active_material.mesograin_look
    look.way = "look"
    look.colour = (0.8, 0.35, 0.1)
    look.mean_free_path = [2.0 * path for path in look.mean_free_path]


def pour_sand():
    """Another file: a handful of sand on a ground, under a sun."""
    from mesograin import compat  # which Blender finds once the add-on is enabled

    begin()
    scene = bpy.context.scene
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.mesh.primitive_plane_add(size=20.0)
    ground = bpy.data.materials.new("Ground")
    compat.use_nodes(ground)
    bpy.context.object.data.materials.append(ground)
    bpy.ops.mesograin.add_pile(kind="sand", count=300, shapes=3, size=0.2, seed=1)
    scene.mesograin.millimetres_per_unit = 2.0
    lamp = bpy.data.objects["Light"]
    lamp.data.type = "SUN"
    lamp.data.energy = 3.0
    lamp.data.angle = 0.1
    scene.mesograin.exchange = "off"


def send_light_between_grains():
    bpy.context.scene.mesograin.exchange = "heaps"


def render(path, width, samples):
    """F12 at 16:9, as a PNG."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = width, width * 9 // 16
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.mesograin.samples = samples
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


def make(folder, width=480, samples=64):
    """Goes through the tutorial; returns the model that was chosen for the cube."""
    folder = pathlib.Path(folder)

    def picture(name):
        render(folder / f"tutorial_{name}.png", width, samples)

    begin()
    picture("default")
    make_it_sugar()
    chosen = choose_the_model()
    picture("sugar")
    light_from_behind()
    picture("behind")
    tweak()
    picture("brown")
    pour_sand()
    picture("sand_alone")
    send_light_between_grains()
    picture("sand")
    return chosen


if __name__ == "__main__":
    import addon_utils

    sys.path.insert(0, str(ROOT / "addon"))
    if addon_utils.enable("mesograin", default_set=True) is None:
        sys.exit("the add-on cannot be enabled")
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    make(words[0] if words else ROOT / "docs/images", *map(int, words[1:]))
