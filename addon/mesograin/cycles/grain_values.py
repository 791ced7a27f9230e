# A grain's parameters as plain numbers per scene unit, so that what Cycles is told can be worked out without Blender.
"""See `GrainValues`."""

from dataclasses import dataclass


@dataclass(frozen=True)
class GrainValues:
    """A material in the units of the scene.

    reflectance: linear RGB in [0, 1]: Lambert's albedo, the conductor's Fresnel reflectance.
    sigma_a, sigma_s: linear RGB, per scene unit, `scale` already multiplied in.
    g: mean cosine of the Henyey-Greenstein phase function. eta: relative index of refraction. roughness: GGX alpha.
    """

    reflectance: tuple = (0.5, 0.5, 0.5)
    sigma_a: tuple = (0.1, 0.1, 0.1)
    sigma_s: tuple = (0.9, 0.9, 0.9)
    g: float = 0.0
    eta: float = 1.3
    roughness: float = 0.0

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
