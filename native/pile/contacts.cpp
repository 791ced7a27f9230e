// Balls are sorted into the cells of a grid that is hashed, so that a wide pile costs no more than a deep one.
#include "pile/contacts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

namespace mesograin::pile {
namespace {

struct Cell {
  std::int32_t x, y, z;
};

// Optimized spatial hashing for collision detection of deformable objects, Teschner et al. 2003, section 4.2.
std::size_t hashed(const Cell& cell, std::size_t mask) {
  return ((static_cast<std::uint32_t>(cell.x) * 73856093U) ^ (static_cast<std::uint32_t>(cell.y) * 19349663U) ^
          (static_cast<std::uint32_t>(cell.z) * 83492791U)) &
         mask;
}

Cell cell_of(const glm::dvec3& middle, double size) {
  return {static_cast<std::int32_t>(std::floor(middle.x / size)),
          static_cast<std::int32_t>(std::floor(middle.y / size)),
          static_cast<std::int32_t>(std::floor(middle.z / size))};
}

}  // namespace

void find_pairs(std::span<const glm::dvec3> middles, std::span<const double> radii, double margin, Pairs& pairs) {
  pairs.clear();
  const std::size_t count = middles.size();
  if (count == 0) return;
  const double size = 2.0 * *std::max_element(radii.begin(), radii.end()) + margin;
  const std::size_t mask = std::bit_ceil(2 * count) - 1;
  std::vector<std::uint32_t> first(mask + 2, 0);
  std::vector<std::uint32_t> sorted(count);
  for (const glm::dvec3& middle : middles) ++first[hashed(cell_of(middle, size), mask) + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t i = 0; i < count; ++i) sorted[next[hashed(cell_of(middles[i], size), mask)]++] = i;

  for (std::uint32_t i = 0; i < count; ++i) {
    const Cell centre = cell_of(middles[i], size);
    // Two of the 27 cells may share a hash; each of its balls is then met once.
    std::size_t seen[27];
    std::size_t seen_count = 0;
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const Cell cell{centre.x + neighbour % 3 - 1, centre.y + neighbour / 3 % 3 - 1, centre.z + neighbour / 9 - 1};
      const std::size_t hash = hashed(cell, mask);
      if (std::find(seen, seen + seen_count, hash) != seen + seen_count) continue;
      seen[seen_count++] = hash;
      for (std::uint32_t place = first[hash]; place < first[hash + 1]; ++place) {
        const std::uint32_t j = sorted[place];
        if (j <= i) continue;
        const glm::dvec3 apart = middles[i] - middles[j];
        const double reach = radii[i] + radii[j] + margin;
        if (glm::dot(apart, apart) < reach * reach) pairs.emplace_back(i, j);
      }
    }
  }
}

}  // namespace mesograin::pile
