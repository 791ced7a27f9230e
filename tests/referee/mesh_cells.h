// A mesh's box in equal cells, for what lies along straight ways through it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "mesh_body.h"

namespace mesograin::referee {

class MeshCells {
 public:
  /// `wanted`: along the longest side.
  MeshCells(const MeshBody& body, double wanted);

  std::size_t count() const {
    return static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(size_.z);
  }

  /// Of a place, or the nearest to it.
  std::size_t at(const glm::dvec3& place) const;

  /// visit(cell, begin, end) of every piece of a way (Amanatides and Woo, "A fast voxel traversal algorithm", 1987).
  template <class Visit>
  void follow(const glm::dvec3& place, const glm::dvec3& direction, double length, const Visit& visit) const {
    const glm::dvec3 from = (place - lower_) / side_;
    glm::ivec3 at = glm::clamp(glm::ivec3(glm::floor(from)), glm::ivec3(0), size_ - 1);
    glm::dvec3 next, step;
    for (int axis = 0; axis < 3; ++axis) {
      const double speed = direction[axis] / side_;
      step[axis] = speed == 0 ? std::numeric_limits<double>::infinity() : 1 / std::abs(speed);
      next[axis] = speed == 0 ? std::numeric_limits<double>::infinity()
                              : ((speed > 0 ? at[axis] + 1 : at[axis]) - from[axis]) / speed;
    }
    const std::size_t row = static_cast<std::size_t>(size_.x), plane = row * static_cast<std::size_t>(size_.y);
    double begin = 0;
    while (begin < length) {
      const int axis = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
      const double end = std::min(next[axis], length);
      if (end > begin)
        visit(static_cast<std::size_t>(at.z) * plane + static_cast<std::size_t>(at.y) * row +
                  static_cast<std::size_t>(at.x),
              begin, end);
      begin = std::max(begin, end);
      next[axis] += step[axis];
      at[axis] += direction[axis] > 0 ? 1 : -1;
      if (at[axis] < 0 || at[axis] >= size_[axis]) return;
    }
  }

  /// The part of each that is inside the mesh.
  std::vector<double> volumes(const MeshBody& body) const;

 private:
  glm::dvec3 lower_;
  double side_;
  glm::ivec3 size_;
};

}  // namespace mesograin::referee
