// What a point light must satisfy.
#include "scene/lights/point_light.h"

#include "scene/lights/requirements.h"

namespace mesograin::scene {

void validate(const PointLight& light) {
  require_place(light.position, "position");
  require_emission(light.radiant_intensity, "radiant_intensity");
  require_size(light.radius, "radius");
}

}  // namespace mesograin::scene
