# A grain's parameters as plain numbers per scene unit, so that what Cycles is told can be worked out without Blender.
"""See `GrainValues`."""

from dataclasses import dataclass

from ..schema.parameters import PARAMETERS


@dataclass(frozen=True)
class GrainValues:
    """A material in the units of the scene.

    reflectance: linear RGB in [0, 1]: Lambert's albedo, the conductor's Fresnel reflectance.
    sigma_a, sigma_s: linear RGB, per scene unit, `scale` already multiplied in.
    g: mean cosine of the Henyey-Greenstein phase function. eta: relative index of refraction. roughness: GGX alpha.
    """

    reflectance: tuple = PARAMETERS["reflectance"].default
    sigma_a: tuple = PARAMETERS["sigma_a"].default
    sigma_s: tuple = PARAMETERS["sigma_s"].default
    g: float = PARAMETERS["g"].default
    eta: float = PARAMETERS["eta"].default
    roughness: float = PARAMETERS["roughness"].default

    @classmethod
    def from_parameters(cls, parameters):
        """From {name: value}, coefficients per scene unit and a `scale` that multiplies them; ignores other names."""
        return cls(
            reflectance=tuple(parameters["reflectance"]),
            sigma_a=tuple(parameters["scale"] * value for value in parameters["sigma_a"]),
            sigma_s=tuple(parameters["scale"] * value for value in parameters["sigma_s"]),
            g=parameters["g"],
            eta=parameters["eta"],
            roughness=parameters["roughness"],
        )

    @property
    def sigma_t(self):
        """Extinction coefficient, RGB, per scene unit."""
        return tuple(a + s for a, s in zip(self.sigma_a, self.sigma_s))

    @property
    def albedo(self):
        """Single-scattering albedo sigma_s / sigma_t, RGB; 0 where nothing interacts."""
        return tuple(s / t if t > 0.0 else 0.0 for s, t in zip(self.sigma_s, self.sigma_t))
