// What an area light must satisfy.
#include "scene/lights/area_light.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "scene/lights/requirements.h"

namespace mesograin::scene {

void validate(const AreaLight& light) {
  require_place(light.position, "position");
  require_direction(light.half_x, "half_x");
  require_direction(light.half_y, "half_y");
  const double area = glm::length(glm::cross(light.half_x, light.half_y));
  if (!(area > 0.0 && std::isfinite(area)))
    throw Error("An area light's half_x and half_y must span an area; got ({}, {}, {}) and ({}, {}, {}).",
                light.half_x.x, light.half_x.y, light.half_x.z, light.half_y.x, light.half_y.y, light.half_y.z);
  require_emission(light.radiance, "radiance");
  require_angle(light.spread, "spread");
}

}  // namespace mesograin::scene
