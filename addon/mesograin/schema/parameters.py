# The parameters of a grain's material: names, ranges, units, defaults, and one sentence each.
"""See `Parameter`; PARAMETERS has them by name."""

import math
from dataclasses import dataclass

from . import GRAIN, models
from . import SCENE as _SCENE


@dataclass(frozen=True)
class Choice:
    """One of the values that a choice may take."""

    name: str
    label: str
    sentence: str


@dataclass(frozen=True)
class Parameter:
    """One parameter.

    kind: 'number', 'rgb' (three numbers, linear), 'switch' or 'choice'. least, most: allowed; soft_least, soft_most: as
    far as a slider goes. precision: decimals that a slider shows. unit: '' for none, '1/length' for one per length of
    whoever asks. note: what else is worth knowing. required: a scene in JSON must say it. decided_by: 'command' or
    'reference' where a comparison leaves no choice.
    """

    name: str
    label: str
    kind: str
    default: object
    sentence: str
    note: str = ""
    least: float = -math.inf
    most: float = math.inf
    soft_least: float = None
    soft_most: float = None
    precision: int = 3
    unit: str = ""
    choices: tuple = ()
    required: bool = False
    decided_by: str = ""

    @property
    def allowed(self):
        """What it takes, in words."""
        between = f"from {self.least:g} to {self.most:g}"
        return {
            "number": f"a number {between}",
            "rgb": f"a number or three of them, {between}",
            "switch": "true or false",
            "choice": "one of " + ", ".join(choice.name for choice in self.choices),
        }[self.kind]

    def check(self, value):
        """`value` as this parameter's: a float, three in a tuple, a bool or a name; None if it is not allowed. One
        number stands for three."""
        if self.kind == "switch":
            return value if isinstance(value, bool) else None
        if self.kind == "choice":
            return value if value in [choice.name for choice in self.choices] else None
        if self.kind == "number":
            return self._number(value)
        values = tuple(value) if isinstance(value, (list, tuple)) else (value,) * 3
        numbers = tuple(self._number(channel) for channel in values)
        return numbers if len(numbers) == 3 and None not in numbers else None

    def describe(self, length):
        """A sentence or more for a tooltip. length: the unit of length, such as 'mm'."""
        text = self.sentence
        if self.kind in ("number", "rgb"):
            text += f", in {self.unit.replace('length', length)}" if self.unit else ", without unit"
        return f"{text}. {self.note}" if self.note else text

    def _number(self, value):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not self.least <= value <= self.most:
            return None
        return float(value)


def _parameter(entry):
    entry = {key: tuple(value) if isinstance(value, list) else value for key, value in entry.items()}
    choices = [Choice(**choice) for choice in entry.pop("choices", ())]
    if entry["name"] == "model":
        choices = [Choice(model.name, model.label, model.sentence) for model in models.CHOICES.values()]
    return Parameter(**entry, choices=tuple(choices))


PARAMETERS = {entry["name"]: _parameter(entry) for entry in GRAIN["parameters"]}
SCENE = {entry["name"]: _parameter(entry) for entry in _SCENE}
"""What is said of a whole scene."""
SETTABLE = tuple(name for name, parameter in PARAMETERS.items() if not parameter.decided_by)
"""Those that a comparison may set; the reference or the command decides the others."""


COSINE_LOBES = ("lambert_lambert", "lambert_refracted")
"""Boundaries by which light enters as through Cycles' Subsurface Scattering node."""


def boundaries_of(model):
    """The names of the boundaries that a model can be given."""
    names = tuple(choice.name for choice in PARAMETERS["boundary"].choices)
    return tuple(name for name in names if name not in COSINE_LOBES) if models.CHOICES[model].mesh else names


def profiles_of(model):
    """The names of the profiles that a model can be given."""
    return models.CHOICES[model].profiles or tuple(choice.name for choice in PARAMETERS["profile"].choices)
