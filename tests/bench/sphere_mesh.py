"""A sphere as a mesh, for tests and benchmarks."""
import numpy


def sphere(segments, rings):
    """(positions, normals, triangles) of the unit sphere, with its own normals: (n, 3) float32 twice, (m, 3) uint32."""
    polar = numpy.linspace(0.0, numpy.pi, rings + 1)[:, None]
    around = numpy.linspace(0.0, 2.0 * numpy.pi, segments, endpoint=False)[None, :]
    normals = numpy.stack(numpy.broadcast_arrays(
        numpy.sin(polar) * numpy.cos(around), numpy.sin(polar) * numpy.sin(around), numpy.cos(polar)), axis=-1)
    normals = normals.reshape(-1, 3).astype(numpy.float32)
    normals[numpy.abs(normals) < 1e-6] = 0.0  # all of a pole is one place, or the mesh is not closed
    ring, segment = numpy.arange(rings)[:, None], numpy.arange(segments)[None, :]
    first, second = ring * segments + segment, ring * segments + (segment + 1) % segments
    halves = [(first, first + segments, second), (second, first + segments, second + segments)]
    triangles = numpy.concatenate([numpy.stack(half, axis=-1).reshape(-1, 3) for half in halves])
    return normals.copy(), normals, triangles.astype(numpy.uint32)
