# Which objects and materials cover each pixel, for indices and Cryptomatte, and their albedo, for denoisers: pictures
# whose things shine by numbers.
import contextlib
import dataclasses
import json
import typing

import numpy as np

from .. import native_module
from ..scene import export, plain_materials, surroundings
from ..schema import models
from . import grace

SAMPLES, BLURRED_SAMPLES = 16, 64
"""Of each pixel: edges are known to a sixteenth, blurred ones to a sixty-fourth."""


class Things(typing.NamedTuple):
    """names: [(object's name, material's name)], from number 1 on. scene: native.Scene in which each shines by it."""

    names: list
    scene: object


def things_of(values):
    """Things of an export.SceneValues."""
    numbers = {}

    def number_of(drawn):
        name = drawn.name, drawn.material.name
        number = float(numbers.setdefault(name, len(numbers) + 1))
        return plain_materials.FinishValues((("radiance", (number, number, number)),))

    scene = _shining(values, number_of)
    return Things(list(numbers), scene.to_native())


def _shining(values, finish_of):
    """export.SceneValues whose things do nothing but shine, each with the plain_materials.FinishValues of it."""

    def shining(drawn):
        material = export.MaterialValues(
            drawn.material.name, (("model", "lambert"), ("profile", "half_space"), ("reflectance", (0.0, 0.0, 0.0))),
            finish_of(drawn))
        changes = {"factors": ()} if hasattr(drawn, "factors") else {}
        return dataclasses.replace(drawn, material=material, **changes)

    return dataclasses.replace(
        values, instances=tuple(map(shining, values.instances)), heaps=tuple(map(shining, values.heaps)), lights=(),
        world=surroundings.WorldValues(), exchange="off")


def seen(exposure, read_camera, width, height, allowed):
    """(names, numbers): the names of Things, and (samples, h, w) int32 with row 0 at the top, the number of what each
    sample sees, 0 for nothing. exposure: motion.Exposure; read_camera: gives the native.Camera of its moment; allowed:
    a grace.Grace, whose end leaves fewer samples, and raises GivenUp where there would be none."""
    view = native_module.get().View(width, height)
    names, found, before = None, [], np.zeros((height, width))
    with contextlib.closing(exposure.moments(read_camera, _samples(exposure, read_camera))) as moments:
        try:
            for values, camera, count in moments:
                things = things_of(values)
                if names is None:
                    names = things.names
                    allowed.result(view.start_scene(things.scene), view)
                allowed.result(view.start_moment(camera, things.scene), view)
                for _ in range(count):
                    total = _total(view, allowed)
                    found.append((total - before).astype(np.int32))
                    before = total
        except grace.GivenUp:
            if not found:
                raise
    return names, np.stack(found)


def _total(view, allowed):
    """Of the numbers of one more sample and of those before."""
    if view.samples and allowed.is_over():
        raise grace.GivenUp
    allowed.result(view.start(1), view)
    # The mean of whole numbers, whose sum floats hold exactly.
    return np.rint(allowed.result(view.start_read(), view)["pixels"][..., 0].astype(np.float64) * view.samples)


def _samples(exposure, read_camera):
    return BLURRED_SAMPLES if exposure.blurred or read_camera().lens else SAMPLES


def albedo(exposure, read_camera, width, height, allowed):
    """(h, w, 3) float32 with row 0 at the top: what a pixel's things send back of light from everywhere, 0 where
    nothing is. exposure, read_camera, allowed: as of `seen`."""
    native = native_module.get()
    view, known, begun = native.View(width, height), {}, False

    def finish_of(drawn):
        if drawn.material not in known:
            known[drawn.material] = _albedo_of(drawn.material, native)
        return known[drawn.material]

    with contextlib.closing(exposure.moments(read_camera, _samples(exposure, read_camera))) as moments:
        for values, camera, count in moments:
            if view.samples and allowed.is_over():
                break
            scene = _shining(values, finish_of).to_native()
            if not begun:
                allowed.result(view.start_scene(scene), view)
                begun = True
            allowed.result(view.start_moment(camera, scene), view)
            allowed.result(view.start(count), view)
    return allowed.result(view.start_read(), view)["pixels"][..., :3]


def _albedo_of(material, native):
    """plain_materials.FinishValues that shine by a material's albedo."""
    values = dict(material.values)
    if "sigma_s" in models.CHOICES[values["model"]].parameters:
        plain = dataclasses.replace(material, finish=None)
        radiance = native.half_space_albedo(plain.to_native(native))
        return plain_materials.FinishValues((("radiance", tuple(radiance)),))
    maps = dict(material.finish.maps) if material.finish else {}
    worn = (("emission", maps["reflectance"]),) if "reflectance" in maps else ()
    radiance = (1.0, 1.0, 1.0) if worn else tuple(values["reflectance"])
    return plain_materials.FinishValues((("radiance", radiance),), worn)


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
