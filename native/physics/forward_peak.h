// Forward-peaked scattering in two parts: a peak that goes straight on, and a broader rest.
#pragma once

#include <vector>

#include "physics/medium.h"

namespace mesograin::physics {

/// The share of scattering that counts as none, so that the rest is another Henyey-Greenstein function that keeps the
/// first two moments: g^2, and g/(1+g) is left (Joseph, Wiscombe & Weinman 1976 eq. 5). Backward scattering has no
/// peak.
struct ForwardPeak {
  explicit ForwardPeak(double g);

  double share;
  double rest;  ///< 1 - share, never the difference
  double rest_g;
};

/// Light scattered once in the sense of model 3's march, in a half-space: scattered as it is in the medium, from light
/// that nothing has met before, or scattered by the rest, from light that has met the peak; on its way out
/// it may meet the peak. (mu_i' + mu_o') times the azimuthally averaged BRDF, as HalfSpace::interior_table; a row for
/// each of `mu_out`, a column for each of `mu_in`. `phase_g` shapes the phase function, the medium's g the peak.
std::vector<double> marched_in_half_space(const Medium& medium, double phase_g, const std::vector<double>& mu_in,
                                          const std::vector<double>& mu_out);

}  // namespace mesograin::physics
