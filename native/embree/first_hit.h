// One ray at a time, which goes nowhere near the one before.
#pragma once

#include <glm/vec3.hpp>
#include <limits>

#include "embree/rtcore.h"

namespace mesograin::embree {

/// What a ray meets first between these distances along it; nothing if the hit's geomID is RTC_INVALID_GEOMETRY_ID.
RTCRayHit first_hit(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction, float near,
                    float far = std::numeric_limits<float>::infinity());

}  // namespace mesograin::embree
