# Which kinds of reference there are, which models each one answers, and which boundary makes both sides mean the same.
"""The table of reference kinds. Adding one is adding a row here and a recipe in `recipes`."""

import math
from dataclasses import dataclass, replace

from ..schema.models import AUTO, TRANSLUCENT, WITH_LOBES
from . import inversion
from .grain_values import GrainValues


@dataclass(frozen=True)
class NodeFeatures:
    """What this Blender's shader nodes can do, found by looking at the nodes themselves (`nodes.features`)."""

    glossy_type: str  # the node type that is plain GGX reflection
    glossy_masking: str  # `separable` or `correlated`: the Smith term of that node
    subsurface_method: str  # the random walk whose mean free path is the radius / 4 pi
    subsurface_refracts: bool  # the walk starts along the view ray refracted by IOR, not on a cosine lobe
    glass_distribution: str  # of the Glass BSDF: `SHARP` where there is one, else one that roughness 0 makes sharp
    facets_have_fresnel: bool  # the Glass BSDF reflects by each facet
    has_phase_choice: bool  # Volume Scatter offers several phase functions
    even_suns: bool = False  # a wide sun is equally bright all over; else it is a flat disc, brighter towards its rim


@dataclass(frozen=True)
class Kind:
    """One kind of reference.

    name: as on the command line and in results. title: as in the report. models: our models that it answers.
    bounces: Cycles' limit on scattering. samples: per pixel and seed by default. coverage_pass: its alpha is not the
    coverage, so the coverage is rendered apart. cost: guessed seconds for a million samples on one core, for the first
    estimate of the time left. judged_by: the metric that says how far a model is off, pixel by pixel or in blocks.
    least_sun: radians; on both sides suns are taken at least as wide. smooth_interface: the sun's mirror image is
    masked, and the error is told over the angle to the sun. referee: rendered by mesograin-referee, not by Cycles.
    parts: of PARTS, what the whole consists of. light: that the picture shows, 'all', 'reflected' by the surface, or
    what 'entered' through it. recipe: the row of `recipes` and `limits`, if it is not the name.
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
    parts: tuple = ("subsurface",)
    light: str = "all"
    recipe: str = ""

    def __post_init__(self):
        object.__setattr__(self, "recipe", self.recipe or self.name)

    @property
    def label(self):
        """Its title without the word that all have in common."""
        words = self.title.removeprefix("Cycles ")
        return words[0].upper() + words[1:]

    @property
    def direct(self):
        """Whether it shows nothing but what lights do directly, so that grains send each other none."""
        return self.bounces == 0 and not self.referee

    @property
    def longest_path(self):
        """Cycles' limit on path length, that of reflections: facets mirror what lights do on other objects, as ours."""
        return max(self.bounces, 1) if self.parts == ("specular",) or self.light == "reflected" else self.bounces

    @property
    def has_texture(self):
        """Whether it can be baked; the others are pictures."""
        return not (self.referee or self.smooth_interface)

    @property
    def tracer(self):
        """Who renders it, as it is called in sentences."""
        return "mesograin-referee" if self.referee else "Cycles"


PARTS = ("specular", "subsurface")
"""What a grain shows: light that its surface reflects, and light that was inside."""

CHOSEN = (*TRANSLUCENT, AUTO.name)
"""Not of the kinds with cosine lobes, which not all models know that may be chosen."""

# The opaque kinds see direct light alone, as the models that they answer do; inside a medium everything counts.
# New kinds are added at the end: Blender files remember a choice of kinds by their numbers.
KINDS = {
    kind.name: kind
    for kind in (
        Kind("diffuse", "Cycles Diffuse BSDF", ("lambert",), 0, 64, False, 0.6, parts=()),
        Kind("glossy", "Cycles Glossy BSDF, GGX", ("conductor",), 0, 64, False, 0.6, parts=("specular",)),
        Kind("volume_index_matched", "Cycles volume, index-matched", CHOSEN, 1024, 128, True, 5.0),
        Kind("subsurface", "Cycles Subsurface Scattering, random walk", WITH_LOBES, 1024, 128, False, 5.0),
        Kind(
            "subsurface_burley",
            "Cycles Subsurface Scattering, Christensen-Burley",
            WITH_LOBES,
            1024,
            128,
            False,
            2.5,
        ),
        # A delta sun cannot be met through a smooth interface, and a small one hardly ever: 5 degrees are hopeless.
        Kind(
            "volume_dielectric",
            "Cycles glass with a volume",
            CHOSEN,
            1024,
            1024,
            True,
            12.0,
            judged_by="relative_l1_blocks",
            least_sun=math.radians(20.0),
            smooth_interface=True,
            parts=PARTS,
        ),
        Kind(
            "photon",
            "Photon Monte Carlo, smooth dielectric sphere",
            CHOSEN,
            0,
            256,
            False,
            6.0,
            referee=True,
        ),
        # What the random walk of `subsurface` is, on all of a path: that gives it up where light was diffuse before.
        Kind(
            "volume_lambert",
            "Cycles volume between Translucent surfaces",
            WITH_LOBES,
            1024,
            128,
            False,
            5.0,
        ),
        # Each grain with its own surface, under its own suns.
        Kind(
            "photon_scene",
            "Photon Monte Carlo, whole scene",
            CHOSEN,
            0,
            256,
            False,
            24.0,
            judged_by="relative_l1_blocks",
            referee=True,
            parts=(),
        ),
    )
}

