# Clear skies: light scattered once in air and dust (Nishita et al., "Display of the Earth Taking into Account
# Atmospheric Scattering", 1993), and a fit to daylight (Preetham, Shirley and Smits, "A Practical Analytic Model for
# Daylight", 1999), with Blender's constants.
import functools

import numpy as np

# Wavelengths from 380 to 780 nm, 20 nm apart: the sun's irradiance above the air (W/m^2/nm), how much air scatters and
# ozone absorbs (1/m), as Blender has them, and the CIE's 1931 observer.
STEP = 20.0
IRRADIANCE = np.array((
    1.457568299, 1.565963056, 1.651484491, 1.714962427, 1.757979838, 1.782564079, 1.790951085, 1.785415501, 1.768155549,
    1.741220696, 1.706471272, 1.665560873, 1.619934370, 1.570835974, 1.519323351, 1.466284950, 1.412458527, 1.358449670,
    1.304749138, 1.251749633, 1.199759988))
RAYLEIGH = 1e-6 * np.array((
    54.24820088, 44.18549867, 36.35151910, 30.17929012, 25.26320227, 21.30859311, 18.09838025, 15.47057129, 13.30284977,
    11.50184784, 9.995574300, 8.727999706, 7.655137010, 6.742172038, 5.961341258, 5.290346026, 4.711156876, 4.209104811,
    3.772183813, 3.390512555, 3.055915317))
OZONE = 1e-9 * np.array((
    3.251268499, 5.853953650, 19.77191155, 73.09568763, 200.8456151, 403.8395810, 635.5133591, 967.0704118, 1547.974004,
    2090.386472, 2461.280562, 2735.512995, 2151.258631, 1590.518408, 1123.561980, 735.2755149, 464.5013036, 330.9607992,
    225.1261229, 148.7912927, 168.2862336))
OBSERVER = np.array((
    (0.001368, 0.01431, 0.13438, 0.34828, 0.2908, 0.09564, 0.0049, 0.06327, 0.2904, 0.5945, 0.9163, 1.0622,
     0.8544499, 0.4479, 0.1649, 0.04677, 0.01135916, 0.002899327, 0.00069007860, 0.0001661505, 0.00004150994),
    (0.000039, 0.000396, 0.004, 0.023, 0.06, 0.13902, 0.323, 0.71, 0.954, 0.995, 0.87, 0.631, 0.381, 0.175, 0.061,
     0.017, 0.004102, 0.001047, 0.0002492, 0.00006, 0.00001499),
    (0.006450001, 0.06785001, 0.6456, 1.74706, 1.6692, 0.8129501, 0.272, 0.07824999, 0.0203, 0.0039, 0.001650001,
     0.0008, 0.00019, 0.00002, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)))
MIE = 2e-5  # what dust scatters, 1/m; it takes away this much more
MIE_EXTINCTION = 1.11 * MIE
MIE_G = 0.76
RAYLEIGH_HEIGHT, MIE_HEIGHT = 8000.0, 1200.0  # over which air and dust thin out by e, m
EARTH, TOP = 6360e3, 6420e3  # radii of the earth and of its air, m
STEPS = 32  # of a ray
# Gauss-Laguerre's nodes and weights for the way to the sun, of its length, exp(x) among the weights.
NODES = np.array((0.006811185292, 0.03614807107, 0.09004346519, 0.1706680068, 0.2818362161, 0.4303406404, 0.6296271457,
                  0.9145252695))
WEIGHTS = np.array((0.01750893642, 0.04135477391, 0.06678839063, 0.09507698807, 0.1283416365, 0.1707430204,
                    0.2327233347, 0.3562490486))
# CIE XYZ to Rec. 709.
TO_RGB = np.array(((3.2404542, -1.5371385, -0.4985314), (-0.9692660, 1.8760108, 0.0415560),
                   (0.0556434, -0.2040259, 1.0572252)))
ROWS, COLUMNS = 128, 512  # of the table that Blender keeps


def _densities(height):
    """(..., 3): air, dust and ozone at heights in m, as a share of what the constants are of."""
    ozone = np.where(height < 25000.0, height / 15000.0 - 2.0 / 3.0, 8.0 / 3.0 - height / 15000.0)
    ozone = np.where((height >= 10000.0) & (height < 40000.0), ozone, 0.0)
    return np.stack((np.exp(-height / RAYLEIGH_HEIGHT), np.exp(-height / MIE_HEIGHT), ozone), axis=-1)


