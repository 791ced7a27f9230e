// Welds the mesh, makes sure that it is closed, and hands it to Embree.
#include "transport/body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "embree/first_hit.h"
#include "scene/convexity.h"
#include "transport/axes.h"
#include "transport/convexity.h"
#include "transport/directions.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

// Edges of triangles around a hole have no partner that runs the other way.
std::size_t open_edges(const std::vector<glm::uvec3>& triangles) {
  std::unordered_map<std::uint64_t, int> balance;
  balance.reserve(2 * triangles.size());
  for (const glm::uvec3& triangle : triangles)
    for (int i = 0; i < 3; ++i) {
      const unsigned from = triangle[i], to = triangle[(i + 1) % 3];
      balance[std::uint64_t{std::min(from, to)} << 32U | std::max(from, to)] += from < to ? 1 : -1;
    }
  return static_cast<std::size_t>(
      std::count_if(balance.begin(), balance.end(), [](const auto& edge) { return edge.second != 0; }));
}

// The point of a triangle that is nearest to `p` (Ericson, "Real-time collision detection", 2005, section 5.1.5).
glm::vec3 nearest_on_triangle(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 ab = b - a, ac = c - a, ap = p - a;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0.0F && d2 <= 0.0F) return a;
  const glm::vec3 bp = p - b;
  const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0.0F && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0F && d1 >= 0.0F && d3 <= 0.0F) return a + d1 / (d1 - d3) * ab;
  const glm::vec3 cp = p - c;
  const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0.0F && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0F && d2 >= 0.0F && d6 <= 0.0F) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0F && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const float all = va + vb + vc;
  return a + vb / all * ab + vc / all * ac;
}

struct NearestQuery {
  const std::vector<glm::vec3>* positions;
  const std::vector<glm::uvec3>* triangles;
  glm::vec3 place;
  glm::vec3 point;
  unsigned triangle;
};

bool query_nearest(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<NearestQuery*>(arguments->userPtr);
  const glm::uvec3& corners = (*query.triangles)[arguments->primID];
  const std::vector<glm::vec3>& positions = *query.positions;
  const glm::vec3 point =
      nearest_on_triangle(query.place, positions[corners.x], positions[corners.y], positions[corners.z]);
  const float distance = glm::distance(point, query.place);
  if (distance >= arguments->query->radius) return false;
  arguments->query->radius = distance;
  query.point = point;
  query.triangle = arguments->primID;
  return true;
}

}  // namespace

struct Body::Device {
  Device() : device(rtcNewDevice("threads=1,set_affinity=0")) {
    if (device == nullptr) throw Error("Embree, which traces rays in grains, could not be started.");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  }
  ~Device() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  void build(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles) const {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                             positions.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                            triangles.size());
    if (vertices == nullptr || indices == nullptr) {
      rtcReleaseGeometry(geometry);
      throw Error("A mesh of {} triangles does not fit into memory for tracing rays in it.", triangles.size());
    }
    std::memcpy(vertices, positions.data(), positions.size() * sizeof(glm::vec3));
    std::memcpy(indices, triangles.data(), triangles.size() * sizeof(glm::uvec3));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }

  RTCDevice device;
  RTCScene scene = nullptr;
};

