// The device's text again, on this side.
#include "render/hit_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/stencil.h"

namespace mesograin::render {
namespace {

struct Surface {
  glm::vec4 position;
  glm::vec4 normal;
  bool flat;
};

// The mean of unit normals is as long where they are one.
constexpr float least_flat = 1.0F - 1e-4F;

// As instanced_surface.vert and surface.frag make it of the corners; what grain space is, is told there.
Surface surface_at(const scene::Mesh& mesh, const glm::vec4* rows, const glm::uvec3& corners, const glm::vec3& weights,
                   const glm::vec3& direction, std::uint32_t number) {
  const glm::vec3 a(rows[0]), b(rows[1]), c(rows[2]);
  const glm::vec3 bc = glm::cross(b, c), ca = glm::cross(c, a), ab = glm::cross(a, b);
  const float handedness = glm::dot(a, bc) < 0.0F ? -1.0F : 1.0F;
  const glm::vec3 middle(0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper())));
  std::array<glm::vec3, 3> places;
  glm::vec3 position(0.0F);
  glm::vec3 normal(0.0F);
  float plane_offset = 0.0F;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 in_mesh = mesh.positions()[corners[i]] - middle;
    const glm::vec3& of_mesh = mesh.normals()[corners[i]];
    glm::vec3& place = places[static_cast<std::size_t>(i)];
    place = glm::vec3(glm::dot(a, in_mesh), glm::dot(b, in_mesh), glm::dot(c, in_mesh));
    const glm::vec3 turned(glm::dot(bc, of_mesh), glm::dot(ca, of_mesh), glm::dot(ab, of_mesh));
    const glm::vec3 unit = handedness * glm::normalize(turned);
    position += weights[i] * place;
    normal += weights[i] * unit;
    plane_offset += weights[i] * glm::dot(unit, place);
  }
  // on_curved_surface of curved_surface.glsl, along the unit normal.
  const float squared = glm::dot(normal, normal);
  const float length = std::sqrt(squared);
  const float rise = 0.5F * (plane_offset - glm::dot(position, normal)) / std::max(squared, 0.25F) * length;
  const glm::vec3 across = glm::cross(places[1] - places[0], places[2] - places[0]);
  const float side = handedness * glm::dot(across, direction) < 0.0F ? 1.0F : -1.0F;
  return {glm::vec4(position, rise),
          glm::vec4(length > 0.0F ? normal / length : glm::vec3(0.0F), side * static_cast<float>(number + 1)),
          squared > least_flat};
}

// basis_around of tangent.glsl.
std::array<glm::vec3, 2> basis_around(const glm::vec3& normal) {
  const float side = normal.z >= 0.0F ? 1.0F : -1.0F;
  const float a = -1.0F / (side + normal.z);
  const float b = normal.x * normal.y * a;
  return {glm::vec3(1.0F + side * normal.x * normal.x * a, side * b, -side * normal.x),
          glm::vec3(b, side + normal.y * normal.y * a, -normal.y)};
}

// As surface.frag writes them where there are pictures.
glm::vec4 coordinates_at(const scene::Mesh& mesh, const glm::vec4* rows, const glm::uvec3& corners,
                         const glm::vec3& weights, const glm::vec3& normal) {
  if (mesh.uvs().empty()) return glm::vec4(0.0F);
  const glm::vec2 first = mesh.uvs()[corners[0]], second = mesh.uvs()[corners[1]], third = mesh.uvs()[corners[2]];
  const glm::vec2 uv = weights[0] * first + weights[1] * second + weights[2] * third;
  const glm::vec2 uv_a = second - first, uv_b = third - first;
  const float area = uv_a.x * uv_b.y - uv_b.x * uv_a.y;
  if (area == 0.0F) return {uv, 0.0F, 0.0F};
  const auto placed = [&](const glm::vec3& in_mesh) {
    return glm::vec3(glm::dot(glm::vec3(rows[0]), in_mesh), glm::dot(glm::vec3(rows[1]), in_mesh),
                     glm::dot(glm::vec3(rows[2]), in_mesh));
  };
  const glm::vec3& origin = mesh.positions()[corners[0]];
  const glm::vec3 place_a = placed(mesh.positions()[corners[1]] - origin);
  const glm::vec3 place_b = placed(mesh.positions()[corners[2]] - origin);
  const glm::vec3 along_u = (place_a * uv_b.y - place_b * uv_a.y) / area;
  const glm::vec3 along_v = (place_b * uv_a.x - place_a * uv_b.x) / area;
  const auto [across, up] = basis_around(normal);
  const float side = glm::dot(glm::cross(normal, along_u), along_v) < 0.0F ? -1.0F : 1.0F;
  return {uv, std::atan2(glm::dot(along_u, up), glm::dot(along_u, across)), side};
}

}  // namespace

