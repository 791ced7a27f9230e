// A light of the scene as the text of the lights takes it.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "lights/light_text.h"
#include "scene/light.h"

namespace mesograin::lights {

/// Relative to `origin`, from which the places to be lit are then told.
DeviceLight pack(const scene::Light& light, const glm::dvec3& origin);

/// The five numbers of four that shaders/lights/light.glsl's DeviceLight is, in single precision.
std::array<glm::vec4, 5> to_device(const DeviceLight& light);

/// One direction that the light comes from at `place`, world space; `random` is in [0, 1)^2.
LightDraw sample(const scene::Light& light, const glm::dvec3& place, const glm::dvec2& random);

}  // namespace mesograin::lights
