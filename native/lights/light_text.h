// The text of the lights (shaders/lights/*.glsl) as C++ in double precision: the very same functions that the GPU
// evaluates in float.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace mesograin::lights {

using real = double;
using real2 = glm::dvec2;
using real3 = glm::dvec3;
using real4 = glm::dvec4;

inline constexpr real PI = 3.14159265358979323846;

using glm::abs;
using glm::atan;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::length;
using glm::max;
using glm::normalize;
using glm::sin;
using glm::sqrt;

#define pure [[nodiscard]] inline
#define OUT(type) type&

#include "lights/equirectangular.glsl"
#include "lights/light.glsl"
#include "lights/near.glsl"

#undef pure
#undef OUT

}  // namespace mesograin::lights
