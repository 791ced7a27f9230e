// Which balls are near each other.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace mesograin::pile {

class Neighbours {
 public:
  Neighbours(std::span<const glm::dvec3> middles, std::span<const double> radii);

  /// Calls visit(j) for each other ball that touches ball i, once, in an order that depends on nothing else.
  template <typename Visit>
  void visit(std::uint32_t i, const Visit& visit) const {
    for (const Grid& grid : grids_)
      look(grid, i, [&](const Ball& ball) {
        const glm::dvec3 apart = middles_[i] - ball.middle;
        const double reach = radii_[i] + ball.radius;
        if (ball.number != i && glm::dot(apart, apart) < reach * reach) visit(ball.number);
      });
  }

 private:
  struct Cell {
    int x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Ball {
    glm::dvec3 middle;
    double radius;
    Cell cell;
    std::uint32_t number;
  };
  struct Grid {
    double largest;  // radius in it
    std::size_t mask;
    std::vector<std::uint32_t> first;  // in `balls`, of those whose cells have a hash
    std::vector<Ball> balls;
  };

  static std::size_t hashed(const Cell& cell, std::size_t mask);
  static Cell cell_of(const glm::dvec3& place, double size);
  void add_grid(const std::vector<std::uint32_t>& numbers);
  template <typename Visit>
  void look(const Grid& grid, std::uint32_t i, const Visit& visit) const;

  std::span<const glm::dvec3> middles_;
  std::span<const double> radii_;
  std::vector<Grid> grids_;
};

// Optimized spatial hashing for collision detection of deformable objects, Teschner et al. 2003, section 4.2.
inline std::size_t Neighbours::hashed(const Cell& cell, std::size_t mask) {
  return ((static_cast<std::uint32_t>(cell.x) * 73856093U) ^ (static_cast<std::uint32_t>(cell.y) * 19349663U) ^
          (static_cast<std::uint32_t>(cell.z) * 83492791U)) &
         mask;
}

inline Neighbours::Cell Neighbours::cell_of(const glm::dvec3& place, double size) {
  return {static_cast<int>(std::floor(place.x / size)), static_cast<int>(std::floor(place.y / size)),
          static_cast<int>(std::floor(place.z / size))};
}

template <typename Visit>
void Neighbours::look(const Grid& grid, std::uint32_t i, const Visit& visit) const {
  const double reach = radii_[i] + grid.largest;
  const Cell first = cell_of(middles_[i] - reach, 2.0 * grid.largest);
  const Cell last = cell_of(middles_[i] + reach, 2.0 * grid.largest);
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const Cell cell{x, y, z};
        const std::size_t hash = hashed(cell, grid.mask);
        // Others may have its hash.
        for (std::uint32_t k = grid.first[hash]; k < grid.first[hash + 1]; ++k)
          if (grid.balls[k].cell == cell) visit(grid.balls[k]);
      }
}

}  // namespace mesograin::pile
