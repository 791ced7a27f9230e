// What a directional light must satisfy.
#include "scene/lights/directional_light.h"

#include "scene/lights/requirements.h"

namespace mesograin::scene {

void validate(const DirectionalLight& light) {
  require_direction(light.direction_to_light, "direction_to_light");
  require_emission(light.irradiance, "irradiance");
  require_angle(light.angle, "angle");
}

}  // namespace mesograin::scene
