// How far a place is from a grain's surface: distances on a grid around a closed mesh, less than 0 inside.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "pile/triangles.h"

namespace mesograin::pile {

class Field {
 public:
  struct Value {
    float distance;
    glm::vec3 outwards;  ///< of length 1
  };

  /// Known up to `margin` from the mesh's bounds, farther away too large.
  Field(const Triangles& mesh, double margin);

  Value at(const glm::vec3& place) const;

  /// As `at` has it, without the direction.
  float distance(const glm::vec3& place) const;

 private:
  // Where a place is between nodes, and the lowest of the eight around it.
  struct Cell {
    const float* corner;
    glm::vec3 along;
    float beyond;  // how far the place is outside the grid
  };

  std::size_t number(int x, int y, int z) const {
    const auto row = static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) + static_cast<std::size_t>(y);
    return row * static_cast<std::size_t>(size_[0]) + static_cast<std::size_t>(x);
  }
  float& node(int x, int y, int z) { return nodes_[number(x, y, z)]; }
  void measure(const Triangles& mesh);
  void tell_inside(const Triangles& mesh);
  Cell cell(const glm::vec3& place) const;

  glm::dvec3 lower_{0.0};
  double step_ = 1.0;
  int size_[3] = {2, 2, 2};
  std::vector<float> nodes_;
};

}  // namespace mesograin::pile
