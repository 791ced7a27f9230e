// One ray at a time, which goes nowhere near the one before.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

#include "embree/rtcore.h"

namespace mesograin::embree {

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

inline QueryContext fresh_context() {
  QueryContext context;
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&context);
#else
  rtcInitIntersectContext(&context);
#endif
  return context;
}

/// Whether Embree takes a ray's origin or direction: a number no larger than its own bound (FLT_LARGE). A build of it
/// that asserts, such as Debian 12's, ends the process otherwise; an instance that is scaled flat turns rays into such.
inline bool castable(float x, float y, float z) {
  constexpr float largest = 1.844e18F;
  return std::abs(x) <= largest && std::abs(y) <= largest && std::abs(z) <= largest;
}

/// What a ray meets first between these distances along it; nothing if the hit's geomID is RTC_INVALID_GEOMETRY_ID,
/// as of a ray that is not castable().
RTCRayHit first_hit(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction, float near,
                    float far = std::numeric_limits<float>::infinity());

/// The same of a ray that user geometry is to know: by `id`, and by what goes with it.
RTCRayHit first_hit(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction, float near, float far,
                    unsigned id, QueryContext* context);

}  // namespace mesograin::embree
