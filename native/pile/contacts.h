// Which balls are near each other.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

namespace mesograin::pile {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// All pairs of balls whose surfaces are nearer than `margin`, each once, in an order that depends on nothing else.
void find_pairs(std::span<const glm::dvec3> middles, std::span<const double> radii, double margin, Pairs& pairs);

}  // namespace mesograin::pile
