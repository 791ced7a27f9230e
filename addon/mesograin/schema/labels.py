# What people read in the place of an identifier: the label by which a panel offers it.
"""See `of_model`, `of_choice` and `in_labels`."""

import re

from . import models, parameters


def of_model(name):
    """A model as sentences call it, 'Model 1': its label without what it explains. A name that is no model's stays."""
    known = models.CHOICES.get(name)
    return known.label.split(":")[0] if known else name


def of_choice(parameter, name):
    """The label of a choice of a parameter, such as boundary."""
    return next(choice.label for choice in parameters.PARAMETERS[parameter].choices if choice.name == name)


LABELS = {
    **{choice.name: choice.label for parameter in parameters.PARAMETERS.values() for choice in parameter.choices},
    **{name: of_model(name) for name in models.CHOICES},
}
"""Of models and of what parameters may be."""


def boundary(case):
    """Of a case's grains in a comparison, and of their own that it stands for, by their labels; "" if it says none."""
    label = LABELS.get(case["boundary"], case["boundary"])
    own = [of_choice("boundary", name) for name in case.get("own_boundaries", ())]
    return f"{label} instead of {', '.join(own)}" if own else label


def in_labels(sentence, labels):
    """A sentence that was written for a command line, with labels for identifiers. Those that are English words stay,
    and so do names in quotation marks and in paths. labels: {identifier: label}."""
    names = "|".join(sorted((name for name in labels if "_" in name), key=len, reverse=True))
    found = rf"(?<!\w)'[^']*'(?!\w)|(?<![\w./\\-])(?:{names})(?![\w/\\-]|\.\w)"
    return re.sub(found, lambda match: labels.get(match[0], match[0]), sentence)
