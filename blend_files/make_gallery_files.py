# Makes gallery/*.blend, the scenes of docs/gallery.md: heaps as artists pour them, and single grains on a table. Run it
# with the oldest Blender served:
#   blender -b --factory-startup --python-exit-code 1 --python blend_files/make_gallery_files.py [-- FOLDER [NAME ...]]
import dataclasses
import math
import pathlib
import sys

import bpy
import numpy as np
from mathutils import Matrix, Vector

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "addon")]

import parts  # noqa: E402

FOLDER = HERE / "gallery"
SIZE = (240, 180)
OUR_SAMPLES = 8


@dataclasses.dataclass(frozen=True)
class Heap:
    """One picture. grains: (kind of shape, preset, changes of it) of each shape; count of grains and their radius in
    mm. ground: its colour. light: a function of a scene. samples: of Cycles' for each of SEEDS. glass: its colour, of a
    jar that they are in."""

    name: str
    sentence: str
    grains: tuple
    count: int
    radius: float
    ground: tuple
    light: object
    samples: int
    roundness: float = 0.3
    segments: int = 10
    glass: tuple = ()

    @property
    def reference(self):
        """What Cycles' grains are made of."""
        refracts = any(changes.get("boundary") != "index_matched" and preset != "snow" for _, preset, changes in
                       self.grains if changes.get("model") != "lambert")
        return "glass with a volume" if refracts else "index-matched volume"


# Light

def sun(irradiance, colour, height, around, wide):
    """height above the horizon, around it, and width: degrees."""
    light = bpy.data.lights.new("Sun", "SUN")
    light.energy, light.color, light.angle = irradiance, colour, math.radians(wide)
    rise, turn = math.radians(height), math.radians(around)
    towards = Vector((math.cos(rise) * math.cos(turn), math.cos(rise) * math.sin(turn), math.sin(rise)))
    parts.add_object("Sun", light, towards.to_track_quat("Z", "Y").to_matrix().to_4x4())


def background():
    """The node of a new world, and its tree."""
    world = bpy.context.scene.world = bpy.data.worlds.new("Sky")
    world.use_nodes = True
    tree = world.node_tree
    return next(node for node in tree.nodes if node.type == "BACKGROUND"), tree


def sky(colour):
    background()[0].inputs["Color"].default_value = (*colour, 1.0)


def noon():
    """A sun as wide as it is, and a blue sky."""
    sun(3.2, (1.0, 0.95, 0.88), 48.0, -35.0, 0.53)
    sky((0.28, 0.38, 0.55))


def evening():
    sun(3.0, (1.0, 0.78, 0.55), 17.0, -15.0, 0.53)
    sky((0.25, 0.33, 0.5))


def angles(width, height):
    """Of each pixel of a picture of all around, in degrees: about the way up, from the way right of its middle on, and
    above the horizon; each (height, width)."""
    return np.meshgrid((np.arange(width) + 0.5) / width * 360.0 - 180.0,
                       (np.arange(height) + 0.5) / height * 180.0 - 90.0)


def surround(image):
    """Makes a picture of all around, (height, width, 3), row 0 below, the world."""
    node, tree = background()
    parts.surround(tree, node, "Room", image)


def soft():
    """A sun behind a thin cloud, 40 degrees wide, and a bright sky."""
    around, rise = np.radians(angles(512, 256))
    middle = np.radians((-40.0, 50.0))
    # Cycles turns pictures of all around from -x over -y.
    cosine = np.sin(rise) * np.sin(middle[1]) + np.cos(rise) * np.cos(middle[1]) * np.cos(-around - middle[0])
    half = math.radians(20.0)
    sun_radiance = np.array((1.0, 0.96, 0.9)) * 2.6 / (math.pi * math.sin(half) ** 2)
    surround((cosine > math.cos(half))[..., None] * sun_radiance + np.array((0.42, 0.48, 0.56)))


def window():
    """A room: a bright window, a dim lamp, a dark floor."""
    turn, rise = angles(256, 128)
    image = np.where(rise[..., None] > 0.0, np.array((0.24, 0.22, 0.2)), np.array((0.1, 0.08, 0.06)))
    panes = (np.abs(turn + 60.0) < 28.0) & (np.abs(rise - 42.0) < 20.0)
    bars = (np.abs(turn + 60.0) < 2.0) | (np.abs(rise - 42.0) < 2.0)
    image = np.where((panes & ~bars)[..., None], np.array((6.5, 7.0, 7.8)), image)
    lamp = np.exp(-(((turn - 110.0) / 14.0) ** 2 + ((rise - 30.0) / 12.0) ** 2))
    surround(image + lamp[..., None] * np.array((5.0, 3.4, 1.8)))


MATCHED = {"boundary": "index_matched"}
WET = {"eta": 1.544 / 1.333, "roughness": 0.05}

