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

/// What the body tells of nodes.
struct Known {
  std::vector<float> distances;   // negative inside
  std::vector<glm::vec3> points;  // of the surface, the nearest
};

/// The surface is nearer to a place than this, for `point` is one of it.
float farthest_possible(const glm::vec3& place, const glm::vec3& point) {
  constexpr float rounding = 1e-6F;
  return margin * glm::distance(place, point) + rounding;
}

/// Whether two places that are so far apart, and so far from the surface, are on the same side of it for certain.
bool on_same_side(float apart, float distance, float other_distance) {
  return margin * apart < std::max(std::abs(distance), std::abs(other_distance));
}

// A neighbour's point tells how far the surface can be at most, and, if it does not come between, on which side the
// node is.
Known asked_at_all(const Body& body, const Lattice& lattice, const Effort& effort) {
  const std::size_t count = static_cast<std::size_t>(lattice.size.x) * lattice.rows();
  Known known{std::vector<float>(count), std::vector<glm::vec3>(count)};
  run_pieces(effort, lattice.rows(), [&](std::size_t row) {
    const auto number = static_cast<int>(row);
    float before = 0.0F;
    float reach = std::numeric_limits<float>::infinity();
    for (int x = 0; x < lattice.size.x; ++x) {
      const glm::ivec3 node(x, number % lattice.size.y, number / lattice.size.y);
      const glm::vec3 place = lattice.place(node);
      const Nearest nearest = body.nearest(place, reach);
      const bool as_before = x > 0 && on_same_side(lattice.spacing.x, nearest.distance, before);
      before = (as_before ? before < 0.0F : body.contains(place)) ? -nearest.distance : nearest.distance;
      known.distances[lattice.index(node)] = before;
      known.points[lattice.index(node)] = nearest.point;
      reach = farthest_possible(lattice.place(node + glm::ivec3(1, 0, 0)), nearest.point);
    }
  });
  return known;
}

// Between nodes that are known, every second of these. Where none of those around is near the surface it is told well
// enough by them.
std::vector<float> asked_between(const Body& body, const Lattice& lattice, const Lattice& known_lattice,
                                 const Known& known, const Effort& effort) {
  const float apart = margin * glm::length(known_lattice.spacing);  // of those around a node at most
  std::vector<float> distances(static_cast<std::size_t>(lattice.size.x) * lattice.rows());
  run_pieces(effort, lattice.rows(), [&](std::size_t row) {
    const auto number = static_cast<int>(row);
    for (int x = 0; x < lattice.size.x; ++x) {
      const glm::ivec3 node(x, number % lattice.size.y, number / lattice.size.y);
      const glm::vec3 place = lattice.place(node);
      const glm::ivec3 low = node / 2, high = (node + 1) / 2;
      // All of those around are as far from the place.
      float sum = 0.0F, nearest = std::numeric_limits<float>::infinity(), farthest = 0.0F, reach = nearest;
      for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 beside((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                                (corner & 4) != 0 ? high.z : low.z);
        const std::size_t other = known_lattice.index(beside);
        const float distance = known.distances[other];
        sum += distance / 8.0F;
        nearest = std::min(nearest, std::abs(distance));
        if (std::abs(distance) > std::abs(farthest)) farthest = distance;
        reach = std::min(reach, farthest_possible(place, known.points[other]));
      }
      float& distance = distances[lattice.index(node)];
      if (low == high || nearest > apart) {
        distance = sum;
        continue;
      }
      distance = body.nearest(place, reach).distance;
      const bool as_beside = on_same_side(glm::distance(place, known_lattice.place(low)), distance, farthest);
      if (as_beside ? farthest < 0.0F : body.contains(place)) distance = -distance;
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
  const Known known = asked_at_all(body, every_second, part_of(effort, 0.0, 0.5));
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
