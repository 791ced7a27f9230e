// Checks factors and draws them.
#include "scene/colour_factors.h"

#include <cmath>
#include <glm/common.hpp>
#include <random>
#include <string_view>

#include "base/error.h"

namespace mesograin::scene {
namespace {

void require(const std::vector<glm::vec3>& factors, std::string_view name, std::size_t count) {
  if (factors.empty()) return;
  if (factors.size() != count)
    throw Error("The factors of {} must be one for each of the {} instances; got {}.", name, count, factors.size());
  for (const glm::vec3& factor : factors)
    for (int channel = 0; channel < 3; ++channel)
      if (!(factor[channel] >= 0.0F && std::isfinite(factor[channel])))
        throw Error("The factors of {} must be finite and at least 0; got {}.", name, factor[channel]);
}

}  // namespace

void validate(const ColourFactors& factors, std::size_t count) {
  require(factors.sigma_a, "sigma_a", count);
  require(factors.sigma_s, "sigma_s", count);
  require(factors.reflectance, "reflectance", count);
}

std::vector<glm::vec3> random_factors(const glm::dvec3& from, const glm::dvec3& to, std::size_t count,
                                      std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<glm::vec3> factors;
  factors.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    factors.emplace_back(glm::mix(from, to, static_cast<double>(random() >> 11U) * 0x1p-53));
  return factors;
}

}  // namespace mesograin::scene
