// The world as a light: how bright it is in a direction, and directions drawn by how bright they are.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "lights/light_text.h"
#include "scene/world.h"

namespace mesograin::lights {

/// Linear RGB that comes from a direction (unit length, towards the world); the image's nearest texel.
glm::dvec3 radiance(const scene::World& world, const glm::dvec3& direction);
glm::dvec3 radiance(const scene::Backdrop& backdrop, const glm::dvec3& direction);

/// Draws directions with the image's luminance times the solid angle of its texels as density (Pharr, Jakob and
/// Humphreys, "Physically Based Rendering", 3rd edition, section 14.2.4), evenly without an image.
class WorldLight {
 public:
  explicit WorldLight(scene::World world);

  /// `random` is in [0, 1)^2. Its irradiance is radiance over density; reach is LIGHT_INFINITELY_FAR.
  LightDraw draw(const glm::dvec2& random) const;

  /// Whether there is no image.
  bool even() const { return world_.image == nullptr; }

  /// The same from a direction (unit length), if even.
  LightDraw from(const glm::dvec3& direction) const;

  /// Of the directions drawn, per steradian: the luminance of the image there times this; without an image, this.
  double density() const;

  /// Of that direction (unit length).
  double density(const glm::dvec3& direction) const;

  /// The share of what comes from a direction (unit length) that is more than `times` the mean luminance of all: what
  /// comes from so small a place that next to no walk happens upon it.
  double glare(const glm::dvec3& direction, double times) const;

 private:
  scene::World world_;
  std::vector<double> rows_;    ///< cumulative, of each row
  std::vector<float> columns_;  ///< cumulative within its row, of each texel
};

}  // namespace mesograin::lights
