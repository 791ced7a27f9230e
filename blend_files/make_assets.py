# Makes the asset library that the add-on brings along: grains, materials, and nodes that strew them, with pictures. Run
# it with the oldest Blender served, so that every later one can open it:
#   blender -b --factory-startup --python-exit-code 1 --python blend_files/make_assets.py [-- FOLDER]
import pathlib
import sys
import tempfile

import bpy
import numpy as np
from mathutils import Vector

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "addon")]

import make_blend_files as scenes  # noqa: E402
import scatter_nodes  # noqa: E402

CATALOGS = "blender_assets.cats.txt"
# Of the Asset Browser's tree; numbers that nobody else has.
FOLDERS = {
    "Grains": "5c1f3cde-6c0b-4a9e-9d0e-3b5d7a1f4e01",
    "Grains/Many": "5c1f3cde-6c0b-4a9e-9d0e-3b5d7a1f4e02",
    "Materials": "5c1f3cde-6c0b-4a9e-9d0e-3b5d7a1f4e03",
    "Materials/Measured": "5c1f3cde-6c0b-4a9e-9d0e-3b5d7a1f4e04",
    "Geometry Nodes": "5c1f3cde-6c0b-4a9e-9d0e-3b5d7a1f4e05",
}
# How many shapes a collection of many has: beads are all alike.
SHAPES = {"bead": 1}
SIDE, SAMPLES = 80, 16  # of a picture, in pixels and for each
SEGMENTS, SEGMENTS_OF_MANY = 16, 8


def title(kind):
    return kind.replace("_", " ").title()


def mark(thing, folder, sentence, tags=()):
    from mesograin.ui.asset_library import KEY

    thing.asset_mark()
    thing[KEY] = thing.name
    thing.asset_data.catalog_id = FOLDERS[folder]
    thing.asset_data.description = sentence
    thing.asset_data.author = "Mesograin"
    for tag in ("grain", *tags):
        thing.asset_data.tags.new(tag, skip_if_exists=True)


def make_materials():
    """{identifier: bpy.types.Material} of every preset."""
    from mesograin.schema import presets as known
    from mesograin.ui import presets

    made = {}
    for group in known.GROUPS:
        for preset in group.presets:
            material = bpy.data.materials.new(preset.name)
            material.mesograin.model = "lambert"  # so that the preset chooses the one for translucent ones
            presets.apply(preset, material.mesograin)
            shade = _shade(material)
            material.diffuse_color = (*shade, 1.0)  # what Solid shading shows
            mark(material, "Materials/Measured" if group.measured else "Materials",
                 f"{preset.note + '. ' if preset.note else ''}In 1/mm, {group.source}", ("material",))
            made[preset.identifier] = material
    return made


def _shade(material):
    """The colour of a thick layer."""
    return [min(max(channel, 0.0), 1.0) for channel in material.mesograin_look.colour]


def make_grains():
    """The objects, one for each kind, as Add > Grain makes them: as large as a ball of radius 1."""
    from mesograin.grains import kinds, objects

    made = []
    for kind, shape in kinds.KINDS.items():
        grain = objects.add_grain(kind, name=title(kind), segments=SEGMENTS)
        grain.active_material.name = f"{title(kind)} Grain"
        mark(grain, "Grains", shape.__doc__.split(".")[0].replace("\n   ", "") + "; as large as a ball of radius 1",
             (kind,))
        made.append(grain)
    return made


def make_collections():
    """The collections of shapes to be strewn, by kind."""
    from mesograin.grains import kinds, objects
    from mesograin.ui import asset_library

    made = {}
    for kind in kinds.KINDS:
        made[kind] = bpy.data.collections.new(asset_library.shapes_name(kind))
        for number, shape in enumerate(objects.shapes_of([kind] * SHAPES.get(kind, 3), segments=SEGMENTS_OF_MANY)):
            shape.name = shape.data.name = f"{title(kind)} {number + 1}"
            made[kind].objects.link(shape)
        [material] = {shape.active_material for shape in made[kind].objects}
        material.name = f"Strewn {title(kind)}"
        material.mesograin_colours.vary = True
        material.mesograin_colours.source = "ATTRIBUTE"
        material.mesograin_colours.colour_attribute = scatter_nodes.COLOUR
        mark(made[kind], "Grains/Many", "Shapes for Scatter Grains, whose material takes each grain's colour",
             (kind, "scatter"))
    return made


