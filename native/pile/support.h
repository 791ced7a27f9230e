// How far a grain reaches along a direction, whatever its shape: what lies beyond does not touch it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <vector>

namespace mesograin::pile {

/// Kept at places of a cube around the grain. How far it reaches along a vector is a convex function of the vector, and
/// so never more than between those places.
class Support {
 public:
  /// Of a ball.
  explicit Support(double radius) : radius_(static_cast<float>(radius)) {}

  explicit Support(const std::vector<glm::dvec3>& vertices);

  /// Along a direction of length 1; too far by little, and never too short.
  float operator()(const glm::vec3& direction) const {
    if (nodes_.empty()) return radius_;
    const glm::vec3 size(std::abs(direction.x), std::abs(direction.y), std::abs(direction.z));
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const float length = size[axis];
    const float u = to_node(direction[(axis + 1) % 3] / length);
    const float v = to_node(direction[(axis + 2) % 3] / length);
    const int i = static_cast<int>(u);
    const int j = static_cast<int>(v);
    const float* corner = &nodes_[number(2 * axis + (direction[axis] < 0.0F ? 1 : 0), i, j)];
    const float along = u - static_cast<float>(i);
    const float below = corner[0] + along * (corner[1] - corner[0]);
    const float above = corner[nodes_along] + along * (corner[nodes_along + 1] - corner[nodes_along]);
    return length * (below + (v - static_cast<float>(j)) * (above - below));
  }

 private:
  static constexpr int cells = 12;  // along a side of the cube
  static constexpr int nodes_along = cells + 1;

  static float to_node(float place) {
    constexpr float last = cells - 1e-4F;
    return std::min(0.5F * static_cast<float>(cells) * (place + 1.0F), last);
  }
  static std::size_t number(int side, int i, int j) {
    constexpr std::size_t along = nodes_along;
    return (static_cast<std::size_t>(side) * along + static_cast<std::size_t>(j)) * along + static_cast<std::size_t>(i);
  }

  float radius_ = 0.0F;
  std::vector<float> nodes_;  // none: a ball
};

}  // namespace mesograin::pile
