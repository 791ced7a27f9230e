# What is to be compared: one request, unfolded into cases.
"""See `Request` and `cases`."""

from dataclasses import dataclass, field
from pathlib import Path

from ...cycles import kinds
from ...cycles.cache import Cache
from .arguments import MOST_SEEDS


@dataclass(frozen=True)
class Case:
    """One model against one kind of reference, or against a part of it."""

    model: str
    reference: str
    part: str = None

    @property
    def name(self):
        return ".".join(filter(None, (self.model, self.reference, self.part)))

    @property
    def kind(self):
        """The kinds.Kind that renders the reference."""
        return kinds.kind_of(self.reference, self.part)


@dataclass(frozen=True)
class Request:
    """What to compare. settings: {material parameter: value} for every material on both sides, coefficients in 1/mm.
    size: (width, height), or None for the scene's. reference_samples: per pixel and seed, None for the kind's default.
    references: names in `kinds.KINDS`, or None for each model's default. seeds: of the reference, independent of each
    other. until: adds seeds until the reference's noise is at most this fraction of the measured error, but no more
    than `most_seeds` in all; None for `seeds` as they are. masks: of `mask_names.parse`, applied in this order.
    part: of `kinds.PARTS`, or None for the whole. controls: whether the test itself is tested.
    exchange: of the schema's choices, or None for the scene's own. command: the line that repeats it."""

    models: tuple
    out: Path
    references: tuple = None
    size: tuple = None
    samples: int = 64
    reference_samples: int = None
    seeds: int = 2
    until: float = None
    most_seeds: int = MOST_SEEDS
    masks: tuple = ()
    part: str = None
    controls: bool = False
    settings: dict = field(default_factory=dict)
    exchange: str = None
    frames: int = 9
    cache: Cache = field(default_factory=Cache)
    command: str = ""


def cases(models, references=None, part=None):
    """The cases asked for: each model with each of `references` that answers it, or with its default one; of a part,
    with those that have it."""
    found = []
    for model in dict.fromkeys(models):
        kind = kinds.default_kind(model, part)
        asked = ([kind] if kind else []) if references is None else dict.fromkeys(references)
        answering = [kind for kind in asked if model in kinds.KINDS[kind].models and kinds.has(kind, part)]
        found += [Case(model, kind, part) for kind in answering]
    return found
