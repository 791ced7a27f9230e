// A ray against a box along the axes.
#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace mesograin::referee {

struct Box {
  glm::dvec3 lower, upper;

  /// Where a ray enters it, infinity if it misses it or reaches it only beyond `furthest`; `inverse` of its direction.
  double entry(const glm::dvec3& origin, const glm::dvec3& inverse, double furthest) const {
    const glm::dvec3 a = (lower - origin) * inverse, b = (upper - origin) * inverse;
    const glm::dvec3 near = glm::min(a, b), far = glm::max(a, b);
    const double begin = std::max({near.x, near.y, near.z, 0.0}), end = std::min({far.x, far.y, far.z, furthest});
    return begin <= end * (1 + 1e-12) ? begin : std::numeric_limits<double>::infinity();
  }
};

}  // namespace mesograin::referee
