// Eight rays at a time, which go nearly the same way.
#pragma once

#include "embree/first_hit.h"

namespace mesograin::embree {

/// What goes with the rays of a packet on their way through user geometry.
struct Context {
  QueryContext query = fresh_context();
  const float* own = nullptr;  // of each ray, as in Packet

#if RTC_VERSION_MAJOR < 4
  Context() { query.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT; }
#endif
};

inline void intersect(const int* valid, RTCScene scene, Context& context, RTCRayHit8& rays) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context.query;
  rtcIntersect8(valid, scene, &rays, &arguments);
#else
  rtcIntersect8(valid, scene, &context.query, &rays);
#endif
}

inline void occlude(const int* valid, RTCScene scene, Context& context, RTCRay8& rays) {
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context.query;
  rtcOccluded8(valid, scene, &rays, &arguments);
#else
  rtcOccluded8(valid, scene, &context.query, &rays);
#endif
}

}  // namespace mesograin::embree
