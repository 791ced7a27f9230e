# Which objects and materials cover each pixel, for indices and Cryptomatte: a picture whose things shine by numbers.
import dataclasses
import json
import typing

import numpy as np

from .. import native_module
from ..scene import export, plain_materials, surroundings

SAMPLES = 16
"""Of each pixel: edges are known to a sixteenth."""


class Things(typing.NamedTuple):
    """names: [(object's name, material's name)], from number 1 on. scene: native.Scene in which each shines by it."""

    names: list
    scene: object


def things_of(values):
    """Things of an export.SceneValues."""
    numbers = {}

    def shining(drawn):
        name = drawn.name, drawn.material.name
        number = float(numbers.setdefault(name, len(numbers) + 1))
        material = export.MaterialValues(
            drawn.material.name, (("model", "lambert"), ("profile", "half_space"), ("reflectance", (0.0, 0.0, 0.0))),
            plain_materials.FinishValues((("radiance", (number, number, number)),)))
        changes = {"factors": ()} if hasattr(drawn, "factors") else {}
        return dataclasses.replace(drawn, material=material, **changes)

    scene = dataclasses.replace(
        values, instances=tuple(map(shining, values.instances)), heaps=tuple(map(shining, values.heaps)), lights=(),
        world=surroundings.WorldValues(), exchange="off")
    return Things(list(numbers), scene.to_native())


def seen(things, camera, width, height):
    """(SAMPLES, h, w) int32 with row 0 at the top: the number of what each sample sees, 0 for nothing."""
    view = native_module.get().View(width, height)
    view.set_scene(things.scene)
    view.set_camera(camera)
    found = np.empty((SAMPLES, height, width), dtype=np.int32)
    before = np.zeros((height, width))
    for sample in range(SAMPLES):
        view.render(1)
        # The mean of whole numbers, whose sum floats hold exactly.
        total = np.rint(view.read()[..., 0].astype(np.float64) * (sample + 1))
        found[sample], before = total - before, total
    return found


def ranked(found, groups, ranks):
    """(ids, shares), (ranks, h, w) each: which groups cover a pixel, those that cover most first. groups: the group,
    from 1 on, of each number from 0 on, which is in group 0: nothing. Where there are fewer, id and share are 0."""
    grouped = np.sort(groups[found], axis=0)
    # Runs of the same group, each told by where it starts.
    starts = np.concatenate((np.ones((1, *grouped.shape[1:]), dtype=bool), grouped[1:] != grouped[:-1]))
    run = np.cumsum(starts, axis=0) - 1
    counts = np.zeros(grouped.shape, dtype=np.int32)
    ids = np.zeros(grouped.shape, dtype=np.int32)
    rows, columns = np.indices(grouped.shape[1:])
    for sample in range(len(grouped)):
        counts[run[sample], rows, columns] += 1
        ids[run[sample], rows, columns] = grouped[sample]
    counts[ids == 0] = 0
    order = np.argsort(-counts, axis=0, kind="stable")[:ranks]
    counts = np.take_along_axis(counts, order, axis=0)
    ids = np.where(counts > 0, np.take_along_axis(ids, order, axis=0), 0)
    missing = ranks - len(ids)
    if missing > 0:
        ids, counts = (np.pad(each, ((0, missing), (0, 0), (0, 0))) for each in (ids, counts))
    return ids, counts.astype(np.float32) / len(grouped)


def hash_of(name):
    """The 32 bits that stand for a name: MurmurHash3_x86_32 of Austin Appleby, seed 0, as Cryptomatte 1.2 asks."""
    data = name.encode("utf-8")
    whole = len(data) // 4 * 4
    bits = 0
    for start in range(0, whole, 4):
        bits ^= _scrambled(int.from_bytes(data[start:start + 4], "little"))
        bits = (_rotated(bits, 13) * 5 + 0xE6546B64) & 0xFFFFFFFF
    if whole < len(data):
        bits ^= _scrambled(int.from_bytes(data[whole:], "little"))
    bits ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        bits = ((bits ^ (bits >> shift)) * factor) & 0xFFFFFFFF
    return bits ^ (bits >> 16)


def _scrambled(block):
    return (_rotated(block * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593) & 0xFFFFFFFF


def _rotated(bits, by):
    return (bits << by | bits >> (32 - by)) & 0xFFFFFFFF


def id_of(name):
    """The float that stands for a name, never a denormal, an infinity or no number (Cryptomatte 1.2.0)."""
    bits = hash_of(name)
    exponent = bits >> 23 & 0xFF
    if exponent in (0, 0xFF):
        bits ^= 1 << 23
    return np.array(bits, dtype=np.uint32).view(np.float32)[()]


def manifest(names):
    """JSON of {name: 8 hexadecimal digits of its float}."""
    return json.dumps({name: f"{int(id_of(name).view(np.uint32)):08x}" for name in names}, ensure_ascii=False,
                      separators=(",", ":"))
