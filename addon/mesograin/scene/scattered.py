# What geometry nodes scatter, as the instancer tells it: all its placings at once, without one Python object for each.
import dataclasses

import bpy
import numpy as np

from .. import compat


@dataclasses.dataclass(frozen=True)
class Shown:
    """One evaluated object of a dependency graph. shapes: the evaluated objects that its geometry nodes put somewhere;
    of_instance: (n,) int32, which of these each is; placings: (n, 4, 4) float32, row by row, to the world."""

    thing: bpy.types.Object
    shapes: tuple = ()
    of_instance: np.ndarray | None = None
    placings: np.ndarray | None = None

    def placings_of(self):
        """{shape: its placings}, in the order in which they come."""
        of_instance = self.of_instance if self.shapes else ()
        numbers, first = np.unique(of_instance, return_index=True)
        return {self.shapes[number]: self.placings[of_instance == number] for number in numbers[np.argsort(first)]}


def read(depsgraph):
    """A Shown for each object that a dependency graph shows, or None where its instances are to be asked one by one:
    there are none, some are made in another way, or Blender tells no other."""
    if any(_is_hidden_instancer(each, depsgraph.mode) for each in depsgraph.ids):
        return None
    everything = [_read_object(thing) for thing in depsgraph.objects]
    return everything if all(everything) and any(each.shapes for each in everything) else None


def _is_hidden_instancer(datablock, mode):
    """Whether an object is to be seen by what it instances alone; then it is none of a dependency graph's `objects`."""
    if not isinstance(datablock, bpy.types.Object):
        return False
    return not (datablock.show_instancer_for_render if mode == "RENDER" else datablock.show_instancer_for_viewport)


def _read_object(thing):
    """Shown, or None if it instances in another way."""
    if thing.is_instancer or thing.particle_systems:
        return None
    geometry = _geometry(thing)
    cloud = geometry and geometry.instances_pointcloud()
    if cloud is None:
        return Shown(thing)
    shapes = tuple(geometry.instance_references())
    if not all(_is_plain(shape) for shape in shapes):
        return None
    of_instance = np.empty(len(cloud.points), dtype=np.int32)
    cloud.attributes[".reference_index"].data.foreach_get("value", of_instance)
    columns = np.empty((len(cloud.points), 4, 4), dtype=np.float32)
    cloud.attributes["instance_transform"].data.foreach_get("value", columns.ravel())
    to_world = np.array(thing.matrix_world, dtype=np.float32)
    return Shown(thing, shapes, of_instance, to_world @ columns.transpose(0, 2, 1))


def _geometry(thing):
    """What geometry nodes have made of an evaluated object, or None without any."""
    return compat.geometry_set(thing) if any(each.type == "NODES" for each in thing.modifiers) else None


def _is_plain(shape):
    """Whether an instance shows a mesh and nothing else."""
    if not isinstance(shape, bpy.types.Object) or shape.type != "MESH":
        return False
    if shape.is_instancer or shape.particle_systems:
        return False
    geometry = _geometry(shape)
    return geometry is None or geometry.instances_pointcloud() is None
