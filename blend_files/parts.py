# What the scripts that make scenes share; run in Blender.
import bpy
import numpy as np
from mathutils import Matrix


def begin(size):
    """An empty scene of a file that is to be saved, for pictures of this size by Mesograin."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.context.preferences.filepaths.save_version = 0
    scene = bpy.context.scene
    scene.render.engine = "MESOGRAIN"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    return scene


def surround(tree, background, name, picture):
    """Makes a picture of all around, (height, width, 3), row 0 below, what a world's Background node shines with."""
    height, width = picture.shape[:2]
    pixels = np.ones((height, width, 4), dtype=np.float32)
    pixels[..., :3] = picture
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])


def add_object(name, data, matrix=Matrix()):
    new = bpy.data.objects.new(name, data)
    new.matrix_world = matrix
    bpy.context.scene.collection.objects.link(new)
    return new


def plain_material(name, colour, shader="ShaderNodeBsdfDiffuse"):
    """Of Blender's own nodes: a surface that is no grain."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    output, surface = nodes.new("ShaderNodeOutputMaterial"), nodes.new(shader)
    surface.inputs["Color"].default_value = (*colour, 1.0)
    material.node_tree.links.new(surface.outputs[0], output.inputs["Surface"])
    material.diffuse_color = (*colour, 1.0)
    return material


def add_ground(half, material):
    corners = [(-half, -half, 0.0), (half, -half, 0.0), (half, half, 0.0), (-half, half, 0.0)]
    ground = bpy.data.meshes.new("Ground")
    ground.from_pydata(corners, [], [(0, 1, 2, 3)])
    ground.uv_layers.new(name="UVMap").data.foreach_set("uv", [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0])
    ground.materials.append(material)
    return add_object("Ground", ground)


def pixels_of(path):
    """(h, w, channels) of a picture as it is stored, row 0 at the bottom."""
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, -1)


def blocks(picture, side):
    """Means of blocks of (h, w, channels), row by row."""
    height, width = picture.shape[:2]
    return picture.astype(np.float64).reshape(height // side, side, width // side, side, -1).mean(axis=(1, 3))


def save_beside(path, pictures, quality):
    """A JPEG of pictures, (h, w, 3) of 0 to 1 as they look, side by side."""
    gap = np.ones((pictures[0].shape[0], 6, 3), dtype=np.float32)
    joined = np.concatenate([part for picture in pictures for part in (picture, gap)][:-1], axis=1)
    height, width = joined.shape[:2]
    image = bpy.data.images.new(path.stem, width, height)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(np.concatenate((joined, np.ones((height, width, 1))), axis=-1).astype(np.float32).ravel())
    image.filepath_raw, image.file_format = str(path), "JPEG"
    bpy.context.scene.render.image_settings.quality = quality
    image.save()
