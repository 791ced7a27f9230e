"""What leaves a sphere in parallel light, summed over all directions, and how far it is from the truth."""
import numpy
import sphere_mesh

SIZE = 64
VIEWS = 10


def sphere(native, segments=256, rings=128):
    """A smooth UV sphere of radius 1."""
    return native.Mesh(*sphere_mesh.sphere(segments, rings))


class Cameras:
    """Orthographic views whose directions integrate over the sphere of directions, the light along +y."""

    def __init__(self, native, views=VIEWS, facing_power=1):
        """`facing_power` above 1 crowds the views towards those that face the light, where a phase function peaks."""
        nodes, weights = numpy.polynomial.legendre.leggauss(views)
        share = 0.5 * (nodes + 1.0)
        nodes, weights = 2.0 * share**facing_power - 1.0, weights * facing_power * share**(facing_power - 1)
        centre = (numpy.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
        x, y = numpy.meshgrid(centre, -centre)
        inside = x * x + y * y < 1.0
        z = numpy.sqrt(numpy.maximum(0.0, 1.0 - x * x - y * y))
        clip = numpy.diag([1.0, 1.0, -0.5, 1.0])
        self.views = []
        for node, weight in zip(nodes, weights):
            sine = numpy.sqrt(1.0 - node * node)
            rotation = numpy.eye(4)
            rotation[:3, :3] = [[1.0, 0.0, 0.0], [0.0, sine, -node], [0.0, node, sine]]
            cosine = sine * y + node * z  # of normal and light
            # The mean over all directions is half the sum over the nodes; a pixel counts its area, 4 pi times.
            share = 0.5 * weight * 4.0 * numpy.pi * (2.0 / SIZE) ** 2
            self.views.append((native.Camera(rotation, clip), inside, cosine, share))

    def exitance(self, view, samples, bins):
        """(bins, 3) flux per area, per unit irradiance."""
        flux = numpy.zeros((bins, 3))
        for camera, inside, cosine, weight in self.views:
            view.set_camera(camera)
            view.render(samples)
            pixels = view.read()[..., :3].astype(float)
            index = numpy.clip(((cosine + 1.0) * 0.5 * bins).astype(int), 0, bins - 1)
            for channel in range(3):
                flux[:, channel] += weight * numpy.bincount(index.ravel(), pixels[..., channel].ravel(), bins)
        return flux / (4.0 * numpy.pi / bins)


def compare(exitance, truth, noise, cosines):
    """Figures of one row, by cosine of normal and light. noise: the truth's own standard error.

    relative_l1: sum|exitance - truth|/sum truth; total: sum exitance/sum truth; dark_ratio and dark_relative_l1: the
    same for cosines below -1/2; noise_floor and dark_noise: relative_l1 of the truth's own standard error, the latter
    None where no photon came.
    """
    dark = cosines < -0.5
    photons = float(truth[dark].sum())
    return {"relative_l1": float(numpy.abs(exitance - truth).sum() / truth.sum()),
            "total": float(exitance.sum() / truth.sum()),
            "dark_ratio": float(exitance[dark].sum() / max(photons, 1e-30)),
            "dark_relative_l1": float(numpy.abs(exitance - truth)[dark].sum() / max(photons, 1e-30)),
            "dark_noise": float(noise[dark].sum()) / photons if photons else None,
            "noise_floor": float(noise.sum() / truth.sum())}
