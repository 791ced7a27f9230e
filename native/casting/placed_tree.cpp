// Each instance is a primitive of Embree's user geometry: its own instances would take ten times the memory.
#include "casting/placed_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <limits>
#include <utility>

#include "base/error.h"
#include "casting/device.h"
#include "embree/first_hit.h"
#include "embree/packets.h"

namespace mesograin::casting {
namespace {

RTCScene to_scene(void* scene) { return static_cast<RTCScene>(scene); }

void find_bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto& group = *static_cast<const PlacedGroup*>(arguments->geometryUserPtr);
  const glm::vec4* rows = group.rows + 3 * std::size_t{arguments->primID};
  // What rounding may move a ray by on its way into the mesh's axes.
  constexpr float rounding = 1e-6F;
  float reach[3];
  for (int i = 0; i < 3; ++i)
    reach[i] = (1.0F + 10.0F * rounding) * glm::dot(glm::abs(glm::vec3(rows[i])), group.mesh->half()) +
               rounding * std::abs(rows[i].w);
  *arguments->bounds_o = {rows[0].w - reach[0], rows[1].w - reach[1], rows[2].w - reach[2], 0.0F,
                          rows[0].w + reach[0], rows[1].w + reach[1], rows[2].w + reach[2], 0.0F};
}

// The inverse of an instance's transform, row by row.
struct ToMesh {
  glm::vec3 x, y, z;
  glm::vec3 place;

  explicit ToMesh(const glm::vec4* rows) : place(rows[0].w, rows[1].w, rows[2].w) {
    const glm::vec3 a(rows[0]), b(rows[1]), c(rows[2]);
    const glm::vec3 bc = glm::cross(b, c), ca = glm::cross(c, a), ab = glm::cross(a, b);
    const float scale = 1.0F / glm::dot(a, bc);
    x = scale * glm::vec3(bc.x, ca.x, ab.x);
    y = scale * glm::vec3(bc.y, ca.y, ab.y);
    z = scale * glm::vec3(bc.z, ca.z, ab.z);
  }

  glm::vec3 turn(const glm::vec3& direction) const {
    return {glm::dot(x, direction), glm::dot(y, direction), glm::dot(z, direction)};
  }

