// Reflectance and transmittance of a slab, for many albedos at once, by scattering order.
#pragma once

#include <vector>

#include "batches.h"
#include "planar_incidence.h"

namespace mesograin::referee {

struct SlabCase {
  double thickness = 1;  ///< in mean free paths
  double eta = 1;
  double g = 0;
  PlanarIncidence incidence{};
  std::vector<double> albedos{};
};

/// All per unit of flux transmitted into the slab. `ballistic` is order 0, whatever the albedo.
struct SlabSide {
  Estimate ballistic;
  std::vector<Estimate> single;
  std::vector<Estimate> scattered;  ///< orders >= 1
};

struct SlabResult {
  SlabSide reflected, transmitted;
};

SlabResult trace_slab(const SlabCase& setup, const Effort& effort);

}  // namespace mesograin::referee
