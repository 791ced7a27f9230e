# A scene of its own for each reference, copied from the evaluated one, so that the user's scene is never touched.
"""See `Stage`."""

import addon_utils
import bpy
import numpy
from mathutils import Matrix

from ..scene import export, lights, meshes, surroundings
from . import instancing, lighting, settings, shading


class StageError(Exception):
    """The scene cannot be rendered; one sentence."""


def need_cycles():
    """Raises StageError if this Blender has no Cycles."""
    if not hasattr(bpy.types.Scene, "cycles") and addon_utils.enable("cycles") is None:
        raise StageError("Cycles is needed for the references, but this Blender has none: enable its add-on.")


class Stage:
    """A context manager that holds a new scene: a depsgraph's meshes, lights, world and camera.

    depsgraph: evaluated; copied from, never kept. description: `settings.settings(...)`.
    build_material: makes the new Cycles material for a bpy.types.Material in use, or for None (faces without one).
    apart: the name of an object whose first instance is an object here, too, in `placed`: {name: that object}.
    world: surroundings.WorldValues.
    heaps: of `instancing.Heap`, the placings of meshes that have many.
    least_sun: radians; narrower suns are widened to this, of the same irradiance.
    Everything made here is removed on exit, whatever happened inside.
    """

    def __init__(self, depsgraph, description, build_material, least_sun=0.0, apart=None):
        self._depsgraph = depsgraph
        self._description = description
        self._build_material = build_material
        self._least_sun = least_sun
        self._apart = apart
        self._made = []
        self._materials = {}
        self._meshes = {}
        self._placings = {}  # {name of a mesh here: (it, its matrices)}
        self.placed = {}
        self.heaps = []

    def __enter__(self):
        try:
            self.scene = self._own(bpy.data.scenes.new("Mesograin reference"))
            self.world, _ = surroundings.read(self._depsgraph.scene, layer=self._depsgraph.view_layer)
            self.scene.world = self._own(bpy.data.worlds.new("Mesograin world"))
            image = lighting.fill_world(self.scene.world, self.world)
            if image is not None:
                self._own(image)
            settings.apply(self.scene, self._description)
            self._copy_camera()
            self._copy_instances()
        except BaseException:
            self._remove()
            raise
        return self

    def __exit__(self, *_):
        self._remove()

    def _own(self, datablock):
        self._made.append(datablock)
        return datablock

    def _remove(self):
        bpy.data.batch_remove(reversed(self._made))
        self._made.clear()

    def _add(self, name, data, matrix):
        made = self._own(bpy.data.objects.new(name, data))
        made.matrix_world = matrix
        self.scene.collection.objects.link(made)
        return made

    def _copy_camera(self):
        source = self._depsgraph.scene_eval.camera
        if source is None:
            raise StageError("The scene has no camera: add one, or choose one in the scene's properties.")
        if source.type != "CAMERA" or source.data.type == "PANO":
            is_what = "is panoramic" if source.type == "CAMERA" else f"is {export.named(source.type)}"
            raise StageError(f"A comparison needs a perspective or orthographic camera, and '{source.name}' {is_what}: "
                             "choose another in the scene's properties.")
        camera = self._own(bpy.data.cameras.new("Mesograin camera"))
        for name in CAMERA_PROPERTIES:
            setattr(camera, name, getattr(source.data, name))
        self.scene.camera = self._add("Mesograin camera", camera, source.matrix_world)

    def _copy_instances(self):
        for instance in self._depsgraph.object_instances:
            source = instance.object
            if not instance.show_self:
                continue
            if source.type == "LIGHT":
                self._copy_light(source.data, instance.matrix_world)
            elif meshes.is_drawn(source, instance.matrix_world):
                self._copy_shape(source, instance.matrix_world)
        for sun in self.world.suns:
            light, matrix = lighting.add_sun(sun, self._least_sun)
            self._add(light.name, self._own(light), matrix)
        self._place_shapes()
        if not self._meshes:
            raise StageError("The scene has no visible mesh: add a grain, or switch its rendering on.")
        if not self.world.shines and not any(made.type == "LIGHT" for made in self.scene.collection.objects):
            raise StageError("The scene has no visible light, and its world is black: add a light.")

    def _copy_light(self, source, matrix):
        if lights.is_left_out(source):
            return
        light = self._own(lighting.copy_light(source, self._least_sun))
        self._add(light.name, light, matrix)

    def _copy_shape(self, source, matrix):
        materials = [slot.material.original if slot.material else None for slot in source.material_slots] or [None]
        # The address of the geometry, because an instance's object may be a passing one.
        key = (source.data.as_pointer(), tuple(material and material.name_full for material in materials))
        mesh = self._meshes.get(key)
        if mesh is None:
            mesh = bpy.data.meshes.new_from_object(source, preserve_all_data_layers=True, depsgraph=self._depsgraph)
            if mesh is None:
                return
            self._own(mesh)
            if not mesh.polygons:
                return
            self._meshes[key] = mesh
            shading.shade_alike(mesh)
            mesh.materials.clear()
            for material in materials:
                mesh.materials.append(self._material(material))
        if source.name == self._apart and self._apart not in self.placed:
            self.placed[self._apart] = self._add_grain(mesh, matrix)
        else:
            _, placings = self._placings.setdefault(mesh.name, (mesh, []))
            placings.append(matrix[0][:] + matrix[1][:] + matrix[2][:] + matrix[3][:])

    def _place_shapes(self):
        for mesh, rows in self._placings.values():
            matrices = numpy.array(rows).reshape(-1, 4, 4)
            plain = instancing.expressible(matrices)
            if plain.sum() >= instancing.FROM:
                self._add_heap(mesh, matrices[plain])
                matrices = matrices[~plain]
            for matrix in matrices:
                self._add_grain(mesh, Matrix(matrix))

    def _add_heap(self, mesh, matrices):
        heap = instancing.Heap(mesh, matrices, self._own)
        self.scene.collection.objects.link(heap.object)
        _keep_shadows_smooth(heap.object)
        self.heaps.append(heap)

    def _add_grain(self, mesh, matrix):
        made = self._add("Mesograin grain", mesh, matrix)
        if not instancing.expressible([matrix]).all():
            # An object has no shear of its own, but what it inherits from a parent may have.
            made.parent = self._add("Mesograin parent", None, Matrix())
            made.matrix_parent_inverse, made.matrix_basis = matrix, Matrix()
            self.scene.view_layers[0].update()
        _keep_shadows_smooth(made)
        return made

    def _material(self, source):
        key = source.name_full if source else None
        if key not in self._materials:
            self._materials[key] = self._own(self._build_material(source))
        return self._materials[key]


def _keep_shadows_smooth(made):
    """The smooth normals are ours and theirs; the facets' shadow on themselves is nobody's."""
    made.cycles.shadow_terminator_offset = 0.0
    made.cycles.shadow_terminator_geometry_offset = 0.1


CAMERA_PROPERTIES = (
    "type",
    "lens",
    "sensor_width",
    "sensor_height",
    "sensor_fit",
    "shift_x",
    "shift_y",
    "clip_start",
    "clip_end",
    "ortho_scale",
)
