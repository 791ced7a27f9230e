# What a material asks for that Cycles cannot render like for like, said before anything is rendered.
"""See `limits`."""

from dataclasses import dataclass

from . import inversion

MIRROR_ALPHA = 1e-3
"""Cycles makes a mirror of a slightly smaller GGX alpha (alpha squared under 1e-7), and a mirror shows no delta sun."""

PHASE_LIMIT = 0.999
"""Cycles clamps |g| of a volume to this."""

IOR_RANGE = (1.01, 3.8)
"""Cycles clamps the IOR of the Subsurface Scattering node to this."""

PRINCIPLED_IOR = 1.78
"""Up to here the Principled BSDF of Blender 3 can be told a dielectric's reflectance: 0.08 at normal incidence."""

LOSSY_ALBEDO = 0.99
"""Above this albedo a thick random walk notably outlives Cycles' 256 bounces."""

LONG_PATHS_ALBEDO = 0.9995
"""Above this albedo light in a thick volume notably outlives 1024 bounces."""


@dataclass(frozen=True)
class Limit:
    """One sentence; `fatal` if a render would not be a reference for this material at all."""

    sentence: str
    fatal: bool


def limits(values, kind):
    """What Cycles cannot express of `values` (GrainValues) in a `Kind.recipe`: a list of Limit, often empty."""
    if kind in ("glossy", "dielectric_specular"):
        return _glossy(values)
    if kind in ("volume_index_matched", "volume_lambert"):
        return _volume(values)
    if kind == "subsurface":
        return _subsurface(values)
    if kind == "subsurface_burley":
        return _subsurface_burley(values)
    if kind == "volume_dielectric":
        return [*_volume(values), *_smooth(values)]
    if kind == "photon":
        return [*_photon(values, kind), *_smooth(values)]
    if kind == "photon_scene":
        return _photon(values, kind)
    return []


def _glossy(values):
    if values.roughness < MIRROR_ALPHA:
        return [
            Limit(
                (
                    f"Cycles renders a GGX roughness (alpha) under {MIRROR_ALPHA:g} as a mirror, in which a sun cannot"
                    f" be seen; got {values.roughness:g}: raise the roughness."
                ),
                True,
            )
        ]
    return []


def _volume(values):
    found = []
    if max(values.sigma_t) <= 0.0:
        found.append(Limit("A medium without absorption and scattering is invisible: raise sigma_a or sigma_s.", True))
    if abs(values.g) > PHASE_LIMIT:
        found.append(
            Limit(
                f"Cycles limits the g of a volume to {PHASE_LIMIT:g}; got {values.g:g}: the reference uses the limit.",
                False,
            )
        )
    largest = max(values.albedo)
    if largest > LONG_PATHS_ALBEDO:
        found.append(
            Limit(
                (
                    f"Cycles ends paths after 1024 bounces, which darkens a thick grain at an albedo of {largest:.7g}."
                ),
                False,
            )
        )
    return found


def _smooth(values):
    if values.roughness == 0.0:
        return []
    sentence = f"The reference's interface is smooth; the roughness {values.roughness:g} is left out on both sides."
    return [Limit(sentence, False)]


def _photon(values, kind):
    if abs(values.g) < 1.0:
        return []
    return [Limit(f"The reference {kind} needs g inside (-1, 1); got {values.g:g}: choose another g.", True)]


def _subsurface_burley(values):
    found = []
    if min(a + (1.0 - values.g) * s for a, s in zip(values.sigma_a, values.sigma_s)) <= 0.0:
        found.append(
            Limit(
                "Christensen and Burley's profile needs a positive sigma_a + (1 - g) sigma_s in every channel: choose"
                " the reference volume_index_matched.",
                True,
            )
        )
    if values.g != 0.0:
        found.append(
            Limit(
                f"Christensen and Burley's profile knows g by similarity alone; got {values.g:g}: the reference uses"
                " sigma_s (1 - g).",
                False,
            )
        )
    return found


def _subsurface(values):
    found = []
    if not 0.0 <= values.g <= inversion.ANISOTROPY_LIMIT:
        found.append(
            Limit(
                (
                    f"Cycles' Subsurface Scattering allows g between 0 and {inversion.ANISOTROPY_LIMIT:g}; got"
                    f" {values.g:g}: choose the reference volume_index_matched."
                ),
                True,
            )
        )
    if min(values.sigma_t) <= 0.0:
        found.append(
            Limit(
                (
                    "Cycles' Subsurface Scattering needs a positive sigma_a + sigma_s in every channel: "
                    "choose the reference volume_index_matched."
                ),
                True,
            )
        )
    low, high = IOR_RANGE
    if not low <= values.eta <= high:
        found.append(
            Limit(
                (
                    f"Cycles' Subsurface Scattering limits the index of refraction to {low:g} to {high:g}; got"
                    f" {values.eta:g}: the reference uses the limit."
                ),
                False,
            )
        )
    largest = max(values.albedo)
    if largest > LOSSY_ALBEDO:
        found.append(
            Limit(
                (
                    "Cycles' random walk ends after 256 bounces, which loses up to 8 % of the light at an albedo of"
                    f" {largest:.6g}."
                ),
                False,
            )
        )
    return found
