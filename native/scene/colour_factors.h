// What tells the grains of a heap apart beside their places: sand is never of one colour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace mesograin::scene {

/// Factors of a material's colours, linear RGB, one for each instance or none at all.
struct ColourFactors {
  std::vector<glm::vec3> sigma_a{};
  std::vector<glm::vec3> sigma_s{};
  std::vector<glm::vec3> reflectance{};

  bool any() const { return !sigma_a.empty() || !sigma_s.empty() || !reflectance.empty(); }
  bool operator==(const ColourFactors&) const = default;
};

/// Throws Error unless there is a factor for each of `count` instances, or none, and all are finite and not negative.
void validate(const ColourFactors& factors, std::size_t count);

/// A factor for each of `count` instances, at a place between `from` and `to` that is drawn evenly, by `seed`.
std::vector<glm::vec3> random_factors(const glm::dvec3& from, const glm::dvec3& to, std::size_t count,
                                      std::uint64_t seed);

}  // namespace mesograin::scene
