// What a pile rests on and what holds it: a mesh, a floor below it, and walls.
#pragma once

#include <cmath>
#include <glm/vec2.hpp>
#include <limits>

#include "pile/triangles.h"

namespace mesograin::pile {

/// The floor is a plane without end. A mesh on it has two sides, and whatever is on one of them stays there.
/// `inside`: grains begin in the room that the mesh encloses, as many as fit, where they fall on it otherwise.
struct Ground {
  Mesh mesh;
  bool inside = false;
  double floor = 0.0;
};

/// Upright walls at plus and minus `half` of each axis; without any, the pile runs out as far as friction lets it.
struct Walls {
  glm::dvec2 half{std::numeric_limits<double>::infinity()};

  bool any() const { return std::isfinite(half.x) && std::isfinite(half.y); }
};

}  // namespace mesograin::pile
