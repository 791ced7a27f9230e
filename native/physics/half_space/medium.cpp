// Similarity, without a difference of nearly equal numbers.
#include "physics/half_space/medium.h"

#include <algorithm>

namespace mesograin::physics {
namespace {

Medium similar_medium(const scene::Material& material, int channel, double g) {
  const double sigma_a = material.sigma_a[channel];
  const double sigma_s =
      material.g == g ? material.sigma_s[channel] : material.sigma_s[channel] * (1.0 - material.g) / (1.0 - g);
  const double sigma_t = sigma_a + sigma_s;
  if (material.scale <= 0.0 || sigma_s <= 0.0) return {0.0, 1.0, g};
  return {sigma_s / sigma_t, sigma_a / sigma_t, g};
}

}  // namespace

Medium half_space_medium(const scene::Material& material, int channel) {
  return similar_medium(material, channel, std::clamp(material.g, -largest_half_space_g, largest_half_space_g));
}

Medium reduced_medium(const scene::Material& material, int channel) { return similar_medium(material, channel, 0.0); }

}  // namespace mesograin::physics
