// Where along its way a beam feeds one part of the scattered light.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/body/body_medium.h"
#include "physics/quadrature.h"

namespace mesograin::physics {

/// Calls visit(t, weight) for nodes that integrate a function times what the beam that feeds `part` loses on a path of
/// `length`. Cubes of a variable: dense where a thick grain takes its light in, and reaching to the far end, which the
/// beam itself lights in a dark grain.
template <typename Visit>
void for_depths(const DiffusionPart& part, double length, Visit visit) {
  constexpr int depth_nodes = 16;
  constexpr double nothing_left = 50.0;
  const double end = std::min(length, nothing_left / part.spread);
  const double lost = std::expm1(-part.extinction * length) / std::expm1(-part.spread * length);
  for (const QuadratureNode& node : gauss_legendre(depth_nodes)) {
    const double t = end * node.x * node.x * node.x;
    visit(t, 3.0 * node.x * node.x * node.weight * end * lost * part.spread * std::exp(-part.spread * t));
  }
}

}  // namespace mesograin::physics
