// What one point of a light makes a walk send back.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "heap/draws.h"
#include "lights/device_light.h"
#include "transport/random.h"

namespace mesograin::heap {

/// Of all places of a walk that ask for the light one is looked at, the likelier the more it found.
class Asking {
 public:
  /// A point of the light, by `random`, as a grain's middle has it, relative to `anchor`; of a lamp nearer than
  /// `near_radii` it is another direction for each place, and another brightness. `draw` must outlast this.
  Asking(const Draw& draw, const glm::dvec2& random, const glm::dvec3& anchor, const glm::vec3& middle, float radius)
      : draw_(draw), random_(random), anchor_(anchor), now_(drawn_at(middle)) {
    near_ = now_.reach < near_radii * radius;
  }

  /// As what is at this place has it; relative to the anchor.
  void move_to(const glm::vec3& place) {
    if (near_) now_ = drawn_at(place);
  }

  const glm::vec3& to_light() const { return now_.to_light; }
  float reach() const { return now_.reach; }

  /// What is scattered at a place of light that travelled along `direction` as it came from the viewer.
  glm::vec3 scattered(float g, const glm::vec3& direction, const glm::vec3& weight) const {
    // Henyey and Greenstein 1941, eq. 2.
    const float square = 1.0F + g * g - 2.0F * g * glm::dot(direction, now_.to_light);
    const float phase = (1.0F - g * g) / (4.0F * std::numbers::pi_v<float> * square * std::sqrt(square));
    return phase * weight * now_.irradiance;
  }

  /// What leaves evenly at a normal.
  glm::vec3 reflected(const glm::vec3& normal, const glm::vec3& weight) const {
    return std::max(glm::dot(normal, now_.to_light), 0.0F) / std::numbers::pi_v<float> * weight * now_.irradiance;
  }

  /// `light`, but for what hinders it, is asked for at a place, `gone` on the way from where it was told.
  void ask(const glm::vec3& light, const glm::vec3& place, float gone, transport::Random& random) {
    const float mean = (light.r + light.g + light.b) / 3.0F;
    if (!(mean > 0.0F)) return;
    all_ += mean;
    if (random.uniform() * all_ >= mean) return;
    chosen_ = {place, now_.to_light, std::max(now_.reach - gone, 0.0F)};
    colour_ = light / mean;
  }

  bool any() const { return all_ > 0.0F; }

  /// Where to look from, whereto and how far.
  struct Chosen {
    glm::vec3 place{0.0F};
    glm::vec3 to_light{0.0F};
    float reach = 0.0F;
  };
  const Chosen& chosen() const { return chosen_; }

  /// What all have asked for, as that place tells it.
  glm::vec3 asked() const { return all_ * colour_; }

 private:
  struct Light {
    glm::vec3 to_light;
    glm::vec3 irradiance;
    float reach;
  };

  Light drawn_at(const glm::vec3& place) const {
    const lights::LightDraw light = draw_(anchor_ + glm::dvec3(place), random_);
    return {glm::vec3(light.to_light), glm::vec3(light.irradiance), static_cast<float>(std::min(light.reach, 1e30))};
  }

  const Draw& draw_;
  glm::dvec2 random_;
  glm::dvec3 anchor_;
  Light now_;
  bool near_ = false;
  float all_ = 0.0F;
  Chosen chosen_;
  glm::vec3 colour_{0.0F};
};

}  // namespace mesograin::heap