def _way_out(places, direction):
    """(...): how far it is to where the air ends."""
    along = places @ direction if direction.ndim == 1 else (places * direction).sum(axis=-1)
    return np.sqrt(np.maximum(along * along - (places * places).sum(axis=-1) + TOP * TOP, 0.0)) - along


def _depth(places, direction):
    """(..., 3): how much air, dust and ozone lies towards a direction, m."""
    length = _way_out(places, direction)
    total = np.zeros(places.shape)
    for node, weight in zip(NODES, WEIGHTS):
        height = np.linalg.norm(places + (node * length)[..., None] * direction, axis=-1) - EARTH
        total += weight * _densities(height)
    return total * length[..., None]


def _direction(latitude, longitude):
    return np.stack((np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude),
                     np.sin(latitude) * np.ones_like(longitude)), axis=-1)


@functools.lru_cache(maxsize=4)
def table(elevation, altitude, air, dust, ozone):
    """(ROWS, COLUMNS, 3) XYZ of the sky above the horizon, the sun at the middle column. elevation: of the sun,
    radians; altitude: m; air, dust, ozone: how dense they are."""
    scale = np.array((air, dust, ozone))
    # As Blender has it: rows are denser towards the horizon, and the last is a little past the zenith.
    latitude = (0.5 * np.pi + 0.25 * np.pi / ROWS) * (np.arange(ROWS) / ROWS) ** 2
    longitude = 2.0 * np.pi / COLUMNS * np.arange(COLUMNS // 2) - np.pi
    rays = _direction(latitude[:, None], longitude[None, :])
    sun = _direction(np.array(elevation), np.array(0.0))
    eye = np.array((0.0, 0.0, EARTH + altitude))
    step = _way_out(np.broadcast_to(eye, rays.shape), rays) / STEPS
    mu = rays @ sun
    g2 = MIE_G * MIE_G
    phases = (3.0 / (16.0 * np.pi) * (1.0 + mu * mu),
              3.0 * (1.0 - g2) * (1.0 + mu * mu)
              / (8.0 * np.pi * (2.0 + g2) * (1.0 + g2 - 2.0 * MIE_G * mu) ** 1.5))
    extinction = np.stack((RAYLEIGH, np.full_like(RAYLEIGH, MIE_EXTINCTION), OZONE))
    before = np.zeros(rays.shape)
    spectrum = np.zeros((*mu.shape, len(RAYLEIGH)))
    for index in range(STEPS):
        places = eye + ((index + 0.5) * step)[..., None] * rays
        density = scale * _densities(np.linalg.norm(places, axis=-1) - EARTH)
        before += step[..., None] * density
        passed = np.exp(-(before + scale * _depth(places, sun)) @ extinction)
        passed[_in_the_earths_shadow(places, sun)] = 0.0
        scattered = ((phases[0] * density[..., 0])[..., None] * RAYLEIGH
                     + (phases[1] * density[..., 1])[..., None] * MIE)
        spectrum += step[..., None] * passed * scattered
    half = (spectrum * IRRADIANCE) @ OBSERVER.T * STEP
    return np.concatenate((half, half[:, ::-1]), axis=1)


def _in_the_earths_shadow(places, sun):
    along = places @ sun
    return (sun[2] < 0.0) & (along * along - (places * places).sum(axis=-1) + EARTH * EARTH >= 0.0)


def scattered_once(directions, elevation, rotation, altitude, air, dust, ozone):
    """(n, 3) linear RGB of (n, 3) directions, z up, without the sun. rotation: of the sun from +y towards +x."""
    found = table(elevation, altitude, air, dust, ozone)
    x, y, z = directions.T
    across = (np.arctan2(x, y) + np.pi - rotation) / (2.0 * np.pi) % 1.0
    up = np.sqrt(np.clip(np.arcsin(np.clip(z, -1.0, 1.0)) / (0.5 * np.pi), 0.0, 1.0))
    # What lies below the horizon fades to black.
    fade = np.where(z >= 0.0, 1.0, np.where(z < -0.4, 0.0, (1.0 + 2.5 * z) ** 3))
    return (_looked_up(found, across, up) * fade[:, None]) @ TO_RGB.T


def _looked_up(found, across, up):
    """Linearly between the middles of texels, its edges going on for ever."""
    place = np.stack((across * COLUMNS, up * ROWS), axis=1) - 0.5
    corner = np.floor(place).astype(np.int64)
    share = place - corner

    def texel(right, above):
        return found[np.clip(corner[:, 1] + above, 0, ROWS - 1), np.clip(corner[:, 0] + right, 0, COLUMNS - 1)]

    u, v = share[:, :1], share[:, 1:]
    return (texel(0, 0) * (1 - u) + texel(1, 0) * u) * (1 - v) + (texel(0, 1) * (1 - u) + texel(1, 1) * u) * v


def sun_direction(elevation, rotation):
    """(3,) towards the sun."""
    return np.array((np.cos(elevation) * np.sin(rotation), np.cos(elevation) * np.cos(rotation), np.sin(elevation)))


def sun_disc(directions, elevation, rotation, altitude, air, dust, size):
    """(n, 3) linear RGB of the sun's disc, 0 beside it; darker towards its limb (coefficient 0.6). size: radians."""
    half = 0.5 * size
    x, y, z = directions.T
    aside = 2.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(directions - sun_direction(elevation, rotation), axis=1),
                                    0.0, 1.0))
    ends = np.stack([_sun(max(elevation + sign * half, 0.0), altitude, air, dust, half) for sign in (-1.0, 1.0)])
    height = np.arcsin(np.clip(z, -1.0, 1.0))
    if elevation - half > 0.0:
        share = (height - elevation) / size + 0.5
    else:
        share = height / max(elevation + half, 1e-9)
    limb = 1.0 - 0.6 * (1.0 - np.sqrt(np.clip(1.0 - (aside / half) ** 2, 0.0, 1.0)))
    radiance = ends[0] + share[:, None] * (ends[1] - ends[0])
    seen = (aside < half) & (z >= 0.0)
    return np.where(seen[:, None], np.maximum(radiance * limb[:, None] @ TO_RGB.T, 0.0), 0.0)


