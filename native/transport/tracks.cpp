// Steps along a ray, and sums what it leaves in the cells that it goes through.
#include "transport/tracks.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace mesograin::transport {
namespace {

constexpr std::size_t corners_of_a_cell = 8;

// A ray of which less is left is next to nothing beside what is scattered there.
constexpr float least_track = 1e-4F;

}  // namespace

Tracks::Tracks(const Grid& grid, const std::vector<double>& extinctions)
    : grid_(grid),
      per_spacing_(1.0F / grid.spacing()),
      extinctions_(extinctions.begin(), extinctions.end()),
      sums_(grid.cells().size() * extinctions.size() * corners_of_a_cell, 0.0F),
      passed_(extinctions.size()),
      tracks_(extinctions.size()),
      step_(0.5F * std::min({grid.spacing().x, grid.spacing().y, grid.spacing().z})) {}

void Tracks::add(const glm::vec3& place, const glm::vec3& direction, float length, float flux, std::vector<float>& left,
                 Random& random) {
  const int steps = std::max(1, static_cast<int>(std::ceil(length / step_)));
  const float step = length / static_cast<float>(steps);
  const std::size_t count = extinctions_.size();
  for (std::size_t e = 0; e < count; ++e) {
    passed_[e] = std::exp(-extinctions_[e] * step);
    tracks_[e] = flux * (extinctions_[e] * step > 1e-4F ? (1.0F - passed_[e]) / extinctions_[e] : step);
  }
  // In cells, from the first node on.
  const glm::vec3 start = (place - grid_.lower()) * per_spacing_;
  const glm::vec3 way = step * direction * per_spacing_;
  const glm::ivec3 last = grid_.size() - 2;
  for (int s = 0; s < steps; ++s) {
    const glm::vec3 at = start + (static_cast<float>(s) + random.uniform()) * way;
    const glm::ivec3 cell = glm::clamp(glm::ivec3(at), glm::ivec3(0), last);
    const glm::vec3 along = glm::clamp(at - glm::vec3(cell), 0.0F, 1.0F);
    const glm::vec3 rest = 1.0F - along;
    const float low[] = {rest.x * rest.y, along.x * rest.y, rest.x * along.y, along.x * along.y};
    const int number = (cell.z * (last.y + 1) + cell.y) * (last.x + 1) + cell.x;
    float* sums = &sums_[static_cast<std::size_t>(number) * count * corners_of_a_cell];
    float most = 0.0F;
    for (std::size_t e = 0; e < count; ++e, sums += corners_of_a_cell) {
      const float track = left[e] * tracks_[e];
      left[e] *= passed_[e];
      most = std::max(most, left[e]);
      const float below = track * rest.z;
      const float above = track * along.z;
      for (std::size_t corner = 0; corner < 4; ++corner) {
        sums[corner] += below * low[corner];
        sums[corner + 4] += above * low[corner];
      }
    }
    if (flux * most < least_track) return;
  }
}

std::vector<float> Tracks::at_nodes() const {
  const std::size_t count = extinctions_.size();
  std::vector<float> result(grid_.places().size() * count, 0.0F);
  const float* sums = sums_.data();
  for (const Grid::Cell& cell : grid_.cells())
    for (std::size_t e = 0; e < count; ++e, sums += corners_of_a_cell) {
      // What rounding takes for outside is in a cell with corners that are not used, for which the others answer.
      float all = 0.0F;
      float used = 0.0F;
      for (std::size_t corner = 0; corner < corners_of_a_cell; ++corner) {
        all += sums[corner];
        if (cell.used[corner] >= 0) used += sums[corner];
      }
      if (used <= 0.0F) continue;
      const float share = cell.whole ? 1.0F : all / used;
      for (std::size_t corner = 0; corner < corners_of_a_cell; ++corner)
        if (cell.used[corner] >= 0)
          result[static_cast<std::size_t>(cell.used[corner]) * count + e] += share * sums[corner];
    }
  return result;
}

}  // namespace mesograin::transport
