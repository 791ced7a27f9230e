# The picture of a material in its slot, its tab and the asset browser: our grain on the stage that Blender sets for it.
import dataclasses
import math
import time

from ..scene import automatic
from .grace import POLL_SECONDS

SIZE = 1.0
"""mm, of the grain on the stage where nobody has said how large those of its material are."""
CALM_SECONDS = 0.4
"""So long no viewport must have changed: an artist who drags waits for that one."""
ROUNDS = (2, 14, 48)
"""Samples that come one after the other, each with a picture."""
ICON_SIDE, ICON_ROUNDS = 256, (16,)
"""Pixels of the largest icon; what is seen of it is small."""
STAND_IN = "model_3"
"""For a model that has to be computed for each shape and medium."""
COMPUTED = "transport"

_sizes = {}  # {name of a material: mm}


def note_size(material, millimetres):
    """Notes how large a grain of the material is, that has this name."""
    _sizes[material] = millimetres


def note_sizes(values):
    """Notes how large a grain of each material of an export.SceneValues is."""
    grains = {drawn.material.name: drawn for drawn in (*values.instances, *values.heaps)
              if drawn.material.finish is None}
    for name, drawn in grains.items():
        volume = automatic.shape(drawn.mesh, drawn.typical())[0]
        if volume > 0.0:
            note_size(name, values.millimetres_per_unit * math.cbrt(6.0 / math.pi * volume))


def wait_for_calm(changed, cancelled):
    """changed(): when a viewport was last to show something new, as time.monotonic() has it; cancelled(): whether the
    picture is given up."""
    while time.monotonic() - changed() < CALM_SECONDS and not cancelled():
        time.sleep(POLL_SECONDS)


def rounds(width, height):
    return ICON_ROUNDS if max(width, height) <= ICON_SIDE else ROUNDS


def staged(values, depsgraph):
    """export.SceneValues of Blender's stage as it is drawn: the grain as thick for light as those of its material are,
    by a model that is there at once, and without the floor where that is there for shadows alone."""
    across = {thing.active_material.name: max(thing.dimensions) for thing in depsgraph.objects if thing.active_material}

    def change(material):
        if material.finish is not None:
            return material
        said = dict(material.values)
        longer = _sizes.get(material.name, SIZE) / across[material.name]  # Blender's stage has a unit of 1 mm
        for name in ("sigma_s", "sigma_a"):
            said[name] = tuple(channel * longer for channel in said[name])
        if automatic.asked(material) or said["model"] == COMPUTED:
            said["model"] = STAND_IN
        return dataclasses.replace(material, values=tuple(said.items()))

    shown = tuple(drawn for drawn in values.instances if not drawn.material.name.startswith("FloorHidden"))
    return dataclasses.replace(values, instances=shown, exchange="off").with_materials(change)
