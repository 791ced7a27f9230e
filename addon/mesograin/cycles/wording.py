# What commands say, as it is read in panels and on pages: with labels for identifiers.
"""See `in_labels`."""

from ..schema import labels
from .kinds import KINDS

LABELS = {**labels.LABELS, **{kind.name: kind.label for kind in KINDS.values()}}

TRACERS = {kind.name: kind.tracer for kind in KINDS.values()}
"""Who renders a kind of reference, by its name."""


def in_labels(sentence):
    """A sentence with the label of each model, choice and kind of reference for its identifier."""
    return labels.in_labels(sentence, LABELS)
