// Where grains are before they fall: in loose layers, one above the other, over what shall catch them.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "pile/ground.h"
#include "pile/shape.h"

namespace mesograin::pile {

struct Grain {
  glm::dvec3 middle;
  glm::dquat turn;
  double size;  ///< over the shape's
  const Shape* shape;
};

/// Gives each grain its middle and its turn. Long and flat ones lie nearly level, as they do at last.
void place(std::vector<Grain>& grains, const Triangles& surface, double floor, const Walls& walls, std::uint64_t seed);

}  // namespace mesograin::pile
