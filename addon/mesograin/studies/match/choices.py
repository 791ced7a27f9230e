# What may be asked of a match, readable without numpy.
"""See `Asked`."""

from dataclasses import dataclass
from pathlib import Path

from ...cycles.kinds import KINDS
from ...schema.models import CHOICES, TRANSLUCENT

COEFFICIENTS = ("sigma_a", "sigma_s")
PARAMETERS = (*COEFFICIENTS, "g")
CORRECTIONS, MOST_CORRECTIONS = 5, 20
EXPOSURES = ("known", "free")
REFERENCES = tuple(name for name, kind in KINDS.items() if not kind.referee and set(kind.models) & set(TRANSLUCENT))
MODELS = tuple(name for name, model in CHOICES.items() if model.translucent)


@dataclass(frozen=True)
class Asked:
    """out: folder. material: name of the grains', None for the only one. parameters: of PARAMETERS, searched for.
    model: of MODELS that draws, None for the material's. reference: of REFERENCES, where Cycles rendered the picture
    with a material of its kind. exposure: of EXPOSURES. masks: of `keeping.keep`. size: the longer side of what is
    drawn, in pixels; samples: of each. corrections: how often Cycles tells by a picture of `reference` what our model
    is off, at most; traced_samples: of each of its pixels."""

    out: Path
    material: str = None
    parameters: tuple = COEFFICIENTS
    model: str = None
    reference: str = None
    exposure: str = EXPOSURES[0]
    masks: tuple = ()
    size: int = 128
    samples: int = 32
    corrections: int = 0
    traced_samples: int = 128

    def settings(self):
        """What match.json says was asked for."""
        return {"parameters": list(self.parameters), "reference": self.reference, "exposure": self.exposure,
                "masks": [f"{kind}:{','.join(map(str, what))}" if kind == "crop" else str(what)
                          for kind, what in self.masks],
                "longest_side": self.size, "samples": self.samples, "corrections": self.corrections,
                "traced_samples": self.traced_samples}
