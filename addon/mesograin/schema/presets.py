# Materials that an artist starts from: grains by estimate from optical constants, and two tables of measurements.
"""See `Preset`; GROUPS has them by where they come from."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Preset:
    """One material: absorption and reduced scattering sigma_s (1 - g) for R, G and B in 1/mm; eta relative to air."""

    name: str
    sigma_s_reduced: tuple
    sigma_a: tuple
    eta: float = 1.3
    g: float = 0.0
    roughness: float = 0.0
    boundary: str = "dielectric"
    note: str = ""

    @property
    def identifier(self):
        return self.name.lower().replace(" ", "_").replace("(", "").replace(")", "")

    @property
    def sigma_s(self):
        return tuple(channel / (1.0 - self.g) for channel in self.sigma_s_reduced)


@dataclass(frozen=True)
class Group:
    """Presets of one origin. measured: from a table of measurements; else estimates."""

    title: str
    source: str
    measured: bool
    presets: tuple


# Absorption of ice: 4 pi k / wavelength at 620, 550 and 450 nm (Warren and Brandt, "Optical constants of ice from the
# ultraviolet to the microwave", JGR 2008).
ICE = (1.6e-4, 5.2e-5, 2.6e-6)
# Of snow, 300 kg/m^3 of grains of 0.1 mm radius: extinction 3 rho / (2 rho_ice r) = 4.9 per mm, g 0.89, and ice's
# absorption times its share of the volume, 0.33, times 1.6 for the way within a grain (Wiscombe and Warren, "A Model
# for the Spectral Albedo of Snow", 1980). Between the crystals is air: it has no surface of its own.
SNOW_SIGMA_S, SNOW_G = 4.9, 0.89

# Indices: quartz 1.544 (Ghosh 1999), rock salt 1.544 (Li 1976), sucrose 1.558 (mean of its three), starch 1.53,
# soda-lime glass 1.52 (Rubin 1985). Inclusions, stain and frosting differ from grain to grain: their scattering,
# absorption and roughness are chosen by eye for grains of a millimetre.
GRAINS = Group(
    "Grains (estimates)", "estimated from refractive index and absorption; scattering chosen by eye", False, (
        Preset("Sand", (0.9, 0.9, 0.9), (0.06, 0.17, 0.45), 1.544, roughness=0.3, note="Quartz stained by iron"),
        Preset("Salt", (0.5, 0.5, 0.5), (0.0001, 0.0001, 0.0001), 1.544, roughness=0.1, note="Rock salt with brine"),
        Preset("Sugar", (0.7, 0.7, 0.7), (0.0001, 0.0001, 0.0002), 1.558, roughness=0.1, note="Sucrose"),
        Preset("Snow", tuple(SNOW_SIGMA_S * (1.0 - SNOW_G) for _ in range(3)),
               tuple(1.6 * 0.33 * channel for channel in ICE), 1.0, g=SNOW_G, boundary="index_matched",
               note="Packed snow, whose crystals are too small to be seen"),
        Preset("Ice", (0.02, 0.02, 0.02), ICE, 1.31, roughness=0.02, note="Clear, with few bubbles"),
        Preset("Rice", (2.0, 2.0, 2.0), (0.003, 0.006, 0.03), 1.53, roughness=0.4, note="Polished"),
        Preset("Glass beads", (0.02, 0.02, 0.02), (0.006, 0.003, 0.005), 1.52, note="Soda-lime glass"),
    ))

# Figure 5. The paper gives one index, 1.3, and 1.5 for marble, which reproduces its column of diffuse reflectances; it
# measured reduced scattering alone, so g is 0.
JENSEN = Group(
    "Jensen et al. 2001", "measured: Jensen, Marschner, Levoy and Hanrahan, SIGGRAPH 2001, figure 5", True, (
        Preset("Apple", (2.29, 2.39, 1.97), (0.0030, 0.0034, 0.046)),
        Preset("Chicken 1", (0.15, 0.21, 0.38), (0.015, 0.077, 0.19)),
        Preset("Chicken 2", (0.19, 0.25, 0.32), (0.018, 0.088, 0.20)),
        Preset("Cream", (7.38, 5.47, 3.15), (0.0002, 0.0028, 0.0163)),
        Preset("Ketchup", (0.18, 0.07, 0.03), (0.061, 0.97, 1.45)),
        Preset("Marble", (2.19, 2.62, 3.00), (0.0021, 0.0041, 0.0071), 1.5),
        Preset("Potato", (0.68, 0.70, 0.55), (0.0024, 0.0090, 0.12)),
        Preset("Skim milk", (0.70, 1.22, 1.90), (0.0014, 0.0025, 0.0142)),
        Preset("Skin 1", (0.74, 0.88, 1.01), (0.032, 0.17, 0.48)),
        Preset("Skin 2", (1.09, 1.59, 1.79), (0.013, 0.070, 0.145)),
        Preset("Spectralon", (11.6, 20.4, 14.9), (0.0, 0.0, 0.0)),
        Preset("Whole milk", (2.55, 3.21, 3.77), (0.0011, 0.0024, 0.014)),
    ))

# Table 2, undiluted. It has a g for each channel; a grain has one, their mean, and keeps each channel's reduced
# scattering.
NARASIMHAN = Group(
    "Narasimhan et al. 2006", "measured: Narasimhan, Gupta, Donner, Ramamoorthi, Nayar and Jensen, SIGGRAPH 2006,"
    " table 2", True, (
        Preset("Milk (lowfat)", (0.89187, 1.5136, 2.532), (0.002875, 0.00575, 0.0115), 1.33, g=0.898),
        Preset("Milk (reduced)", (2.4858, 3.1669, 4.5214), (0.0025556, 0.0051111, 0.012778), 1.33, g=0.787),
        Preset("Milk (regular)", (4.5513, 5.8294, 7.136), (0.0015333, 0.0046, 0.019933), 1.33, g=0.715),
        Preset("Soy milk (regular)", (0.59223, 0.73866, 1.4693), (0.0019167, 0.0095833, 0.065167), 1.33, g=0.854),
        Preset("Chocolate milk (regular)", (1.4585, 2.1289, 2.9527), (0.010063, 0.043125, 0.14375), 1.33, g=0.835),
    ))

GROUPS = (GRAINS, JENSEN, NARASIMHAN)
BY_IDENTIFIER = {preset.identifier: preset for group in GROUPS for preset in group.presets}
