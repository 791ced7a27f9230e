// Embree's own spheres, and triangles.
#include "heap/grains.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "base/error.h"
#include "embree/first_hit.h"

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
    only_walls = rtcNewScene(device);
    only_panes = rtcNewScene(device);
  }
  ~Device() {
    rtcReleaseScene(only_panes);
    rtcReleaseScene(only_walls);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  void add_grains(const std::vector<Grain>& grains) {
    spheres.reserve(grains.size());
    for (const Grain& grain : grains) spheres.emplace_back(grain.middle, grain.radius);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, spheres.data(), 0,
                               sizeof(glm::vec4), spheres.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, of_grains);
    rtcReleaseGeometry(geometry);
  }

  RTCGeometry geometry_of(const scene::Mesh& mesh, const glm::dmat4& to_heap) const {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::vector<glm::vec3> positions = places_of(mesh, to_heap);
    const std::vector<glm::uvec3>& triangles = mesh.triangles();
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                             positions.size());
    std::memcpy(vertices, positions.data(), positions.size() * sizeof(glm::vec3));
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                            triangles.size());
    std::memcpy(indices, triangles.data(), triangles.size() * sizeof(glm::uvec3));
    rtcCommitGeometry(geometry);
    return geometry;
  }

  void add_wall(const Wall& wall, std::uint32_t number) {
    const RTCGeometry geometry = geometry_of(*wall.mesh, wall.to_heap);
    rtcAttachGeometryByID(scene, geometry, of_grains + 1 + number);
    rtcAttachGeometryByID(only_walls, geometry, number);
    rtcReleaseGeometry(geometry);
  }

  void add_pane(const Pane& pane, std::uint32_t number) {
    const RTCGeometry geometry = geometry_of(*pane.mesh, pane.to_heap);
    rtcAttachGeometryByID(only_panes, geometry, number);
    rtcReleaseGeometry(geometry);
    turned_out.push_back(glm::determinant(pane.to_heap) < 0.0);
  }

  static Meeting on_wall(std::uint32_t wall, const glm::vec3& origin, const glm::vec3& direction,
                         const RTCRayHit& ray) {
    const glm::vec3 normal = glm::normalize(glm::vec3(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z));
    return {true, wall, origin + ray.ray.tfar * direction, glm::dot(normal, direction) < 0.0F ? normal : -normal};
  }

  static constexpr std::uint32_t of_grains = 0;

  RTCDevice device;
  RTCScene scene = nullptr;
  RTCScene only_walls = nullptr;
  RTCScene only_panes = nullptr;
  std::vector<glm::vec4> spheres;
  std::vector<bool> turned_out;  // panes that are mirror images of their meshes
};

Neighbourhood::Neighbourhood(const Grains& grains) {
  auto device = std::make_shared<Device>();
  device->add_grains(grains.grains);
  for (std::size_t wall = 0; wall < grains.walls.size(); ++wall)
    device->add_wall(grains.walls[wall], static_cast<std::uint32_t>(wall));
  for (std::size_t pane = 0; pane < grains.panes.size(); ++pane)
    device->add_pane(grains.panes[pane], static_cast<std::uint32_t>(pane));
  for (const RTCScene scene : {device->scene, device->only_walls, device->only_panes}) rtcCommitScene(scene);
  device_ = std::move(device);
}

std::optional<Meeting> Neighbourhood::first(const glm::vec3& origin, const glm::vec3& direction,
                                            std::uint32_t from) const {
  float near = 0.0F;
  constexpr int most_left = 64;
  for (int left = 0; left < most_left; ++left) {
    const RTCRayHit ray = embree::first_hit(device_->scene, origin, direction, near);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    if (ray.hit.geomID != Device::of_grains)
      return Device::on_wall(ray.hit.geomID - Device::of_grains - 1, origin, direction, ray);
    const glm::vec4& sphere = device_->spheres[ray.hit.primID];
    const glm::vec3 normal = glm::normalize(origin + ray.ray.tfar * direction - glm::vec3(sphere));
    if (glm::dot(normal, direction) < 0.0F)
      return Meeting{false, ray.hit.primID, glm::vec3(sphere) + sphere.w * normal, normal};
    // The far side of one that the ray has started in.
    const glm::vec3 out = origin - glm::vec3(sphere);
    if (ray.hit.primID != from && glm::dot(out, direction) < 0.0F && glm::length(out) > 0.0F) {
      const glm::vec3 there = glm::normalize(out);
      return Meeting{false, ray.hit.primID, glm::vec3(sphere) + sphere.w * there, there};
    }
    near = ray.ray.tfar + 1e-6F * (std::abs(ray.ray.tfar) + sphere.w);
  }
  return std::nullopt;
}

std::optional<Meeting> Neighbourhood::first_wall(const glm::vec3& origin, const glm::vec3& direction,
                                                 float reach) const {
  const RTCRayHit ray = embree::first_hit(device_->only_walls, origin, direction, 0.0F, reach);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Device::on_wall(ray.hit.geomID, origin, direction, ray);
}

std::optional<Meeting> Neighbourhood::first_on(std::uint32_t wall, const glm::vec3& origin, const glm::vec3& direction,
                                               float reach) const {
  float near = 0.0F;
  constexpr int most_passed = 16;
  for (int passed = 0; passed < most_passed; ++passed) {
    const RTCRayHit ray = embree::first_hit(device_->only_walls, origin, direction, near, reach);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    if (ray.hit.geomID == wall) return Device::on_wall(wall, origin, direction, ray);
    near = ray.ray.tfar + 1e-6F * reach;
  }
  return std::nullopt;
}

std::optional<PaneSurface> Neighbourhood::first_pane(const glm::vec3& origin, const glm::vec3& direction, float near,
                                                     float reach) const {
  const RTCRayHit ray = embree::first_hit(device_->only_panes, origin, direction, near, reach);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const glm::vec3 normal = glm::normalize(glm::vec3(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z));
  return PaneSurface{ray.hit.geomID, ray.ray.tfar, device_->turned_out[ray.hit.geomID] ? -normal : normal};
}

bool same_walls(const std::vector<Wall>& a, const std::vector<Wall>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Wall& one, const Wall& other) {
    return one.mesh == other.mesh && one.to_heap == other.to_heap;
  });
}

bool same_places(const Grains& a, const Grains& b) {
  const auto same_pane = [](const Pane& one, const Pane& other) {
    return one.mesh == other.mesh && one.to_heap == other.to_heap;
  };
  if (!std::equal(a.panes.begin(), a.panes.end(), b.panes.begin(), b.panes.end(), same_pane)) return false;
  return same_walls(a.walls, b.walls) && std::equal(a.grains.begin(), a.grains.end(), b.grains.begin(), b.grains.end(),
                                                    [](const Grain& one, const Grain& other) {
                                                      return one.middle == other.middle && one.radius == other.radius;
                                                    });
}

}  // namespace mesograin::heap
