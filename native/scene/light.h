// A light of any kind.
#pragma once

#include <variant>

#include "scene/lights/area_light.h"
#include "scene/lights/directional_light.h"
#include "scene/lights/point_light.h"
#include "scene/lights/spot_light.h"

namespace mesograin::scene {

using Light = std::variant<DirectionalLight, PointLight, SpotLight, AreaLight>;

/// As its kind has it.
inline void validate(const Light& light) {
  std::visit([](const auto& kind) { validate(kind); }, light);
}

}  // namespace mesograin::scene