Body::Body(const scene::Mesh& mesh, const glm::dmat3& linear) : convex_(scene::is_convex(mesh)) {
  // Vertices that differ in normals or UVs alone are one.
  const auto before = [](const glm::vec3& a, const glm::vec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  };
  std::map<glm::vec3, unsigned, decltype(before)> welded(before);
  std::vector<glm::dvec3> places;
  std::vector<unsigned> vertex;
  for (const glm::vec3& position : mesh.positions()) {
    const auto [found, added] = welded.emplace(position + 0.0F, static_cast<unsigned>(places.size()));
    if (added) places.push_back(linear * glm::dvec3(position));
    vertex.push_back(found->second);
  }
  for (const glm::uvec3& corners : mesh.triangles()) {
    const glm::uvec3 triangle(vertex[corners.x], vertex[corners.y], vertex[corners.z]);
    if (triangle.x != triangle.y && triangle.y != triangle.z && triangle.z != triangle.x)
      triangles_.push_back(triangle);
  }
  if (const std::size_t open = open_edges(triangles_); open > 0)
    throw Error("Light's transport needs a closed mesh; this one has {} open edges. Close its holes.", open);

  const glm::dvec3 middle = linear * (0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper())));
  unit_ = 0.0;
  for (const glm::dvec3& place : places) unit_ = std::max(unit_, glm::distance(place, middle));
  if (!(unit_ > 0.0)) throw Error("Light's transport needs a mesh that encloses a volume; this one encloses none.");
  for (glm::dvec3& place : places) place = (place - middle) / unit_;

  double volume = 0.0;
  std::vector<glm::dvec3> areas;  // normals as long as the triangles' areas
  for (const glm::uvec3& triangle : triangles_) {
    const glm::dvec3 &a = places[triangle.x], b = places[triangle.y], c = places[triangle.z];
    areas.push_back(0.5 * glm::cross(b - a, c - a));
    volume += glm::dot(a, areas.back()) / 3.0;
    area_ += glm::length(areas.back());
  }
  // A plane that is counted there and back leaves rounding's volume.
  if (!(std::abs(volume) > 1e-5 * area_))
    throw Error("Light's transport needs a mesh that encloses a volume; this one encloses none.");
  volume_ = std::abs(volume);

  axes_ = tight_axes(places, areas, triangles_);
  for (const glm::dvec3& normal : areas) {
    const double length = glm::length(normal);
    normals_.emplace_back(length > 0.0 ? axes_ * (std::copysign(1.0 / length, volume) * normal)
                                       : glm::dvec3(0.0, 0.0, 1.0));
  }
  lower_ = glm::vec3(1.0F);
  upper_ = glm::vec3(-1.0F);
  for (const glm::dvec3& place : places) {
    positions_.emplace_back(axes_ * place);
    lower_ = glm::min(lower_, positions_.back());
    upper_ = glm::max(upper_, positions_.back());
  }
  convex_ = convex_ || nearly_convex(positions_, triangles_, normals_);

  auto device = std::make_shared<Device>();
  device->build(positions_, triangles_);
  device_ = std::move(device);
  require_alternating_sides();
}

std::optional<Hit> Body::first_hit(const glm::vec3& origin, const glm::vec3& direction) const {
  const RTCRayHit ray = embree::first_hit(device_->scene, origin, direction, 1e-6F);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{ray.ray.tfar, normals_[ray.hit.primID]};
}

std::optional<glm::vec3> Body::next_entry(glm::vec3 place, const glm::vec3& direction) const {
  constexpr int most_hits = 8;
  for (int hits = 0; hits < most_hits; ++hits) {
    const std::optional<Hit> hit = first_hit(place, direction);
    if (!hit) return std::nullopt;
    place += hit->distance * direction;
    if (glm::dot(hit->normal, direction) < 0.0F) return place;
    // Rounding may leave a place before the surface that the line has come through.
    place += 2e-6F * direction;
  }
  return std::nullopt;
}

Nearest Body::nearest(const glm::vec3& place, float within) const {
  NearestQuery query{&positions_, &triangles_, place, place, 0};
  RTCPointQuery sphere{place.x, place.y, place.z, 0.0F, within};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(device_->scene, &sphere, &context, query_nearest, &query);
  return {query.point, sphere.radius, normals_[query.triangle]};
}

// By the majority of three lines, since one may run along an edge.
bool Body::contains(const glm::vec3& place) const {
  constexpr glm::vec3 lines[] = {
      {0.5377F, 0.2183F, 0.8144F}, {-0.7071F, 0.6123F, 0.3536F}, {0.1483F, -0.9231F, -0.3548F}};
  int votes = 0;
  for (const glm::vec3& line : lines) {
    const std::optional<Hit> hit = first_hit(place, line);
    votes += hit && glm::dot(hit->normal, line) > 0.0F ? 1 : -1;
    if (std::abs(votes) == 2) break;
  }
  return votes > 0;
}

// A line enters a body that does not cross itself before it leaves it.
void Body::require_alternating_sides() const {
  constexpr int lines = 512;
  constexpr int most_hits = 64;
  int crossed = 0;
  Random random(1, 0);
  for (int i = 0; i < lines; ++i) {
    const glm::vec3 direction = isotropic(random.uniform(), random.uniform());
    const glm::vec3 aim = glm::mix(lower_, upper_, glm::vec3(random.uniform(), random.uniform(), random.uniform()));
    glm::vec3 place = aim - 3.0F * direction;
    bool inside = false;
    for (int hits = 0; hits < most_hits; ++hits) {
      const std::optional<Hit> hit = first_hit(place, direction);
      if (!hit) break;
      if ((glm::dot(hit->normal, direction) < 0.0F) == inside) {
        ++crossed;
        break;
      }
      inside = !inside;
      place += (hit->distance + 2e-6F) * direction;
    }
  }
  // A line along an edge or through a corner may miss one side by rounding.
  if (crossed > lines / 50)
    throw Error(
        "Light's transport needs a mesh that does not cross itself; of {} lines through this one {} meet its "
        "surface twice from the same side. Join its parts into one surface.",
        lines, crossed);
}

}  // namespace mesograin::transport
