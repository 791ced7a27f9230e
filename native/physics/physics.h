// The physics text (shaders/physics/*.glsl) as C++ in double precision: the very same functions that the GPU evaluates
// in float.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace mesograin::physics {

using real = double;
using real2 = glm::dvec2;
using real3 = glm::dvec3;
using real4 = glm::dvec4;

inline constexpr real PI = 3.14159265358979323846;

using glm::abs;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::exp2;
using glm::log;
using glm::log2;
using glm::max;
using glm::min;
using glm::sign;
using glm::sqrt;

#define pure [[nodiscard]] inline
#define OUT(type) type&

#include "physics/curved_edge.glsl"
#include "physics/dielectric.glsl"
#include "physics/elementary.glsl"
#include "physics/fresnel.glsl"
#include "physics/ggx.glsl"
#include "physics/half_space.glsl"
#include "physics/henyey_greenstein.glsl"
#include "physics/tables.glsl"

#undef pure
#undef OUT

}  // namespace mesograin::physics