def _sun(elevation, altitude, air, dust, half):
    """(3,) XYZ of the sun seen through the air."""
    depth = _depth(np.array(((0.0, 0.0, EARTH + altitude),)), _direction(np.array(elevation), np.array(0.0)))[0]
    spectrum = IRRADIANCE * np.exp(-(RAYLEIGH * depth[0] * air + MIE_EXTINCTION * depth[1] * dust))
    return OBSERVER @ spectrum * STEP / (2.0 * np.pi * (1.0 - np.cos(half)))


# Preetham's appendix A.2: Perez' five coefficients of Y, x and y, a factor of the turbidity and a constant each.
PEREZ = np.array((
    ((0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)),
    ((-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)),
    ((-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529))))
# Of x and y at the zenith: powers of the turbidity, 2 to 0, by powers of the sun's angle from there, 3 to 0.
ZENITH = np.array((
    ((0.00166, -0.00375, 0.00209, 0.0), (-0.02903, 0.06377, -0.03202, 0.00394), (0.11693, -0.21196, 0.06052, 0.25886)),
    ((0.00275, -0.00610, 0.00317, 0.0), (-0.04214, 0.08970, -0.04153, 0.00516), (0.15346, -0.26756, 0.06670, 0.26688))))
BRIGHTNESS = 0.06  # of Blender's, over kcd/m^2


def daylight(directions, towards_sun, turbidity):
    """(n, 3) linear RGB of (n, 3) directions by Preetham's model."""
    towards_sun = np.asarray(towards_sun) / max(np.linalg.norm(towards_sun), 1e-30)
    sun_angle = np.arccos(np.clip(towards_sun[2], -1.0, 1.0))
    perez = PEREZ @ (turbidity, 1.0)
    chi = (4.0 / 9.0 - turbidity / 120.0) * (np.pi - 2.0 * sun_angle)
    powers = np.array((turbidity ** 2, turbidity, 1.0))
    zenith = [BRIGHTNESS * ((4.0453 * turbidity - 4.9710) * np.tan(chi) - 0.2155 * turbidity + 2.4192)]
    zenith += [powers @ (table_of_one @ sun_angle ** np.arange(3.0, -1.0, -1.0)) for table_of_one in ZENITH]
    angle = np.minimum(np.arccos(np.clip(directions[:, 2], -1.0, 1.0)), 0.5 * np.pi - 0.001)
    aside = np.arccos(np.clip(directions @ towards_sun, -1.0, 1.0))

    def shape(of, theta, gamma):
        a, b, c, d, e = of
        return (1.0 + a * np.exp(b / np.cos(theta))) * (1.0 + c * np.exp(d * gamma) + e * np.cos(gamma) ** 2)

    light, x, y = (top * shape(of, angle, aside) / shape(of, 0.0, sun_angle) for top, of in zip(zenith, perez))
    with np.errstate(divide="ignore", invalid="ignore"):
        xyz = np.stack((x / y * light, light, (1.0 - x - y) / y * light), axis=1)
    return np.where(y[:, None] != 0.0, xyz, 0.0) @ TO_RGB.T
