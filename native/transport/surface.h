// Where a body's surface is, at nodes nearer to one another than those that light is known at: what is refracted and
// reflected shows how the surface lies far more sharply than light that is scattered does.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "transport/body.h"
#include "transport/effort.h"
#include "transport/grid.h"

namespace mesograin::transport {

/// Spaces between the surface's nodes in one between the light's.
inline constexpr int surface_finer = 4;

/// Nodes along x, y and z of those that go with so many of the light's.
inline glm::ivec3 surface_size(const glm::ivec3& size) { return surface_finer * (size - 1) + 1; }

/// The distance from the surface at each of them, negative inside; x runs fastest.
std::vector<float> surface_distances(const Body& body, const Grid& grid, const Effort& effort);

/// The same at a place in the body's box, as it is drawn: linear between nodes.
float distance_at(const Grid& grid, const std::vector<float>& distances, const glm::vec3& place);

}  // namespace mesograin::transport
