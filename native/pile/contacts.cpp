// Balls are sorted into the cells of a grid that is hashed, so that a wide pile costs no more than a deep one; the few
// that are wide into one of their own, so that they widen no others' cells.
#include "pile/contacts.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace mesograin::pile {
namespace {

constexpr double not_wide = 0.95;  // of all balls

}  // namespace

Neighbours::Neighbours(std::span<const glm::dvec3> middles, std::span<const double> radii)
    : middles_(middles), radii_(radii) {
  if (radii.empty()) return;
  std::vector<double> sorted(radii.begin(), radii.end());
  const auto limit = sorted.begin() + static_cast<std::ptrdiff_t>(not_wide * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), limit, sorted.end());
  std::vector<std::uint32_t> usual;
  std::vector<std::uint32_t> wide;
  for (std::uint32_t i = 0; i < radii.size(); ++i) (radii[i] <= *limit ? usual : wide).push_back(i);
  add_grid(usual);
  if (!wide.empty()) add_grid(wide);
}

void Neighbours::add_grid(const std::vector<std::uint32_t>& numbers) {
  Grid grid{0.0, std::bit_ceil(2 * numbers.size()) - 1, {}, std::vector<Ball>(numbers.size())};
  for (const std::uint32_t i : numbers) grid.largest = std::max(grid.largest, radii_[i]);
  grid.first.assign(grid.mask + 2, 0);
  std::vector<Cell> cells;
  cells.reserve(numbers.size());
  for (const std::uint32_t i : numbers) {
    cells.push_back(cell_of(middles_[i], 2.0 * grid.largest));
    ++grid.first[hashed(cells.back(), grid.mask) + 1];
  }
  for (std::size_t i = 1; i < grid.first.size(); ++i) grid.first[i] += grid.first[i - 1];
  std::vector<std::uint32_t> next(grid.first.begin(), grid.first.end() - 1);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    grid.balls[next[hashed(cells[i], grid.mask)]++] = {middles_[numbers[i]], radii_[numbers[i]], cells[i], numbers[i]};
  grids_.push_back(std::move(grid));
}

}  // namespace mesograin::pile