HitSurface hit_surface(const CastContent& cast, const Content& content, const casting::Packet& packet,
                       const casting::Hits& hits, unsigned ray) {
  return hit_surface(cast, content, {packet.direction_x[ray], packet.direction_y[ray], packet.direction_z[ray]},
                     hits.of(ray));
}

HitSurface hit_surface(const CastContent& cast, const Content& content, const glm::vec3& direction,
                       const casting::Hit& hit) {
  const Instances* instances = content.instances();
  const std::size_t count = instances != nullptr ? instances->count() : 0;
  const bool instanced = hit.number < count;
  const std::size_t group = hit.group;
  const scene::Mesh& mesh =
      instanced ? *instances->prototypes()[instances->groups()[group].prototype].mesh : *content.draws()[group].source;
  const DeviceMaterial& material = instanced ? *instances->groups()[group].material : *content.draws()[group].material;
  const glm::vec4* rows = instanced ? instances->rows(hit.number) : cast.rows(group);
  const std::size_t number = instanced ? hit.number : content.number(group);
  const glm::vec3 weights(1.0F - hit.second - hit.third, hit.second, hit.third);
  const glm::uvec3& corners = mesh.triangles()[hit.triangle];
  const Surface surface = surface_at(mesh, rows, corners, weights, direction, static_cast<std::uint32_t>(number));
  const glm::vec4 coordinates =
      material.textured() ? coordinates_at(mesh, rows, corners, weights, surface.normal) : glm::vec4(0.0F);
  const std::size_t groups = instances != nullptr ? instances->groups().size() : 0;
  return {surface.position,
          surface.normal,
          coordinates,
          glm::vec3(rows[0].w, rows[1].w, rows[2].w),
          instanced ? group : groups + group,
          surface.flat};
}

void FoundSurfaces::resize(const glm::ivec2& size, bool textured) {
  const auto pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  positions_.resize(pixels);
  normals_.resize(pixels);
  coordinates_.resize(textured ? pixels : 0);
  depths_.resize(pixels);
  marks_.resize(pixels);
}

void FoundSurfaces::put(std::size_t pixel, const HitSurface& surface, float depth) {
  positions_[pixel] = surface.position;
  normals_[pixel] = surface.normal;
  if (!coordinates_.empty()) coordinates_[pixel] = surface.coordinates;
  depths_[pixel] = {depth, 0};
  marks_[pixel] = surface.unit + 1;  // HitSurface::unshaded is 0
}

void FoundSurfaces::put_nothing(std::size_t pixel) {
  positions_[pixel] = normals_[pixel] = glm::vec4(0.0F);
  depths_[pixel] = {1.0F, 0};
  marks_[pixel] = 0;
}

std::vector<PixelBox> FoundSurfaces::boxes(const glm::ivec2& size, std::size_t units) const {
  std::vector<PixelBox> boxes(units);
  bool any = false;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const std::size_t mark =
          marks_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x)];
      if (mark == 0) continue;
      PixelBox& box = boxes[mark - 1];
      const glm::ivec2 pixel(x, y);
      if (box.first == box.end) box = {pixel, pixel};
      box = {glm::min(box.first, pixel), glm::max(box.end, pixel + 1)};
      any = true;
    }
  if (!any) boxes.clear();
  return boxes;
}

void FoundSurfaces::upload(Targets& targets, std::size_t first) {
  for (std::size_t i = 0; i < marks_.size(); ++i)
    depths_[i].stencil = marks_[i] > 0 ? static_cast<std::uint32_t>(stencil_mark(marks_[i] - 1, first)) : 0;
  targets.position.upload(GL_RGBA, GL_FLOAT, positions_.data());
  targets.normal.upload(GL_RGBA, GL_FLOAT, normals_.data());
  targets.depth.upload(GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, depths_.data());
  if (targets.coordinates) targets.coordinates->upload(GL_RGBA, GL_FLOAT, coordinates_.data());
}

}  // namespace mesograin::render
