// Fills in what Embree wants to know of a ray.
#include "embree/first_hit.h"

namespace mesograin::embree {

RTCRayHit first_hit(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction, float near, float far) {
  QueryContext context = fresh_context();
  return first_hit(scene, origin, direction, near, far, 0, &context);
}

RTCRayHit first_hit(RTCScene scene, const glm::vec3& origin, const glm::vec3& direction, float near, float far,
                    unsigned id, QueryContext* context) {
  RTCRayHit ray{};
  ray.ray.org_x = origin.x;
  ray.ray.org_y = origin.y;
  ray.ray.org_z = origin.z;
  ray.ray.dir_x = direction.x;
  ray.ray.dir_y = direction.y;
  ray.ray.dir_z = direction.z;
  ray.ray.tnear = near;
  ray.ray.tfar = far;
  ray.ray.mask = ~0U;
  ray.ray.id = id;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  if (!castable(origin.x, origin.y, origin.z) || !castable(direction.x, direction.y, direction.z)) return ray;
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = context;
  rtcIntersect1(scene, &ray, &arguments);
#else
  rtcIntersect1(scene, context, &ray);
#endif
  return ray;
}

}  // namespace mesograin::embree
