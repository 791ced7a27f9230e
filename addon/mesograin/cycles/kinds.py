# Which kinds of reference there are, which models each one answers, and which boundary makes both sides mean the same.
"""The table of reference kinds. Adding one is adding a row here and a recipe in `recipes`."""

import math
from dataclasses import dataclass

TRANSLUCENT_MODELS = ("model_1", "model_2", "model_3")


@dataclass(frozen=True)
class NodeFeatures:
    """What this Blender's shader nodes can do, found by looking at the nodes themselves (`nodes.features`)."""

    glossy_type: str  # the node type that is plain GGX reflection
    glossy_masking: str  # `separable` or `correlated`: the Smith term of that node
    subsurface_method: str  # the random walk whose mean free path is the radius / 4 pi
    subsurface_refracts: bool  # the walk starts along the view ray refracted by IOR, not on a cosine lobe
    glass_distribution: str  # of the Glass BSDF: `SHARP` where there is one, else one that roughness 0 makes sharp
    has_phase_choice: bool  # Volume Scatter offers several phase functions


@dataclass(frozen=True)
class Kind:
    """One kind of reference.

    name: as on the command line and in results. title: as in the report. models: our models that it answers.
    bounces: Cycles' limit on path length. samples: per pixel and seed by default. coverage_pass: its alpha is not the
    coverage, so the coverage is rendered apart. cost: guessed seconds for a million samples on one core, for the first
    estimate of the time left. judged_by: the metric that says how far a model is off, pixel by pixel or in blocks.
    least_sun: radians; on both sides suns are taken at least as wide. smooth_interface: the sun's mirror image is
    masked, and the error is told over the angle to the sun. referee: rendered by mesograin-referee, not by Cycles.
    """

    name: str
    title: str
    models: tuple
    bounces: int
    samples: int
    coverage_pass: bool
    cost: float
    judged_by: str = "relative_l1"
    least_sun: float = 0.0
    smooth_interface: bool = False
    referee: bool = False

    @property
    def tracer(self):
        """Who renders it, as it is called in sentences."""
        return "mesograin-referee" if self.referee else "Cycles"


# The opaque kinds see direct light alone, as the models that they answer do; inside a medium everything counts.
# New kinds are added at the end: Blender files remember a choice of kinds by their numbers.
KINDS = {
    kind.name: kind
    for kind in (
        Kind("diffuse", "Cycles Diffuse BSDF", ("lambert",), 0, 64, False, 0.6),
        Kind("glossy", "Cycles Glossy BSDF, GGX", ("conductor",), 0, 64, False, 0.6),
        Kind("volume_index_matched", "Cycles volume, index-matched", TRANSLUCENT_MODELS, 1024, 128, True, 5.0),
        Kind("subsurface", "Cycles Subsurface Scattering, random walk", TRANSLUCENT_MODELS, 1024, 128, False, 5.0),
        Kind(
            "subsurface_burley",
            "Cycles Subsurface Scattering, Christensen-Burley",
            TRANSLUCENT_MODELS,
            1024,
            128,
            False,
            2.5,
        ),
        # A delta sun cannot be met through a smooth interface, and a small one hardly ever: 5 degrees are hopeless.
        Kind(
            "volume_dielectric",
            "Cycles glass with a volume",
            TRANSLUCENT_MODELS,
            1024,
            1024,
            True,
            12.0,
            judged_by="relative_l1_blocks",
            least_sun=math.radians(20.0),
            smooth_interface=True,
        ),
        Kind(
            "photon",
            "Photon Monte Carlo, smooth dielectric sphere",
            TRANSLUCENT_MODELS,
            0,
            256,
            False,
            6.0,
            referee=True,
        ),
    )
}

COVERAGE = Kind("coverage", "Coverage", (), 0, 64, False, 0.3)
"""Not a reference of its own: how much of each pixel the geometry covers, for kinds whose alpha is not that."""

NORMAL = Kind("normal", "Normal", (), 0, 16, False, 0.3)
MIRRORED = Kind("mirrored", "Mirrored view", (), 0, 16, False, 0.3)
"""Nor are these: the normal n, and the way to the viewer mirrored at it, in world space, as 0.5 + 0.5 n."""


def default_kind(model):
    """Name of the reference that answers this model when none is asked for."""
    return next(kind.name for kind in KINDS.values() if model in kind.models)


def our_side(kind, features):
    """The Mesograin parameters that make our side solve what this kind of reference solves, as {name: value}."""
    if kind == "glossy":
        return {"masking": features.glossy_masking}
    if kind == "volume_index_matched":
        return {"boundary": "index_matched"}
    if kind == "subsurface":
        return {"boundary": "lambert_refracted" if features.subsurface_refracts else "lambert_lambert"}
    if kind == "subsurface_burley":
        return {"boundary": "lambert_lambert"}
    if kind in ("volume_dielectric", "photon"):
        return {"boundary": "dielectric", "roughness": 0.0, "specular": False}
    return {}