def _darken_below(world):
    """Dark below and bright above: what is clear turns that over, and would be unseen before a world that is even."""
    world.use_nodes = True
    tree = world.node_tree
    places, axes = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeSeparateXYZ")
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[0].position = (0.1, 0.105, 0.115, 1.0), 0.0
    ramp.color_ramp.elements[1].color, ramp.color_ramp.elements[1].position = (0.6, 0.63, 0.69, 1.0), 0.6
    half = tree.nodes.new("ShaderNodeMath")
    half.operation = "MULTIPLY_ADD"
    half.inputs[1].default_value = half.inputs[2].default_value = 0.5
    tree.links.new(places.outputs["Generated"], axes.inputs[0])
    tree.links.new(axes.outputs["Z"], half.inputs[0])
    tree.links.new(half.outputs[0], ramp.inputs[0])
    tree.links.new(ramp.outputs[0], tree.nodes["Background"].inputs["Color"])


class Photographer:
    """Renders a picture of what is put before it, and gives it to an asset as its preview."""

    def __init__(self, folder):
        self.path = str(folder / "preview.png")
        scene = self.scene = bpy.context.scene
        scene.render.engine = "MESOGRAIN"
        scene.render.resolution_x = scene.render.resolution_y = SIDE
        scene.render.image_settings.file_format = "PNG"
        scene.render.image_settings.color_depth = "8"
        scene.render.filepath = self.path
        scene.mesograin.samples = SAMPLES
        scenes.lit_world(scene, (0.2, 0.21, 0.23))
        _darken_below(scene.world)
        scenes.add_sun("Key", (1.0, -0.7, 1.4), 1.8)
        scenes.add_sun("Rim", (-1.0, 1.2, 0.5), 1.2)

    def look(self, radius):
        scenes.look_from(Vector((0.35, -1.0, 0.55)).normalized() * 5.2 * radius, (0.0, 0.0, 0.0), 25.0)

    def take(self, asset, things, radius):
        for thing in things:
            self.scene.collection.objects.link(thing)
        self.look(radius)
        bpy.ops.render.render(write_still=True)
        picture = bpy.data.images.load(self.path)
        preview = asset.preview_ensure()
        preview.image_size = (SIDE, SIDE)
        pixels = np.array(picture.pixels[:], dtype=np.float32).reshape(-1, 4)
        pixels = np.round(63.0 * pixels) / 63.0  # which a packed file is a third smaller by
        preview.image_pixels_float.foreach_set(pixels.ravel())
        bpy.data.images.remove(picture)
        camera = self.scene.camera
        for thing in things:
            self.scene.collection.objects.unlink(thing)
        bpy.data.cameras.remove(camera.data)


def photograph(folder, grains, materials, many, scatter):
    photographer = Photographer(folder)
    for grain in grains:
        photographer.take(grain, [grain], 1.25)
    ball = bpy.data.objects.new("Ball", scenes.sphere_mesh(1.0, 64, 32))
    ball.data.materials.append(None)
    for material in materials.values():
        ball.data.materials[0] = material
        photographer.take(material, [ball], 1.0)
    for collection in many.values():
        shapes = list(collection.objects)
        for number, shape in enumerate(shapes):
            shape.location = (2.1 * (number - 0.5 * (len(shapes) - 1)), 0.0, 0.0)
        photographer.take(collection, shapes, 0.9 + 1.1 * (len(shapes) - 1))
        for shape in shapes:
            shape.location = (0.0, 0.0, 0.0)
    mesh = bpy.data.meshes.new("Ground")
    mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(scenes.plain_material("Ground", (0.35, 0.33, 0.3)))
    ground = bpy.data.objects.new("Ground", mesh)
    modifier = ground.modifiers.new("Scatter", "NODES")
    modifier.node_group = scatter
    modifier[scatter.inputs["Size"].identifier] = 0.1
    photographer.scene.mesograin.millimetres_per_unit = 8.0
    photographer.take(scatter, [ground], 1.3)


def main():
    import addon_utils

    addon_utils.enable("mesograin")
    from mesograin.ui import asset_library

    chosen = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [asset_library.FOLDER]
    folder = pathlib.Path(chosen[0])
    folder.mkdir(parents=True, exist_ok=True)
    scenes.empty_file()
    materials = make_materials()
    grains, many = make_grains(), make_collections()
    scatter = scatter_nodes.make(asset_library.SCATTER, many["sand"])
    mark(scatter, "Geometry Nodes", "Strews grains over a surface: density, size, turn, and a colour for each",
         ("scatter",))
    with tempfile.TemporaryDirectory() as temporary:
        photograph(pathlib.Path(temporary), grains, materials, many, scatter)
    assets = [*grains, *materials.values(), *many.values(), scatter]
    path = folder / asset_library.FILE.name
    # Nothing but these and what they need: no scene, light or camera.
    bpy.data.libraries.write(str(path), set(assets), fake_user=True, compress=True)
    lines = ["# Folders of Mesograin's assets in the Asset Browser.", "VERSION 1", ""]
    lines += [f"{number}:Mesograin/{name}:Mesograin-{name.replace('/', '-')}" for name, number in FOLDERS.items()]
    (folder / CATALOGS).write_text("\n".join(lines) + "\n")
    print(f"{path}: {len(assets)} assets, {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
