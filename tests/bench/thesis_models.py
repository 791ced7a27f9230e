"""The three models as the thesis codes them, on a sphere in parallel light, with infinitely many samples.

An evaluation of its own in numpy, so that every number of the accuracy table stands beside the one it replaces.
Lengths are in mean free paths (sigma_t' = 1), scattering is isotropic; `albedo` is sigma_s/sigma_t, `eta` the index.
Each function returns exitance per irradiance on a plane that faces the light, at each of `cosines` (normal, light);
what leaves is integrated over the hemisphere through the smooth interface.
A(eta) is Egan's, with which the printed formulas give sense; what else the code does stays: unrefracted directions and
no 1/eta^2 in single scattering, a second cosine, axial thickness, the area of the projected disk.
"""
import numpy

NODES, WEIGHTS = (0.5 * (array + shift) for array, shift in zip(numpy.polynomial.legendre.leggauss(64), (1.0, 0.0)))


def transmittance(cosine, eta):
    """Fresnel transmittance of unpolarised light from outside; eta >= 1."""
    inside = numpy.sqrt(cosine * cosine + eta * eta - 1.0) / eta
    s = (cosine - eta * inside) / (cosine + eta * inside)
    p = (eta * cosine - inside) / (eta * cosine + inside)
    return 1.0 - 0.5 * (s * s + p * p)


def _hemisphere(function):
    """The integral of function(cosine) cosine over a hemisphere."""
    return 2.0 * numpy.pi * numpy.sum(WEIGHTS * NODES * function(NODES))


def _boundary(eta):
    """A = (1 + F_dr)/(1 - F_dr), F_dr by Egan and Hilgeman."""
    reflectance = -1.440 / eta**2 + 0.710 / eta + 0.668 + 0.0636 * eta
    return (1.0 + reflectance) / (1.0 - reflectance)


def dipole(distance, albedo, eta):
    """R_d(r) of Jensen et al. 2001 eq. 4 for sigma_t' = 1, where the erratum of its second term does not show."""
    decay = numpy.sqrt(3.0 * (1.0 - albedo))
    image = 1.0 + 4.0 / 3.0 * _boundary(eta)
    total = 0.0
    for depth in (1.0, image):
        away = numpy.sqrt(distance * distance + depth * depth)
        total = total + depth * (1.0 + decay * away) * numpy.exp(-decay * away) / away**3
    return albedo / (4.0 * numpy.pi) * total


def _outgoing(eta):
    """What a Lambertian radiance of 1/pi becomes as exitance behind the interface."""
    return _hemisphere(lambda cosine: transmittance(cosine, eta)) / numpy.pi


def model_1(cosines, albedo, _radius, eta):
    lit = numpy.maximum(cosines, 1e-9)
    decay = numpy.sqrt(3.0 * (1.0 - albedo))
    total = 0.5 * albedo * (1.0 + numpy.exp(-4.0 / 3.0 * _boundary(eta) * decay)) * numpy.exp(-decay)
    single = numpy.array([_hemisphere(lambda out, here=cosine: transmittance(out, eta) / (here + out))
                          for cosine in lit])
    exitance = transmittance(lit, eta) * (lit * total * _outgoing(eta) + lit * lit * albedo / (4.0 * numpy.pi) * single)
    return numpy.where(cosines > 0.0, exitance, 0.0)


def model_2(cosines, albedo, radius, eta):
    entry = numpy.abs(cosines)
    # Half the way between entry and exit, plus a constant: what the code makes of the light map's depth.
    thickness = radius * entry + 3.0 * radius / 8.0
    behind = (dipole(thickness, albedo, eta) * transmittance(numpy.maximum(entry, 1e-9), eta) * entry
              * numpy.pi * radius**2 * _outgoing(eta))
    return numpy.where(cosines > 0.0, model_1(cosines, albedo, radius, eta), behind)


def model_3(cosines, albedo, radius, eta):
    nodes, weights = numpy.polynomial.legendre.leggauss(128)
    square = 0.5 * (nodes + 1.0)  # of the distance from the disk's middle: evenly over its area
    entry = numpy.sqrt(1.0 - square)
    azimuths = numpy.pi * (numpy.arange(128) + 0.5) / 128  # half a turn: the rest mirrors it
    share = (0.5 * weights * transmittance(entry, eta) * entry)[:, None] / azimuths.size
    single_out = _hemisphere(lambda cosine: transmittance(cosine, eta) * cosine)
    exitance = []
    for cosine in cosines:
        across = numpy.sqrt(1.0 - cosine * cosine)
        dot = numpy.sqrt(square)[:, None] * across * numpy.cos(azimuths) + entry[:, None] * cosine
        distance = radius * numpy.sqrt(numpy.maximum(2.0 - 2.0 * dot, 0.0))
        deep = numpy.sqrt(distance * distance + 1.0)
        single = albedo * numpy.exp(-(deep + 1.0)) / deep**2 / (4.0 * numpy.pi) * single_out
        exitance.append(numpy.pi * radius**2
                        * numpy.sum(share * (dipole(distance, albedo, eta) * _outgoing(eta) + single)))
    return numpy.array(exitance)


MODELS = {"model_1": model_1, "model_2": model_2, "model_3": model_3}