COVERAGE = Kind("coverage", "Coverage", (), 0, 64, False, 0.3)
"""Not a reference of its own: how much of each pixel the geometry covers, for kinds whose alpha is not that."""

NORMAL = Kind("normal", "Normal", (), 0, 16, False, 0.3)
MIRRORED = Kind("mirrored", "Mirrored view", (), 0, 16, False, 0.3)
"""Nor are these: the normal n, and the way to the viewer mirrored at it, in world space, as 0.5 + 0.5 n."""


def default_kind(model, part=None):
    """Name of the reference that answers this model, or a part of it, when none is asked for; None if none does."""
    return next((kind.name for kind in KINDS.values() if model in kind.models and has(kind.name, part)), None)


def has(kind, part):
    """Whether a kind of reference has a part, or None for the whole."""
    return part is None or part in KINDS[kind].parts


def missing_part(kind, part):
    """One sentence on why a kind of reference has no such part, and which have it; no full stop."""
    only = KINDS[kind].parts
    if only:
        why = f"all that it shows is the {only[0]} part"
    elif KINDS[kind].referee:
        why = "all light between the grains is traced as one"
    else:
        why = "its light is reflected without direction, once"
    having = ", ".join(name for name in KINDS if has(name, part))
    return f"the reference {kind} has no {part} part: {why}; those that have it are {having}"


def kind_of(name, part=None):
    """The Kind that renders a part of a kind of reference, or None for the whole. Where all that it shows is that part,
    that is the whole."""
    whole = KINDS[name]
    if part is None or whole.parts == (part,):
        return whole
    if part == "subsurface":
        return replace(whole, title=f"{whole.title}, subsurface part", light="entered")
    # What the surface reflects knows nothing of the inside, so the roughness and the suns are the material's own.
    return replace(
        whole,
        title="Cycles rough dielectric, specular part",
        bounces=0,
        samples=64,
        cost=0.6,
        judged_by="relative_l1",
        least_sun=0.0,
        smooth_interface=False,
        light="reflected",
        recipe="dielectric_specular",
    )


def our_side(kind, features, part=None):
    """The Mesograin parameters that make our side solve what this kind of reference solves, as {name: value}; a value
    may be a function of a material's GrainValues: `of_material`."""
    if kind == "volume_dielectric" and part == "specular":
        # Nothing comes back from inside a medium that does not scatter.
        return {"boundary": "dielectric", "specular": True, "masking": features.glossy_masking, "sigma_s": (0.0,) * 3}
    if kind == "glossy":
        return {"masking": features.glossy_masking}
    if kind == "volume_index_matched":
        return {"boundary": "index_matched"}
    # Where light was diffuse before, Cycles takes the node's radius for nothing (PATH_RAY_DIFFUSE_ANCESTOR in its
    # closures): a Lambert surface of its colour is left.
    if kind == "subsurface":
        return {"boundary": "lambert_refracted" if features.subsurface_refracts else "lambert_lambert",
                "reflectance_to_others": inversion.walk_colour}
    if kind == "subsurface_burley":
        return {"boundary": "lambert_lambert", "reflectance_to_others": inversion.profile_colour}
    if kind == "volume_lambert":
        return {"boundary": "lambert_lambert"}
    if kind in ("volume_dielectric", "photon"):
        return {"boundary": "dielectric", "roughness": 0.0, "specular": False}
    return {}


def of_material(chosen, parameters):
    """`chosen`, as `our_side` has it, for a material of {name: value}, coefficients per scene unit."""
    if not any(map(callable, chosen.values())):
        return dict(chosen)
    values = GrainValues.from_parameters({**parameters, **chosen})
    return {name: value(values) if callable(value) else value for name, value in chosen.items()}
