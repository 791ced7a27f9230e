// Asks the body from node to node: a neighbour tells how far it can be at most, and, if the surface does not come
// between, on which side the node is.
#include "transport/surface.h"

#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <limits>

namespace mesograin::transport {

std::vector<float> surface_distances(const Body& body, const Grid& grid, const Effort& effort) {
  constexpr float margin = 1.001F;  // of rounding
  const glm::ivec3 size = surface_size(grid.size());
  const glm::vec3 spacing = grid.spacing() / static_cast<float>(surface_finer);
  const auto across = static_cast<std::size_t>(size.x);
  const std::size_t rows = static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  std::vector<float> distances(across * rows);
  run_pieces(effort, rows, [&](std::size_t row) {
    const auto number = static_cast<int>(row);
    float before = 0.0F;
    for (int x = 0; x < size.x; ++x) {
      const glm::vec3 place = grid.lower() + glm::vec3(x, number % size.y, number / size.y) * spacing;
      const float reach = margin * (std::abs(before) + spacing.x);
      const float distance = body.nearest(place, x > 0 ? reach : std::numeric_limits<float>::infinity()).distance;
      const bool beside_surface = x == 0 || std::abs(before) <= margin * spacing.x;
      before = (beside_surface ? body.contains(place) : before < 0.0F) ? -distance : distance;
      distances[row * across + static_cast<std::size_t>(x)] = before;
    }
  });
  return distances;
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
