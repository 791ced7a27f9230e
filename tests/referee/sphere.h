// Exitance of a sphere in parallel light, for many albedos at once, by the cosine between normal and light.
#pragma once

#include <vector>

#include "batches.h"

namespace mesograin::referee {

enum class Entry {
  refracted,  ///< through the smooth interface (straight on where eta is 1)
  lambert,    ///< into a cosine lobe below the surface, whatever the angle
};

struct SphereCase {
  double radius = 1;  ///< in mean free paths
  double eta = 1;
  double g = 0;
  Entry entry = Entry::refracted;
  std::vector<double> albedos{};
  int bins = 40;  ///< of the cosine, equal widths from -1 to 1 (so of equal area)
};

/// Exitances are flux leaving per area, for unit irradiance on a plane that faces the light; totals are flux leaving
/// per flux incident on the sphere. Indices: [bin], [albedo], [albedo][bin].
struct SphereResult {
  Estimate specular;                             ///< total reflected at entry, never inside
  std::vector<Estimate> ballistic;               ///< exitance of order 0, whatever the albedo
  std::vector<Estimate> unit_single;             ///< exitance of order 1 at albedo 1: times the albedo it is order 1
  std::vector<std::vector<Estimate>> scattered;  ///< exitance of orders >= 1
  Estimate ballistic_total, unit_single_total;
  std::vector<Estimate> scattered_total;
  std::vector<Estimate> dark_total;  ///< orders >= 1 leaving at cosines below -1/2
};

SphereResult trace_sphere(const SphereCase& setup, const Effort& effort);

}  // namespace mesograin::referee
