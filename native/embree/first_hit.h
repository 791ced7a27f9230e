// One ray at a time, which goes nowhere near the one before.
#pragma once

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

/// What a ray meets first between these distances along it; nothing if the hit's geomID is RTC_INVALID_GEOMETRY_ID.
RTCRayHit first_hit(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction, float near,
                    float far = std::numeric_limits<float>::infinity());

/// The same of a ray that user geometry is to know: by `id`, and by what goes with it.
RTCRayHit first_hit(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction, float near, float far,
                    unsigned id, QueryContext* context);

}  // namespace mesograin::embree
