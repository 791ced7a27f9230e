// Asks the body at every second node, and between them where the surface is near.
#include "transport/surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace mesograin::transport {

namespace {

/// A box of nodes.
struct Lattice {
  glm::vec3 lower;
  glm::vec3 spacing;
  glm::ivec3 size;

  std::size_t rows() const { return static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z); }
  glm::vec3 place(const glm::ivec3& node) const { return lower + glm::vec3(node) * spacing; }
  std::size_t index(const glm::ivec3& node) const {
    return (static_cast<std::size_t>(node.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(node.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(node.x);
  }
};

constexpr float margin = 1.001F;  // of rounding

// A neighbour tells how far the surface can be at most, and, if it does not come between, on which side the node is.
std::vector<float> asked_at_all(const Body& body, const Lattice& lattice, const Effort& effort) {
  std::vector<float> distances(static_cast<std::size_t>(lattice.size.x) * lattice.rows());
  run_pieces(effort, lattice.rows(), [&](std::size_t row) {
    const auto number = static_cast<int>(row);
    float before = 0.0F;
    for (int x = 0; x < lattice.size.x; ++x) {
      const glm::ivec3 node(x, number % lattice.size.y, number / lattice.size.y);
      const float reach =
          x > 0 ? margin * (std::abs(before) + lattice.spacing.x) : std::numeric_limits<float>::infinity();
      const float distance = body.nearest(lattice.place(node), reach).distance;
      const bool beside_surface = x == 0 || std::abs(before) <= margin * lattice.spacing.x;
      before = (beside_surface ? body.contains(lattice.place(node)) : before < 0.0F) ? -distance : distance;
      distances[lattice.index(node)] = before;
    }
  });
  return distances;
}

// Between nodes that are known, every second of these. Where none of those around is near the surface it is told well
// enough by them.
std::vector<float> asked_between(const Body& body, const Lattice& lattice, const Lattice& known_lattice,
                                 const std::vector<float>& known, const Effort& effort) {
  const float apart = margin * glm::length(known_lattice.spacing);  // of those around a node at most
  std::vector<float> distances(static_cast<std::size_t>(lattice.size.x) * lattice.rows());
  run_pieces(effort, lattice.rows(), [&](std::size_t row) {
    const auto number = static_cast<int>(row);
    for (int x = 0; x < lattice.size.x; ++x) {
      const glm::ivec3 node(x, number % lattice.size.y, number / lattice.size.y);
      const glm::ivec3 low = node / 2, high = (node + 1) / 2;
      float sum = 0.0F, nearest = std::numeric_limits<float>::infinity();
      for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 beside((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                                (corner & 4) != 0 ? high.z : low.z);
        const float distance = known[known_lattice.index(beside)];
        sum += distance / 8.0F;
        nearest = std::min(nearest, std::abs(distance));
      }
      float& distance = distances[lattice.index(node)];
      if (low == high || nearest > apart) {
        distance = sum;
        continue;
      }
      const glm::vec3 place = lattice.place(node);
      distance = body.nearest(place, nearest + apart).distance;
      if (body.contains(place)) distance = -distance;
    }
  });
  return distances;
}

}  // namespace

std::vector<float> surface_distances(const Body& body, const Grid& grid, const Effort& effort) {
  static_assert(surface_finer % 2 == 0);
  const glm::ivec3 size = surface_size(grid.size());
  const glm::vec3 spacing = grid.spacing() / static_cast<float>(surface_finer);
  const Lattice lattice{grid.lower(), spacing, size};
  const Lattice every_second{grid.lower(), 2.0F * spacing, (size + 1) / 2};
  const std::vector<float> known = asked_at_all(body, every_second, part_of(effort, 0.0, 0.5));
  return asked_between(body, lattice, every_second, known, part_of(effort, 0.5, 1.0));
}

float distance_at(const Grid& grid, const std::vector<float>& distances, const glm::vec3& place) {
  const glm::ivec3 size = surface_size(grid.size());
  const glm::vec3 scaled = (place - grid.lower()) / grid.spacing() * static_cast<float>(surface_finer);
  const glm::ivec3 low = glm::clamp(glm::ivec3(scaled), glm::ivec3(0), size - 2);
  const glm::vec3 along = glm::clamp(scaled - glm::vec3(low), 0.0F, 1.0F);
  const auto in_row = [&](int y, int z) {
    const int first = ((low.z + z) * size.y + low.y + y) * size.x + low.x;
    const float* row = &distances[static_cast<std::size_t>(first)];
    return glm::mix(row[0], row[1], along.x);
  };
  return glm::mix(glm::mix(in_row(0, 0), in_row(1, 0), along.y), glm::mix(in_row(0, 1), in_row(1, 1), along.y),
                  along.z);
}

}  // namespace mesograin::transport
