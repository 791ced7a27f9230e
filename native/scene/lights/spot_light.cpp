// What a spot must satisfy.
#include "scene/lights/spot_light.h"

#include "base/error.h"
#include "scene/lights/requirements.h"

namespace mesograin::scene {

void validate(const SpotLight& light) {
  require_place(light.position, "position");
  require_direction(light.axis, "axis");
  require_emission(light.radiant_intensity, "radiant_intensity");
  require_size(light.radius, "radius");
  require_angle(light.angle, "angle");
  if (!(light.blend >= 0.0 && light.blend <= 1.0))
    throw Error("A light's blend must lie between 0 and 1; got {}.", light.blend);
  if (light.wide_x == glm::dvec3(0.0) && light.wide_y == glm::dvec3(0.0)) return;
  require_direction(light.wide_x, "wide_x");
  require_direction(light.wide_y, "wide_y");
}

}  // namespace mesograin::scene
