// Reflectance of a half-space, for many albedos at once: totals by scattering order, exit lobe, radial profile.
#pragma once

#include <vector>

#include "batches.h"
#include "planar_incidence.h"

namespace mesograin::referee {

struct HalfSpaceCase {
  double eta = 1;
  double g = 0;
  PlanarIncidence incidence{};
  std::vector<double> albedos{};
  std::vector<double>
      radii;          ///< edges of the radial profile's rings, ascending from 0, in mean free paths; empty: no profile
  int lobe_bins = 0;  ///< of the exit lobe over the cosine outside, equal widths
};

/// All per unit of flux *transmitted* into the half-space; indices: [albedo], [albedo][bin].
struct HalfSpaceResult {
  std::vector<Estimate> single;
  std::vector<Estimate> multiple;
  std::vector<Estimate> total;
  std::vector<std::vector<Estimate>> profile;  ///< flux leaving through each ring, orders >= 1
  std::vector<std::vector<Estimate>> lobe;     ///< flux leaving into each bin of the cosine outside, orders >= 1
};

HalfSpaceResult trace_half_space(const HalfSpaceCase& setup, const Effort& effort);

}  // namespace mesograin::referee
