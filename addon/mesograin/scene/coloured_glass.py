# Glass of a colour: Cycles tints what crosses its surface, however far it goes inside; a grain absorbs on the way. What
# is left on average is made the same.
import weakref

import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

RAYS = 256
LEAST = 1e-4
"""Of light: less would need endless absorption."""

MOST_COLOURS = 64
"""Of a mesh, that are remembered: a slider's are many."""

_known = weakref.WeakKeyDictionary()  # of native.Mesh: (eta, chords, {tint: absorption}), of the last eta


def absorption(thing, mesh, tint, eta):
    """(3,) per unit of the shape's own space, of which light that enters from everywhere keeps `tint`, linear RGB, on
    its first way through; None where it does not end in it. thing: the evaluated object; mesh: its native.Mesh, by
    which ways are remembered."""
    if mesh not in _known or _known[mesh][0] != eta:
        _known[mesh] = eta, chords(thing, eta), {}
    _, ways, colours = _known[mesh]
    if 2 * len(ways) < RAYS:
        return None
    if tint not in colours:
        if len(colours) == MOST_COLOURS:
            colours.clear()
        colours[tint] = tuple(_keeping(max(left, LEAST), ways) for left in tint)
    return colours[tint]


def chords(thing, eta):
    """(n,) lengths of ways through an evaluated object's mesh, in its own space, that enter evenly all over its surface
    with the cosine, are refracted, and meet it again from inside; at most RAYS."""
    mesh = thing.to_mesh()
    try:
        mesh.calc_loop_triangles()
        places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", places)
        triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
    finally:
        thing.to_mesh_clear()
    places, triangles = places.reshape(-1, 3), triangles.reshape(-1, 3)
    corners = places.astype(float)[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(across, axis=1)
    if not areas.sum() > 0.0:
        return np.zeros(0)
    tree = BVHTree.FromPolygons(places.tolist(), triangles.tolist())
    shift = 1e-5 * float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    random = np.random.default_rng(0)
    shares = (np.arange(RAYS) + random.random(RAYS)) / RAYS
    hit = np.minimum(np.searchsorted(np.cumsum(areas) / areas.sum(), shares), len(areas) - 1)
    found = []
    for number, (u, v, w, turn) in zip(hit, random.random((RAYS, 4))):
        normal = across[number] / areas[number]
        u, v = (u, v) if u + v <= 1.0 else (1.0 - u, 1.0 - v)
        place = (1.0 - u - v) * corners[number, 0] + u * corners[number, 1] + v * corners[number, 2]
        along = corners[number, 1] - corners[number, 0]
        along /= np.linalg.norm(along)
        sine = np.sqrt(w) / eta if eta > 1.0 else np.sqrt(w)
        direction = (sine * (np.cos(2.0 * np.pi * turn) * along + np.sin(2.0 * np.pi * turn) * np.cross(normal, along))
                     - np.sqrt(1.0 - sine * sine) * normal)
        _, met, _, distance = tree.ray_cast(Vector(place + shift * direction), Vector(direction))
        if met is not None and met.dot(Vector(direction)) > 0.0:
            found.append(distance)
    return np.array(found)


def _keeping(left, ways):
    """What a medium absorbs that leaves so much on average."""
    if left >= 1.0:
        return 0.0
    low, high = 0.0, -np.log(left) / float(ways.min() + 1e-30)
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.exp(-middle * ways).mean() > left else (low, middle)
    return float(0.5 * (low + high))
