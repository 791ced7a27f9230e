// Paths that carry little go on seldom, and then for those that ended.
#pragma once

#include "rng.h"

namespace mesograin::referee {

/// Whether a path goes on, its weight then no less than a twentieth (Arvo and Kirk, "Particle transport and image
/// synthesis", 1990).
inline bool survives(double& weight, Rng& rng) {
  constexpr double least = 0.05;
  if (weight >= least) return true;
  if (!(rng.uniform() * least < weight)) return false;
  weight = least;
  return true;
}

}  // namespace mesograin::referee
