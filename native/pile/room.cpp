// A grid of cells: from one to the next goes what meets no triangle between their middles.
#include "pile/room.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "base/error.h"

namespace mesograin::pile {
namespace {

constexpr double cells_along = 64.0;  // along the longest side

}  // namespace

Room::Room(const Triangles& surface) : surface_(surface) {
  const glm::dvec3 span = surface.upper() - surface.lower();
  step_ = std::max({span.x, span.y, span.z}) / cells_along;
  // Lines between cells shall not run in faces that stand along an axis; the outermost cells are outside.
  lower_ = surface.lower() - step_ * glm::dvec3(1.31, 1.2718, 1.4142);
  for (int axis = 0; axis < 3; ++axis) size_[axis] = static_cast<int>(std::ceil(span[axis] / step_)) + 4;
  labels_.assign(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2], unknown);
  spread({0, 0, 0}, outside);
  std::size_t most = 0;
  std::uint32_t label = outside;
  for (int z = 0; z < size_[2]; ++z)
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x) {
        if (labels_[number({x, y, z})] != unknown) continue;
        const std::size_t count = spread({x, y, z}, ++label);
        if (count <= most) continue;
        most = count;
        widest_ = label;
      }
  if (most == 0)
    throw Error(
        "The mesh encloses no room: it must be closed for grains to lie inside. Fill its holes, or let them "
        "fall on it from above.");
}

std::size_t Room::number(const std::array<int, 3>& cell) const {
  const auto row = static_cast<std::size_t>(cell[2]) * size_[1] + static_cast<std::size_t>(cell[1]);
  return row * size_[0] + static_cast<std::size_t>(cell[0]);
}

glm::dvec3 Room::middle(const std::array<int, 3>& cell) const {
  return lower_ + step_ * glm::dvec3(cell[0], cell[1], cell[2]);
}

// Labels all that is reached from there; returns how many cells that are.
std::size_t Room::spread(std::array<int, 3> from, std::uint32_t label) {
  std::vector<std::array<int, 3>> waiting{from};
  labels_[number(from)] = label;
  std::size_t count = 0;
  while (!waiting.empty()) {
    const std::array<int, 3> cell = waiting.back();
    waiting.pop_back();
    ++count;
    for (int axis = 0; axis < 3; ++axis)
      for (const int by : {-1, 1}) {
        std::array<int, 3> next = cell;
        next[axis] += by;
        if (next[axis] < 0 || next[axis] == size_[axis] || labels_[number(next)] != unknown) continue;
        if (surface_.between(middle(cell), middle(next))) continue;
        labels_[number(next)] = label;
        waiting.push_back(next);
      }
  }
  return count;
}

bool Room::fits(const glm::dvec3& place, double radius) const {
  const glm::dvec3 cells = glm::round((place - lower_) / step_);
  std::array<int, 3> cell{};
  for (int axis = 0; axis < 3; ++axis) {
    if (!(cells[axis] >= 0.0 && cells[axis] < size_[axis])) return false;
    cell[axis] = static_cast<int>(cells[axis]);
  }
  return labels_[number(cell)] == widest_ && !surface_.between(place, middle(cell)) &&
         surface_.distance(place, radius) >= radius;
}

}  // namespace mesograin::pile
