// What a rough surface of facets sends back of light from everywhere, for shaders that make up for what is lost.
#pragma once

#include <vector>

#include "physics/table.h"
#include "scene/material.h"

namespace mesograin::physics {

/// A row for each of `roughnesses`, the square roots of GGX alphas; columns at the cosines 0, ..., 1 of the viewer's
/// direction, evenly in their roots. Red: the directional albedo of one bounce off facets that absorb nothing (Turquin,
/// "Practical multiple scattering compensation for microfacet models", 2019); green: that of facets of relative index
/// `eta`; blue: red's mean over the projected hemisphere.
Table facet_energy(double eta, const std::vector<double>& roughnesses, scene::Masking masking);

}  // namespace mesograin::physics