HEAPS = (
    Heap("sand", "dry quartz sand at noon", 3 * (("sand", "sand", MATCHED),), 400, 0.5, (0.42, 0.36, 0.3), noon, 8),
    Heap("dune", "the same in the evening", 3 * (("sand", "sand", MATCHED),), 400, 0.5, (0.42, 0.36, 0.3), evening, 8),
    Heap("beach", "sand of many minerals: quartz, feldspar, olivine, magnetite, shell",
         (("sand", "sand", MATCHED), ("sand", "sand", {**MATCHED, "sigma_a": (0.03, 0.08, 0.16)}),
          ("sand", "sand", {**MATCHED, "sigma_a": (0.08, 0.45, 0.9), "sigma_s": (1.4, 1.4, 1.4)}),
          ("sand", "sand", {**MATCHED, "sigma_a": (0.5, 0.16, 0.7)}),
          ("sand", "sand", {"model": "lambert", "reflectance": (0.05, 0.045, 0.045)}),
          ("sand", "rice", {**MATCHED, "sigma_s": (4.0, 4.0, 4.0)})), 400, 0.5, (0.42, 0.36, 0.3), noon, 8),
    Heap("snow", "clumps of snow under a low sun", 3 * (("rounded_snow", "snow", {}),), 300, 6.0, (0.25, 0.25, 0.26),
         evening, 8),
    Heap("dry_sand", "the sand with its surface, under a thin cloud", 3 * (("sand", "sand", {}),), 400, 0.5,
         (0.42, 0.36, 0.3), soft, 64),
    Heap("wet_sand", "wet quartz sand under a thin cloud", 3 * (("sand", "sand", WET),), 400, 0.5, (0.25, 0.21, 0.17),
         soft, 64),
    Heap("salt", "table salt under a thin cloud", 3 * (("salt", "salt", {}),), 400, 0.25, (0.1, 0.12, 0.16), soft, 64,
         roundness=0.15),
    Heap("sugar", "sugar by a window", 3 * (("sugar", "sugar", {}),), 300, 0.4, (0.2, 0.11, 0.06), window, 64),
    Heap("jar", "sugar in a jar by a window", 3 * (("sugar", "sugar", {}),), 500, 0.4, (0.2, 0.11, 0.06), window, 64,
         glass=(1.0, 1.0, 1.0)),
    Heap("green_jar", "sand in a green jar under a thin cloud", 3 * (("sand", "sand", MATCHED),), 500, 0.5,
         (0.42, 0.36, 0.3), soft, 64, glass=(0.75, 0.93, 0.8)),
)


# Scenes

JAR = (0.7, 1.5, 0.06)
"""Inner radius, height and thickness of its glass, in Blender units."""


