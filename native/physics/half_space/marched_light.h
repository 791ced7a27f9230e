// Light that a half-space scatters once, its phase function in two parts as model 3 marches through it.
#pragma once

#include <vector>

#include "physics/half_space/medium.h"

namespace mesograin::physics {

/// Light scattered once in the sense of model 3's march, in a half-space: scattered as it is in the medium, from light
/// that nothing has met before, or scattered by the rest, from light that has met the peak; on its way out
/// it may meet the peak. (mu_i' + mu_o') times the azimuthally averaged BRDF, as HalfSpace::interior_table; a row for
/// each of `mu_out`, a column for each of `mu_in`. `phase_g` shapes the phase function, the medium's g the peak.
std::vector<double> marched_in_half_space(const Medium& medium, double phase_g, const std::vector<double>& mu_in,
                                          const std::vector<double>& mu_out);

}  // namespace mesograin::physics
