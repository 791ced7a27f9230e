// Measures the cells by straight lines.
#include "mesh_cells.h"

#include <glm/vector_relational.hpp>
#include <optional>

namespace mesograin::referee {

MeshCells::MeshCells(const MeshBody& body, double wanted) : lower_(body.lower()) {
  const glm::dvec3 extent = body.upper() - body.lower();
  side_ = std::max({extent.x, extent.y, extent.z}) / wanted;
  size_ = glm::ivec3(glm::ceil(extent / side_)) + 1;
}

std::size_t MeshCells::at(const glm::dvec3& place) const {
  const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor((place - lower_) / side_)), glm::ivec3(0), size_ - 1);
  return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(cell.y)) *
             static_cast<std::size_t>(size_.x) +
         static_cast<std::size_t>(cell.x);
}

// By straight lines along the axes, sixteen through every cell's side.
std::vector<double> MeshCells::volumes(const MeshBody& body) const {
  constexpr int finer = 4;
  std::vector<double> inside(count());
  const double share = side_ * side_ / (3.0 * finer * finer);
  for (int axis = 0; axis < 3; ++axis) {
    const int other = (axis + 1) % 3, third = (axis + 2) % 3;
    glm::dvec3 direction(0);
    direction[axis] = 1;
    for (int i = 0; i < finer * size_[other]; ++i)
      for (int j = 0; j < finer * size_[third]; ++j) {
        glm::dvec3 place = lower_;
        // Not where meshes like to have their edges.
        place[axis] -= side_;
        place[other] += (i + 0.4871) * side_ / finer;
        place[third] += (j + 0.5133) * side_ / finer;
        while (const std::optional<MeshHit> hit = body.first_hit(place, direction)) {
          if (hit->normal[axis] > 0)
            follow(place, direction, hit->distance,
                   [&](std::size_t at, double begin, double end) { inside[at] += share * (end - begin); });
          place += hit->distance * direction;
        }
      }
  }
  return inside;
}

}  // namespace mesograin::referee
