// Boxes around what is drawn.
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace mesograin::render {

/// A box with the world's axes.
struct Bounds {
  glm::dvec3 lower{1e300};
  glm::dvec3 upper{-1e300};

  bool empty() const { return !(lower.x <= upper.x); }
  void include(const glm::dvec3& middle, double radius) {
    lower = glm::min(lower, middle - radius);
    upper = glm::max(upper, middle + radius);
  }
  void include(const Bounds& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
  }
};

}  // namespace mesograin::render
