// Distances by a tree over the triangles; what is inside, by how often a line along x has met the surface before.
#include "pile/field.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pile/parallel.h"

namespace mesograin::pile {
namespace {

constexpr double most_cells = 36.0;  // along the longest side
constexpr double least_step = 0.06;  // of a grain as large as the unit sphere

}  // namespace

Field::Field(const Triangles& mesh, double margin) {
  const glm::dvec3 span = mesh.upper() - mesh.lower() + 2.0 * margin;
  step_ = std::max(least_step, std::max({span.x, span.y, span.z}) / most_cells);
  // Lines along the grid shall not run in faces that stand along an axis.
  lower_ = mesh.lower() - margin - step_ * glm::dvec3(0.31, 0.2718, 0.4142);
  for (int axis = 0; axis < 3; ++axis) size_[axis] = static_cast<int>(std::ceil(span[axis] / step_)) + 2;
  nodes_.resize(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
  measure(mesh);
  tell_inside(mesh);
}

void Field::measure(const Triangles& mesh) {
  const auto rows = static_cast<std::size_t>(size_[1]) * size_[2];
  in_parallel(rows, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      const int y = static_cast<int>(row) % size_[1];
      const int z = static_cast<int>(row) / size_[1];
      double least = std::numeric_limits<double>::infinity();
      for (int x = 0; x < size_[0]; ++x) {
        // No farther than from the neighbour's place.
        least = mesh.distance(lower_ + step_ * glm::dvec3(x, y, z), 1.001 * (least + step_));
        node(x, y, z) = static_cast<float>(least);
      }
    }
  });
}

void Field::tell_inside(const Triangles& mesh) {
  std::vector<std::vector<double>> met(static_cast<std::size_t>(size_[1]) * size_[2]);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto& [a, b, c] = mesh[i].corners;
    const glm::dvec3 from = glm::ceil((glm::min(glm::min(a, b), c) - lower_) / step_);
    const glm::dvec3 to = glm::floor((glm::max(glm::max(a, b), c) - lower_) / step_);
    for (int z = static_cast<int>(from.z); z <= static_cast<int>(to.z); ++z)
      for (int y = static_cast<int>(from.y); y <= static_cast<int>(to.y); ++y) {
        glm::dvec3 begin = lower_ + step_ * glm::dvec3(0.0, y, z);
        glm::dvec3 end = begin;
        begin.x = mesh.lower().x - 1.0;
        end.x = mesh.upper().x + 1.0;
        const auto along = crossing(mesh[i], begin, end);
        if (along) met[static_cast<std::size_t>(z) * size_[1] + y].push_back(begin.x + *along * (end.x - begin.x));
      }
  }
  for (int z = 0; z < size_[2]; ++z)
    for (int y = 0; y < size_[1]; ++y) {
      std::vector<double>& of_row = met[static_cast<std::size_t>(z) * size_[1] + y];
      std::sort(of_row.begin(), of_row.end());
      std::size_t passed = 0;
      for (int x = 0; x < size_[0]; ++x) {
        while (passed < of_row.size() && of_row[passed] < lower_.x + step_ * x) ++passed;
        if (passed % 2 == 1) node(x, y, z) = -node(x, y, z);
      }
    }
}

Field::Cell Field::cell(const glm::vec3& place) const {
  const glm::vec3 last = glm::vec3(size_[0] - 1, size_[1] - 1, size_[2] - 1) - 1e-4F;
  const glm::vec3 wanted = (place - glm::vec3(lower_)) * static_cast<float>(1.0 / step_);
  const glm::vec3 within = glm::clamp(wanted, glm::vec3(0.0F), last);
  const int x = static_cast<int>(within.x);
  const int y = static_cast<int>(within.y);
  const int z = static_cast<int>(within.z);
  const float beyond = wanted == within ? 0.0F : static_cast<float>(step_) * glm::length(wanted - within);
  return {&nodes_[number(x, y, z)], within - glm::vec3(x, y, z), beyond};
}

float Field::distance(const glm::vec3& place) const {
  const auto [corner, t, beyond] = cell(place);
  const std::size_t up = size_[0];
  const std::size_t on = up * static_cast<std::size_t>(size_[1]);
  const auto row = [along = t.x](const float* from) { return from[0] + along * (from[1] - from[0]); };
  const float below = row(corner) + t.y * (row(corner + up) - row(corner));
  const float above = row(corner + on) + t.y * (row(corner + on + up) - row(corner + on));
  return below + t.z * (above - below) + beyond;
}

Field::Value Field::at(const glm::vec3& place) const {
  const auto [corner, t, beyond] = cell(place);
  const std::size_t up = size_[0];
  const std::size_t on = up * static_cast<std::size_t>(size_[1]);
  const auto mix = [](float a, float b, float s) { return a + s * (b - a); };
  // Along x at the cell's four edges, and how it grows there.
  const float edges[4] = {mix(corner[0], corner[1], t.x), mix(corner[up], corner[up + 1], t.x),
                          mix(corner[on], corner[on + 1], t.x), mix(corner[on + up], corner[on + up + 1], t.x)};
  const float rise[4] = {corner[1] - corner[0], corner[up + 1] - corner[up], corner[on + 1] - corner[on],
                         corner[on + up + 1] - corner[on + up]};
  const float below = mix(edges[0], edges[1], t.y);
  const float above = mix(edges[2], edges[3], t.y);
  glm::vec3 outwards(mix(mix(rise[0], rise[1], t.y), mix(rise[2], rise[3], t.y), t.z),
                     mix(edges[1] - edges[0], edges[3] - edges[2], t.z), above - below);
  const float length = glm::length(outwards);
  outwards = length > 1e-9F ? outwards / length : glm::vec3(0.0F, 0.0F, 1.0F);
  return {mix(below, above, t.z) + beyond, outwards};
}

}  // namespace mesograin::pile
