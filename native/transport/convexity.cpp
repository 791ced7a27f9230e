// Compares every face with the points that reach farthest in many directions.
#include "transport/convexity.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace mesograin::transport {
namespace {

// Half of what a node's distance from the surface is good for where nodes are nearest to one another.
constexpr float most_above = 1e-3F;

// A ball's farthest points in so many directions lie .0015 below it between them. Of a mesh of many points fewer are
// asked for, as a tenth of a second allows: faces that stand above each other do so all over it.
constexpr std::size_t most_directions = 2048;
constexpr std::size_t most_comparisons = 40'000'000;

// In every so many of these directions are the first that are asked for: nearly all of what is not convex shows there.
constexpr std::size_t first_step = 16;

/// Points that reach farthest in every `step`th direction, each once.
std::vector<glm::vec3> outermost(const std::vector<glm::vec3>& positions, std::size_t step) {
  const float golden_angle = std::numbers::pi_v<float> * (3.0F - std::sqrt(5.0F));
  const std::size_t directions =
      std::min(most_directions, most_comparisons / std::max<std::size_t>(positions.size(), 1));
  std::vector<std::size_t> numbers;
  numbers.reserve(directions / step + 1);
  for (std::size_t i = 0; i < directions; i += step) {
    // Evenly spread over the sphere (Swinbank and Purser, "Fibonacci grids", 2006).
    const float z = 1.0F - (2.0F * static_cast<float>(i) + 1.0F) / static_cast<float>(directions);
    const float azimuth = golden_angle * static_cast<float>(i);
    const float sine = std::sqrt(1.0F - z * z);
    const glm::vec3 direction(sine * std::cos(azimuth), sine * std::sin(azimuth), z);
    const auto farthest = std::max_element(positions.begin(), positions.end(), [&](const auto& a, const auto& b) {
      return glm::dot(a, direction) < glm::dot(b, direction);
    });
    numbers.push_back(static_cast<std::size_t>(farthest - positions.begin()));
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<glm::vec3> places;
  places.reserve(numbers.size());
  for (const std::size_t number : numbers) places.push_back(positions[number]);
  return places;
}

bool any_above(const std::vector<glm::vec3>& farthest, const std::vector<glm::vec3>& positions,
               const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec3>& normals) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const glm::vec3& place = positions[triangles[i].x];
    if (std::any_of(farthest.begin(), farthest.end(),
                    [&](const glm::vec3& other) { return glm::dot(other - place, normals[i]) > most_above; }))
      return true;
  }
  return false;
}

}  // namespace

bool nearly_convex(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles,
                   const std::vector<glm::vec3>& normals) {
  return !any_above(outermost(positions, first_step), positions, triangles, normals) &&
         !any_above(outermost(positions, 1), positions, triangles, normals);
}

}  // namespace mesograin::transport
