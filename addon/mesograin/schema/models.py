# The models: what each is called, what it answers, and what it takes.
"""See `Model`; MODELS has them by name, in the order in which Blender files number them. CHOICES has AUTO besides."""

from dataclasses import dataclass

from . import AUTO as _AUTO
from . import GRAIN


@dataclass(frozen=True)
class Model:
    """One model. shaders/models/NAME.glsl and native/models/NAME_inputs.cpp are the rest of it.

    name: everywhere. label, sentence: for people. translucent: light goes through it. kinds: of `material.kind`
    in a scene's JSON, that it answers. parameters: that it reads. preferred: it stands for its kinds where none is
    named. profiles: of the parameter `profile`, that it knows; empty for all. grain_radius: its inputs depend on the
    grain's size. light_maps: it asks what the light sees of the grain. taps: it takes samples of the lit surface, whose
    number may be chosen. mesh: light's way through the grain's own mesh is its input, which knows no cosine lobes.
    near_lamps: the model that draws a single grain of it where a lamp is near; empty for itself.
    """

    name: str
    label: str
    sentence: str
    translucent: bool
    kinds: tuple
    parameters: tuple
    preferred: bool = False
    profiles: tuple = ()
    grain_radius: bool = False
    light_maps: bool = False
    taps: bool = False
    mesh: bool = False
    near_lamps: str = ""


def _model(entry):
    return Model(**{key: tuple(value) if isinstance(value, list) else value for key, value in entry.items()})


MODELS = {entry["name"]: _model(entry) for entry in GRAIN["models"]}
NAMES = tuple(MODELS)
OPAQUE = tuple(name for name, model in MODELS.items() if not model.translucent)
TRANSLUCENT = tuple(name for name, model in MODELS.items() if model.translucent)
# Those that know the cosine lobes of Cycles' Subsurface Scattering node.
WITH_LOBES = tuple(name for name in TRANSLUCENT if not MODELS[name].mesh)
# What stands for a translucent grain where no model was chosen.
PREFERRED = next(name for name, model in MODELS.items() if model.translucent and model.preferred)

_CHOSEN = [model for model in MODELS.values() if model.translucent]
AUTO = Model(
    _AUTO["name"], _AUTO["label"], _AUTO["sentence"], translucent=True, kinds=MODELS[PREFERRED].kinds,
    parameters=MODELS[PREFERRED].parameters,
    profiles=tuple(name for name in MODELS[PREFERRED].profiles
                   if all(name in model.profiles for model in _CHOSEN if model.profiles)))
"""No model, but the choice of one for each object: it takes what all of those take that may be chosen."""

CHOICES = {**MODELS, AUTO.name: AUTO}
"""What a material's model may be."""
