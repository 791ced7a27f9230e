// Embree's own spheres.
#include "heap/grains.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "base/error.h"

namespace mesograin::heap {

std::uint32_t Grains::kind(const Optics& optics) {
  const auto number = static_cast<std::uint32_t>(std::find(kinds.begin(), kinds.end(), optics) - kinds.begin());
  if (number == kinds.size()) kinds.push_back(optics);
  return number;
}

struct Neighbourhood::Device {
  Device() : device(rtcNewDevice("set_affinity=0")) {
    if (device == nullptr) throw Error("Embree, which traces rays between grains, could not be started.");
    scene = rtcNewScene(device);
  }
  ~Device() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  RTCDevice device;
  RTCScene scene = nullptr;
  std::vector<glm::vec4> spheres;
};

Neighbourhood::Neighbourhood(const Grains& grains) {
  auto device = std::make_shared<Device>();
  for (const Grain& grain : grains.grains) device->spheres.emplace_back(grain.middle, grain.radius);
  RTCGeometry geometry = rtcNewGeometry(device->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, device->spheres.data(), 0,
                             sizeof(glm::vec4), device->spheres.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(device->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(device->scene);
  device_ = std::move(device);
}

bool Neighbourhood::first(const glm::vec3& origin, const glm::vec3& direction, Meeting& meeting) const {
  float near = 0.0F;
  constexpr int most_left = 64;
  for (int left = 0; left < most_left; ++left) {
    RTCRayHit ray{};
    ray.ray.org_x = origin.x;
    ray.ray.org_y = origin.y;
    ray.ray.org_z = origin.z;
    ray.ray.dir_x = direction.x;
    ray.ray.dir_y = direction.y;
    ray.ray.dir_z = direction.z;
    ray.ray.tnear = near;
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(device_->scene, &ray);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(device_->scene, &context, &ray);
#endif
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    const glm::vec4& sphere = device_->spheres[ray.hit.primID];
    meeting.grain = ray.hit.primID;
    meeting.normal = glm::normalize(origin + ray.ray.tfar * direction - glm::vec3(sphere));
    if (glm::dot(meeting.normal, direction) < 0.0F) return true;
    // The far side of one that the ray has started in.
    near = ray.ray.tfar + 1e-6F * (std::abs(ray.ray.tfar) + sphere.w);
  }
  return false;
}

}  // namespace mesograin::heap