def jar(colour):
    """A jar of glass, round at its edges; smooth all over, as a closed surface without sharp edges may be."""
    radius, height, thick = JAR
    rounds = np.linspace(0.0, 0.5 * math.pi, 6)
    foot, inside, rim = 1.5 * thick, 2.5 * thick, 0.5 * thick
    bottom = [(radius + thick - foot * (1.0 - math.sin(t)), foot * (1.0 - math.cos(t))) for t in rounds]
    top = [(radius + rim + rim * math.cos(t), height - rim + rim * math.sin(t)) for t in 2.0 * rounds]
    floor = [(radius - inside * (1.0 - math.cos(t)), thick + inside * (1.0 - math.sin(t))) for t in rounds]
    around = np.linspace(0.0, 2.0 * math.pi, 96, endpoint=False)
    rings = [(r * math.cos(a), r * math.sin(a), z) for r, z in (*bottom, *top, *floor) for a in around]
    count = len(around)
    faces = [(count * ring + side, count * ring + (side + 1) % count, count * (ring + 1) + (side + 1) % count,
              count * (ring + 1) + side) for ring in range(len(rings) // count - 1) for side in range(count)]
    ends = tuple(range(count))
    faces += [ends[::-1], tuple(len(rings) - count + end for end in ends)]
    mesh = bpy.data.meshes.new("Jar")
    mesh.from_pydata(rings, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    mesh.materials.append(parts.plain_material("Glass", colour, "ShaderNodeBsdfGlass"))
    return parts.add_object("Jar", mesh, Matrix.Translation((0.0, 0.0, 1e-3)))


def surface_of(thing):
    """What grains fall into."""
    from mesograin.grains import pile

    mesh = thing.data
    mesh.calc_loop_triangles()
    places = np.array([thing.matrix_world @ vertex.co for vertex in mesh.vertices])
    return pile.Surface(places, np.array([each.vertices for each in mesh.loop_triangles]))


def grain_material(preset, changes, millimetres_per_unit):
    """A grain, and Cycles' nodes that mean the same."""
    from mesograin.schema import models, presets
    from mesograin.ui import conversion
    from mesograin.ui.presets import apply

    material = bpy.data.materials.new(preset.capitalize())
    material.mesograin.model = models.PREFERRED
    apply(presets.BY_IDENTIFIER[preset], material.mesograin)
    for name, value in changes.items():
        setattr(material.mesograin, name, value)
    conversion.to_cycles(material, millimetres_per_unit)
    return material


def pour(heap):
    """The scene of a Heap: a Blender unit is ten radii of a grain."""
    from mesograin.grains import kinds, objects, pile

    scene = parts.begin(SIZE)
    scene.view_settings.view_transform = "Standard"
    size = 0.1
    scene.mesograin.millimetres_per_unit = heap.radius / size
    scene.mesograin.samples = OUR_SAMPLES
    shapes, known = [], {}
    for number, (kind, preset, changes) in enumerate(heap.grains):
        data = objects.mesh(kind, seed=number, segments=heap.segments, roundness=heap.roundness)
        key = (preset, str(changes))
        known[key] = known.get(key) or grain_material(preset, changes, scene.mesograin.millimetres_per_unit)
        data.materials.append(known[key])
        shapes.append(bpy.data.objects.new(data.name, data))
    fallen = [kinds.make(kind, seed=number, segments=heap.segments, roundness=heap.roundness)
              for number, (kind, _preset, _changes) in enumerate(heap.grains)]
    vessel = jar(heap.glass) if heap.glass else None
    placings = pile.settle(fallen, heap.count, size, seed=1, surface=vessel and surface_of(vessel))
    scene.collection.objects.link(objects.add_pile(placings, shapes, "Heap"))
    parts.add_ground(40.0, parts.plain_material("Ground", heap.ground))
    heap.light()
    reach = float(np.percentile(np.hypot(*placings.middles[:, :2].T), 90.0))
    top = float(placings.middles[:, 2].max())
    if vessel:
        reach, top = 1.1 * JAR[1], JAR[1]
    look_at(reach, top)


def look_at(reach, top):
    """The pile fills the picture."""
    camera = bpy.data.cameras.new("Camera")
    camera.lens = 70.0
    at = Vector((0.0, 0.0, 0.42 * top))
    away = Vector((0.0, -math.cos(math.radians(32.0)), math.sin(math.radians(32.0))))
    place = at + 3.4 * reach * away
    bpy.context.scene.camera = parts.add_object(
        "Camera", camera, Matrix.Translation(place) @ away.to_track_quat("Z", "Y").to_matrix().to_4x4())


# One grain on a table

CLEAR = {"sigma_s": (0.0,) * 3, "roughness": 0.0}


@dataclasses.dataclass(frozen=True)
class Crystal:
    """A grain, in words and as a Heap has it, and its light, in words and as a function."""

    name: str
    sentence: str
    grain: tuple
    light: object
    lit: str

    @property
    def heap(self):
        """The scene it is, of one grain."""
        kind, preset, changes = self.grain
        return Heap(self.name, self.sentence, ((kind, preset, {**changes, "model": "auto"}),), 1, 0.3,
                    (0.45, 0.2, 0.11), self.light, 96, roundness=0.15)


CRYSTALS = tuple(
    Crystal(f"{name}_{light.__name__}", sentence, grain, light, lit)
    for light, lit in ((window, "a room with a window"), (soft, "a sun behind a thin cloud"))
    for name, sentence, grain in (("salt_crystal", "salt", ("salt", "salt", {})),
                                  ("sugar_crystal", "sugar", ("sugar", "sugar", {})),
                                  ("salt_bead", "a bead of salt", ("bead", "salt", {})),
                                  ("clear_crystal", "clear, smooth salt", ("salt", "salt", CLEAR))))


def set_on_table(crystal):
    """The scene of a Crystal: its grain in the middle, near the camera."""
    pour(crystal.heap)
    bpy.context.scene.mesograin.samples = 4 * OUR_SAMPLES
    instances = bpy.context.evaluated_depsgraph_get().object_instances
    place = next(each.matrix_world.translation.copy() for each in instances if each.is_instance)
    bpy.data.objects["Heap"].location.xy -= place.xy
    bpy.data.objects.remove(bpy.context.scene.camera)
    look_at(0.2, 0.22)


def main():
    import addon_utils

    addon_utils.enable("mesograin", default_set=True)
    folder, *asked = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [FOLDER]
    for make, scenes in ((pour, HEAPS), (set_on_table, CRYSTALS)):
        for scene in scenes:
            if not asked or scene.name in asked:
                make(scene)
                bpy.ops.wm.save_as_mainfile(filepath=str(pathlib.Path(folder, f"{scene.name}.blend")), compress=True)


if __name__ == "__main__":
    main()
