// A light of any kind.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <variant>

#include "scene/lights/area_light.h"
#include "scene/lights/directional_light.h"
#include "scene/lights/point_light.h"
#include "scene/lights/spot_light.h"

namespace mesograin::scene {

using Light = std::variant<DirectionalLight, PointLight, SpotLight, AreaLight>;

/// Of one that has a place.
inline std::optional<glm::dvec3> place(const Light& light) {
  return std::visit(
      [](const auto& kind) -> std::optional<glm::dvec3> {
        if constexpr (requires { kind.position; })
          return kind.position;
        else
          return std::nullopt;
      },
      light);
}

/// As its kind has it.
inline void validate(const Light& light) {
  std::visit([](const auto& kind) { validate(kind); }, light);
}

}  // namespace mesograin::scene
