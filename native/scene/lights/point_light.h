// A light at a place: a point, or a ball of a radius that is as bright from every side.
#pragma once

#include <glm/vec3.hpp>

namespace mesograin::scene {

/// What a radius makes of a point light and of a spot.
enum class LightShape {
  disc,    ///< one that faces whatever it lights, so that the light fades softly inside it (Cycles' soft falloff)
  sphere,  ///< a ball; from inside, light comes from everywhere
};

struct PointLight {
  glm::dvec3 position{0.0};
  glm::dvec3 radiant_intensity{1.0};  ///< linear RGB, W/sr; of whatever radius, its radiance times pi radius^2
  double radius = 0.0;                ///< scene units; 0 is a point
  LightShape shape = LightShape::disc;

  bool operator==(const PointLight&) const = default;
};

/// Throws Error if the intensity or the radius is negative, or a number is not finite.
void validate(const PointLight& light);

}  // namespace mesograin::scene
