// The room that a mesh encloses: where nothing comes to from outside without going through the mesh.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "pile/triangles.h"

namespace mesograin::pile {

/// Of several rooms the widest: a bottle's is within its glass. Throws Error if there is none. The mesh must outlive
/// it.
class Room {
 public:
  explicit Room(const Triangles& surface);

  /// Whether a ball of this radius fits there.
  bool fits(const glm::dvec3& place, double radius) const;

 private:
  static constexpr std::uint32_t unknown = 0;
  static constexpr std::uint32_t outside = 1;

  std::size_t number(const std::array<int, 3>& cell) const;
  glm::dvec3 middle(const std::array<int, 3>& cell) const;
  std::size_t spread(std::array<int, 3> from, std::uint32_t label);

  const Triangles& surface_;
  glm::dvec3 lower_;
  double step_;
  std::array<int, 3> size_{};
  std::vector<std::uint32_t> labels_;  // of cells: which of the rooms each is in
  std::uint32_t widest_ = outside;
};

}  // namespace mesograin::pile
