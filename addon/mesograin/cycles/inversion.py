# Which colour and radius Cycles' Subsurface Scattering node needs so that its random walk has our coefficients.
"""Inversion of the albedo mapping in Cycles' `subsurface_random_walk.h`.

Cycles turns the node's colour A and radius into a medium: sigma_t = 1 / (d (1 - g)), and a single-scattering albedo
that is a fit to the multiple-scattering albedo A of an index-matched half-space (Chiang, Kutz, Burley: "Practical and
Controllable Subsurface Scattering for Production Path Tracing", SIGGRAPH 2016; extended to g by Wrenninge, Villemin,
Hery: "Path Traced Subsurface Scattering using Anisotropic Phase Functions and Non-Exponential Free Flights", Pixar
2017). Ours are the inverse.
"""

import math

ALBEDO_LIMIT = 0.999999
"""Cycles clamps the single-scattering albedo to this."""

ANISOTROPY_LIMIT = 0.9
"""Cycles clamps g to [0, this] in a random walk."""

FIXED_RADIUS_FACTOR = 4.0 * math.pi
"""The fixed-radius random walk divides the node's radius by this to get the mean free path."""


def _polynomial(g, *coefficients):
    return math.fsum(coefficient * g**power for power, coefficient in enumerate(coefficients))


def _fit(g):
    """The fit's six coefficients at g, in the order of the formula in `single_scattering_albedo`."""
    a = _polynomial(
        g,
        1.8260523782,
        -1.28451056436,
        -1.79904629312,
        9.19393289202,
        -22.8215585862,
        32.0234874259,
        -23.6264803333,
        7.21067002658,
    )
    b = 4.98511194385 + 0.127355959438 * math.exp(
        _polynomial(
            g,
            0.0,
            31.1491581433,
            -201.847017512,
            841.576016723,
            -2018.09288505,
            2731.71560286,
            -1935.41424244,
            559.009054474,
        )
    )
    c = _polynomial(
        g,
        1.09686102424,
        -0.394704063468,
        1.05258115941,
        -8.83963712726,
        28.8643230661,
        -46.8802913581,
        38.5402837518,
        -12.7181042538,
    )
    d = _polynomial(
        g,
        0.496310210422,
        0.360146581622,
        -2.15139309747,
        17.8896899217,
        -55.2984010333,
        82.065982243,
        -58.5106008578,
        15.8478295021,
    )
    e = 4.23190299701 + 0.00310603949088 * math.exp(
        _polynomial(
            g,
            0.0,
            76.7316253952,
            -594.356773233,
            2448.8834203,
            -5576.68528998,
            7116.60171912,
            -4763.54467887,
            1303.5318055,
        )
    )
    f = _polynomial(
        g,
        2.40602999408,
        -2.51814844609,
        9.18494908356,
        -79.2191708682,
        259.082868209,
        -403.613804597,
        302.85712436,
        -87.4370473567,
    )
    return a, b, c, d, e, f


def single_scattering_albedo(colour, g=0.0):
    """The albedo sigma_s / sigma_t that Cycles gives the medium for one channel of the node's colour."""
    a, b, c, d, e, f = _fit(g)
    blend = colour**0.25
    albedo = (1.0 - blend) * a * math.atan(b * colour) ** c + blend * d * math.atan(e * colour) ** f
    return min(max(albedo, 0.0), ALBEDO_LIMIT)


def colour_of_albedo(albedo, g=0.0):
    """The node's colour for which Cycles uses this single-scattering albedo, one channel, both in [0, 1].

    Bisection over the exponent of the colour, because the fit rises with a power of it: albedos of 1e-6 and 0.999 are
    found to the same relative precision. From `ALBEDO_LIMIT` up the colour is the smallest one clamped there.
    """
    if not 0.0 <= albedo <= 1.0:
        raise ValueError(f"albedo must lie between 0 and 1; got {albedo}.")
    if albedo == 0.0:
        return 0.0
    target = min(albedo, ALBEDO_LIMIT)
    low, high = -300.0 * math.log(10.0), 0.0
    if single_scattering_albedo(math.exp(low), g) >= target:
        return 0.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        if single_scattering_albedo(math.exp(middle), g) < target:
            low = middle
        else:
            high = middle
    return math.exp(high)


def walk_colour(values):
    """The node's colour for a random walk in the medium of GrainValues, RGB."""
    return tuple(colour_of_albedo(albedo, values.g) for albedo in values.albedo)


def profile_colour(values):
    """That for Christensen and Burley's profile: the reflectance of a half-space, by the fit that the walk inverts."""
    reduced = tuple((a, (1.0 - values.g) * s) for a, s in zip(values.sigma_a, values.sigma_s))
    return tuple(colour_of_albedo(s / (a + s)) for a, s in reduced)


def radius_of_extinction(sigma_t, g=0.0):
    """The node's radius (scene units, one channel) for a fixed-radius walk of extinction sigma_t (per scene unit)."""
    if not sigma_t > 0.0:
        raise ValueError(f"sigma_t must be positive for a random walk; got {sigma_t}.")
    return FIXED_RADIUS_FACTOR / (sigma_t * (1.0 - g))


def _dipole_albedo(colour, ior):
    """Reduced albedo that Cycles' other random walk derives from the colour: 12 bisection steps through R_d.

    Jensen, Marschner, Levoy, Hanrahan: "A Practical Model for Subsurface Light Transport", SIGGRAPH 2001, equation 15
    of the shortened form, with the Egan-Hilgeman fit of the diffuse Fresnel reflectance.
    """
    if colour < 1e-4:
        return 0.0
    if colour >= 0.995:
        return ALBEDO_LIMIT
    inverse = 1.0 / ior
    fresnel = inverse * (-1.440 * inverse + 0.710) + 0.668 + 0.0636 * ior
    factor = 4.0 / 3.0 * (1.0 + fresnel) / (1.0 - fresnel)
    low, high, middle = 0.0, 1.0, 0.5
    for _ in range(12):
        middle = 0.5 * (low + high)
        s = math.sqrt(3.0 * (1.0 - middle))
        reflectance = 0.5 * middle * (1.0 + math.exp(-factor * s)) * math.exp(-s)
        if reflectance < colour:
            low = middle
        else:
            high = middle
    return middle


def skin_radius_factor(colour, ior):
    """What the random walk that rescales its radius (3.x `RANDOM_WALK`, 4.x `RANDOM_WALK_SKIN`) divides the radius by.

    Quantised by Cycles' twelve bisection steps for colours near 1, which is why the fixed radius is what we use.
    """
    return 1.0 / math.sqrt(3.0 * (1.0 - _dipole_albedo(colour, ior)))