  // Distances along the rays stay as they are.
  void turn(const RTCRay8& rays, RTCRay8& turned) const {
    for (unsigned i = 0; i < rays_in_packet; ++i) {
      const float from_x = rays.org_x[i] - place.x;
      const float from_y = rays.org_y[i] - place.y;
      const float from_z = rays.org_z[i] - place.z;
      turned.org_x[i] = x.x * from_x + x.y * from_y + x.z * from_z;
      turned.org_y[i] = y.x * from_x + y.y * from_y + y.z * from_z;
      turned.org_z[i] = z.x * from_x + z.y * from_y + z.z * from_z;
      turned.dir_x[i] = x.x * rays.dir_x[i] + x.y * rays.dir_y[i] + x.z * rays.dir_z[i];
      turned.dir_y[i] = y.x * rays.dir_x[i] + y.y * rays.dir_y[i] + y.z * rays.dir_z[i];
      turned.dir_z[i] = z.x * rays.dir_x[i] + z.y * rays.dir_y[i] + z.z * rays.dir_z[i];
      turned.tnear[i] = rays.tnear[i];
      turned.tfar[i] = rays.tfar[i];
      turned.time[i] = 0.0F;
      turned.mask[i] = ~0U;
      turned.id[i] = i;
      turned.flags[i] = 0;
    }
  }
};

void leave_out_what_is_not_castable(const RTCRay8& rays, int* valid) {
  for (unsigned i = 0; i < rays_in_packet; ++i)
    if (!embree::castable(rays.org_x[i], rays.org_y[i], rays.org_z[i]) ||
        !embree::castable(rays.dir_x[i], rays.dir_y[i], rays.dir_z[i]))
      valid[i] = 0;
}

// Rays of a packet of eight arrive eight at a time. `valid`: those that may meet this instance; they are turned into
// its mesh's axes. False if there are none.
bool enter(const PlacedGroup& group, unsigned instance, const float* own, const int* arrived, const RTCRay8& rays,
           int* valid, RTCRay8& inside) {
  const std::uint32_t number = group.first_number + instance;
  bool any = false;
  for (unsigned i = 0; i < rays_in_packet; ++i) {
    valid[i] = rays.id[i] == number && !(own[i] > 0.0F) ? 0 : arrived[i];
    any = any || valid[i] != 0;
  }
  if (!any) return false;
  ToMesh(group.rows + 3 * std::size_t{instance}).turn(rays, inside);
  leave_out_what_is_not_castable(inside, valid);
  for (unsigned i = 0; i < rays_in_packet; ++i)
    if (rays.id[i] == number) inside.tnear[i] = own[i];
  return true;
}

const float* own_of(const RTCIntersectFunctionNArguments* arguments) {
  return reinterpret_cast<const embree::Context*>(arguments->context)->own;
}

const float* own_of(const RTCOccludedFunctionNArguments* arguments) {
  return reinterpret_cast<const embree::Context*>(arguments->context)->own;
}

// What a ray meets of an instance between these distances.
RTCRayHit hit_of(const PlacedGroup& group, unsigned instance, const glm::vec3& origin, const glm::vec3& direction,
                 float near, float far) {
  const ToMesh to_mesh(group.rows + 3 * std::size_t{instance});
  return embree::first_hit(to_scene(group.mesh->scene()), to_mesh.turn(origin - to_mesh.place), to_mesh.turn(direction),
                           near, far);
}

void intersect_instance_alone(const RTCIntersectFunctionNArguments* arguments) {
  const auto& group = *static_cast<const PlacedGroup*>(arguments->geometryUserPtr);
  RTCRayHit& ray = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  float near = ray.ray.tnear;
  if (ray.ray.id == group.first_number + arguments->primID) {
    near = *own_of(arguments);
    if (!(near > 0.0F)) return;
  }
  const RTCRayHit inside = hit_of(group, arguments->primID, {ray.ray.org_x, ray.ray.org_y, ray.ray.org_z},
                                  {ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z}, near, ray.ray.tfar);
  if (inside.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  ray.ray.tfar = inside.ray.tfar;
  ray.hit.geomID = arguments->geomID;
  ray.hit.primID = inside.hit.primID;
  ray.hit.instID[0] = arguments->primID;
  ray.hit.u = inside.hit.u;
  ray.hit.v = inside.hit.v;
}

void intersect_instance(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->N == 1) {
    intersect_instance_alone(arguments);
    return;
  }
  const auto& group = *static_cast<const PlacedGroup*>(arguments->geometryUserPtr);
  RTCRayHit8& rays = *reinterpret_cast<RTCRayHit8*>(arguments->rayhit);
  alignas(32) int valid[rays_in_packet];
  RTCRayHit8 inside;
  if (!enter(group, arguments->primID, own_of(arguments), arguments->valid, rays.ray, valid, inside.ray)) return;
  for (unsigned& geometry : inside.hit.geomID) geometry = RTC_INVALID_GEOMETRY_ID;
  embree::Context context;
  embree::intersect(valid, to_scene(group.mesh->scene()), context, inside);
  for (unsigned i = 0; i < rays_in_packet; ++i) {
    if (valid[i] == 0 || inside.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    rays.ray.tfar[i] = inside.ray.tfar[i];
    rays.hit.geomID[i] = arguments->geomID;
    rays.hit.primID[i] = inside.hit.primID[i];
    rays.hit.instID[0][i] = arguments->primID;
    rays.hit.u[i] = inside.hit.u[i];
    rays.hit.v[i] = inside.hit.v[i];
  }
}

void occlude_instance(const RTCOccludedFunctionNArguments* arguments) {
  const auto& group = *static_cast<const PlacedGroup*>(arguments->geometryUserPtr);
  RTCRay8& rays = *reinterpret_cast<RTCRay8*>(arguments->ray);
  alignas(32) int valid[rays_in_packet];
  RTCRay8 inside;
  if (!enter(group, arguments->primID, own_of(arguments), arguments->valid, rays, valid, inside)) return;
  embree::Context context;
  embree::occlude(valid, to_scene(group.mesh->scene()), context, inside);
  for (unsigned i = 0; i < rays_in_packet; ++i)
    if (valid[i] != 0 && inside.tfar[i] < 0.0F) rays.tfar[i] = -std::numeric_limits<float>::infinity();
}

void fill(const Packet& packet, RTCRay8& rays, int* valid) {
  for (unsigned i = 0; i < rays_in_packet; ++i) {
    valid[i] = packet.cast[i] ? -1 : 0;
    rays.org_x[i] = packet.origin_x[i];
    rays.org_y[i] = packet.origin_y[i];
    rays.org_z[i] = packet.origin_z[i];
    rays.dir_x[i] = packet.direction_x[i];
    rays.dir_y[i] = packet.direction_y[i];
    rays.dir_z[i] = packet.direction_z[i];
    rays.tnear[i] = 0.0F;
    rays.tfar[i] = packet.farthest[i];
    rays.time[i] = 0.0F;
    rays.mask[i] = ~0U;
    rays.id[i] = packet.from[i];
    rays.flags[i] = 0;
  }
  leave_out_what_is_not_castable(rays, valid);
}

}  // namespace

PlacedTree::PlacedTree(std::vector<PlacedGroup> groups)
    : groups_(std::move(groups)), scene_(rtcNewScene(embree_device())) {
  for (PlacedGroup& group : groups_) {
    RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, group.count);
    rtcSetGeometryUserData(geometry, &group);
    rtcSetGeometryBoundsFunction(geometry, find_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_instance);
    rtcSetGeometryOccludedFunction(geometry, occlude_instance);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(to_scene(scene_), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(to_scene(scene_));
  if (rtcGetDeviceError(embree_device()) == RTC_ERROR_NONE) return;
  rtcReleaseScene(to_scene(scene_));
  throw Error("The instances do not fit into memory for casting rays at them; draw fewer grains.");
}

PlacedTree::~PlacedTree() { rtcReleaseScene(to_scene(scene_)); }

void PlacedTree::first_hits(Packet& packet, Hits& hits) const {
  alignas(32) int valid[rays_in_packet];
  RTCRayHit8 rays;
  fill(packet, rays.ray, valid);
  for (unsigned& geometry : rays.hit.geomID) geometry = RTC_INVALID_GEOMETRY_ID;
  embree::Context context;
  context.own = packet.own;
  embree::intersect(valid, to_scene(scene_), context, rays);
  for (unsigned i = 0; i < rays_in_packet; ++i) {
    if (valid[i] == 0 || rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    packet.farthest[i] = rays.ray.tfar[i];
    hits.met[i] = true;
    hits.distance[i] = rays.ray.tfar[i];
    hits.group[i] = rays.hit.geomID[i];
    hits.number[i] = groups_[rays.hit.geomID[i]].first_number + rays.hit.instID[0][i];
    hits.triangle[i] = rays.hit.primID[i];
    hits.second[i] = rays.hit.u[i];
    hits.third[i] = rays.hit.v[i];
  }
}

std::optional<Hit> PlacedTree::first_hit(const SingleRay& ray) const {
  embree::Context context;
  context.own = &ray.own;
  const RTCRayHit found =
      embree::first_hit(to_scene(scene_), ray.origin, ray.direction, 0.0F, ray.farthest, ray.from, &context.query);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{found.ray.tfar,   found.hit.geomID, groups_[found.hit.geomID].first_number + found.hit.instID[0],
             found.hit.primID, found.hit.u,      found.hit.v};
}

std::optional<Hit> PlacedTree::hit_of(std::uint32_t number, const SingleRay& ray, float near) const {
  const auto after =
      std::upper_bound(groups_.begin(), groups_.end(), number,
                       [](std::uint32_t of, const PlacedGroup& group) { return of < group.first_number; });
  const auto group = static_cast<std::size_t>(std::distance(groups_.begin(), after)) - 1;
  const PlacedGroup& placed = groups_[group];
  const RTCRayHit found =
      casting::hit_of(placed, number - placed.first_number, ray.origin, ray.direction, near, ray.farthest);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{found.ray.tfar, static_cast<std::uint32_t>(group), number, found.hit.primID, found.hit.u, found.hit.v};
}

bool PlacedTree::may_reach(const glm::vec3& place, float distance) const {
  // The box stands between three pairs of planes; a flat ground's are one.
  const auto beside = [&](const glm::vec3& row, const glm::vec3& from, float half) {
    return std::abs(glm::dot(row, from)) > half + distance * glm::length(row);
  };
  for (const PlacedGroup& group : groups_)
    for (std::uint32_t i = 0; i < group.count; ++i) {
      const ToMesh to_mesh(group.rows + 3 * std::size_t{i});
      const glm::vec3 from = place - to_mesh.place;
      const glm::vec3& half = group.mesh->half();
      if (!beside(to_mesh.x, from, half.x) && !beside(to_mesh.y, from, half.y) && !beside(to_mesh.z, from, half.z))
        return true;
    }
  return false;
}

void PlacedTree::find_occluded(Packet& packet) const {
  alignas(32) int valid[rays_in_packet];
  RTCRay8 rays;
  fill(packet, rays, valid);
  embree::Context context;
  context.own = packet.own;
  embree::occlude(valid, to_scene(scene_), context, rays);
  for (unsigned i = 0; i < rays_in_packet; ++i)
    if (valid[i] != 0 && rays.tfar[i] < 0.0F) packet.cast[i] = false;
}

}  // namespace mesograin::casting
