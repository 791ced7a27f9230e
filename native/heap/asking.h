// What one direction of a light makes a walk send back.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "lights/device_light.h"
#include "transport/random.h"

namespace mesograin::heap {

/// Of all places of a walk that ask for the light one is looked at, the likelier the more it found.
class Asking {
 public:
  explicit Asking(const lights::LightDraw& light)
      : to_light_(light.to_light),
        irradiance_(light.irradiance),
        reach_(static_cast<float>(std::min(light.reach, 1e30))) {}

  const glm::vec3& to_light() const { return to_light_; }
  float reach() const { return reach_; }

  /// What is scattered at a place of light that travelled along `direction` as it came from the viewer.
  glm::vec3 scattered(float g, const glm::vec3& direction, const glm::vec3& weight) const {
    // Henyey and Greenstein 1941, eq. 2.
    const float square = 1.0F + g * g - 2.0F * g * glm::dot(direction, to_light_);
    const float phase = (1.0F - g * g) / (4.0F * std::numbers::pi_v<float> * square * std::sqrt(square));
    return phase * weight * irradiance_;
  }

  /// What leaves evenly at a normal.
  glm::vec3 reflected(const glm::vec3& normal, const glm::vec3& weight) const {
    return std::max(glm::dot(normal, to_light_), 0.0F) / std::numbers::pi_v<float> * weight * irradiance_;
  }

  /// `light`, but for what hinders it, is asked for at a place.
  void ask(const glm::vec3& light, const glm::vec3& place, transport::Random& random) {
    const float mean = (light.r + light.g + light.b) / 3.0F;
    if (!(mean > 0.0F)) return;
    all_ += mean;
    if (random.uniform() * all_ >= mean) return;
    place_ = place;
    colour_ = light / mean;
  }

  bool any() const { return all_ > 0.0F; }

  /// Where to look.
  const glm::vec3& place() const { return place_; }

  /// What all have asked for, as that place tells it.
  glm::vec3 asked() const { return all_ * colour_; }

 private:
  glm::vec3 to_light_;
  glm::vec3 irradiance_;
  float reach_;
  float all_ = 0.0F;
  glm::vec3 place_{0.0F};
  glm::vec3 colour_{0.0F};
};

}  // namespace mesograin::heap
