// Where grains are before they fall: in loose layers, one above the other, over what shall catch them.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "pile/ground.h"
#include "pile/shape.h"

namespace mesograin::pile {

struct Grain {
  std::uint32_t number;  ///< in the order in which they were asked for
  glm::dvec3 middle;
  glm::dquat turn;
  double size;  ///< over the shape's
  const Shape* shape;
};

/// About as long as wide: turned anyhow, its corners seldom meet another's.
bool is_compact(const Shape& shape);

inline constexpr double compact_room = 0.85;  ///< that such a grain needs, over its reach: those that meet part at once

/// Any turn of a grain about as long as wide; others lie nearly level, as they do at last.
glm::dquat drawn_turn(const Shape& shape, std::mt19937_64& random);

/// Gives each grain its middle and its turn.
void place(std::vector<Grain>& grains, const Triangles& surface, double floor, const Walls& walls, std::uint64_t seed);

}  // namespace mesograin::pile
