"""What is dragged in drag_in_window.py: one grain, or a heap of them. Runs in Blender."""
import dataclasses
import math
import pathlib
import sys

import bpy
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
BLEND_FILES = HERE.parents[1] / "blend_files"
sys.path.insert(0, str(BLEND_FILES))

import parts  # noqa: E402

GRAINS = 10000
SIZE = 0.05  # radius of the mean one
MEAN_FREE_PATHS = 3.0  # to such a radius
ALBEDO = 0.9
MILLIMETRES_PER_UNIT = 10.0
SEGMENTS = 6  # of a grain's shape: its 10^4 are to be what Blender draws in Solid within a second without a GPU
HEIGHT = 30.0  # degrees above the horizon, of who looks at the heap


@dataclasses.dataclass(frozen=True)
class Stage:
    """A scene that is open. absorption: sigma_a about which its colour is dragged; distance, rotation, middle: of the
    view, whose rotation None leaves as Blender begins; axis: about which a script turns it."""

    material: bpy.types.Material
    absorption: float
    distance: float
    axis: tuple
    rotation: tuple = None
    middle: tuple = (0.0, 0.0, 0.0)


def _open(name):
    bpy.ops.wm.open_mainfile(filepath=str(BLEND_FILES / f"{name}.blend"), load_ui=False)


def sphere():
    """A grain alone."""
    _open("sphere")
    return Stage(bpy.data.materials["Translucent"], 0.1, 7.0, (0.0, 1.0, 0.0))


def heap():
    """GRAINS of sand as Add > Grain > Pile lets them fall, on a ground, in an image of a sky with a sun in it."""
    from mesograin.grains import objects

    _open("sphere")
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene = bpy.context.scene
    scene.mesograin.millimetres_per_unit = MILLIMETRES_PER_UNIT
    pile = objects.pile_of(3 * ["sand"], GRAINS, SIZE, segments=SEGMENTS)
    scene.collection.objects.link(pile)
    sand = pile.data.materials[0]
    extinction = MEAN_FREE_PATHS / (SIZE * MILLIMETRES_PER_UNIT)
    absorption = (1.0 - ALBEDO) * extinction
    sand.mesograin.boundary = "index_matched"
    sand.mesograin.sigma_a, sand.mesograin.sigma_s = (absorption,) * 3, (ALBEDO * extinction,) * 3
    places = np.array([vertex.co for vertex in pile.data.vertices])
    parts.add_ground(10.0 * np.abs(places).max(), parts.plain_material("Ground", (0.42, 0.36, 0.3)))
    _shine(scene)
    reach, top = np.percentile(np.hypot(*places[:, :2].T), 90.0), places[:, 2].max()
    tilt = math.radians(90.0 - HEIGHT) / 2.0
    return Stage(sand, absorption, 2.4 * reach, (0.0, 0.0, 1.0), (math.cos(tilt), math.sin(tilt), 0.0, 0.0),
                 (0.0, 0.0, 0.4 * top))


def _shine(scene):
    """An image of a sky, brighter towards the horizon, and of a sun five degrees wide in it."""
    around, rise = np.meshgrid((np.arange(256) + 0.5) / 256 * 2.0 * math.pi,
                               ((np.arange(128) + 0.5) / 128 - 0.5) * math.pi)
    up = np.maximum(np.sin(rise), 0.0)[..., None]
    sky = np.where(up > 0.0, np.array((0.7, 0.75, 0.8)) - up * np.array((0.45, 0.35, 0.2)), np.array((0.2, 0.18, 0.15)))
    towards = math.radians(-50.0), math.radians(45.0)
    cosine = np.sin(rise) * math.sin(towards[1]) + np.cos(rise) * math.cos(towards[1]) * np.cos(around - towards[0])
    half = math.radians(2.5)
    sun = (cosine > math.cos(half))[..., None] * np.array((1.0, 0.95, 0.88)) * 3.0 / (math.pi * math.sin(half) ** 2)
    world = scene.world = bpy.data.worlds.new("Sky")
    world.use_nodes = True
    node = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    parts.surround(world.node_tree, node, "Sky", sky + sun)


SCENES = {"sphere": sphere, "heap": heap}
