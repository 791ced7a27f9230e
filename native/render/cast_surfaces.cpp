// Eight neighbouring pixels at a time.
#include "render/cast_surfaces.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <set>

#include "render/cast_work.h"
#include "render/stencil.h"

namespace mesograin::render {
namespace {

struct Surface {
  glm::vec4 position;
  glm::vec4 normal;
};

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
          glm::vec4(length > 0.0F ? normal / length : glm::vec3(0.0F), side * static_cast<float>(number + 1))};
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

bool CastSurfaces::cast(const CastContent& cast, const Content& content, const glm::dmat4& anchor_to_clip,
                        const glm::vec2& jitter, const glm::ivec2& size, const GoOn& go_on) {
  const auto pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  size_ = size;
  positions_.resize(pixels);
  normals_.resize(pixels);
  coordinates_.resize(content.textured() ? pixels : 0);
  depths_.resize(pixels);
  groups_.resize(pixels);
  const PixelRays rays(anchor_to_clip, size, jitter, content.instances()->bounds());
  const glm::mat4 to_clip(anchor_to_clip);
  return cast_rows(size.y, go_on, [&](int first, int end) { cast_band(cast, content, to_clip, rays, first, end); });
}

void CastSurfaces::cast_band(const CastContent& cast, const Content& content, const glm::mat4& to_clip,
                             const PixelRays& rays, int first_row, int end_row) {
  constexpr int across = 4, high = 2;
  static_assert(across * high == static_cast<int>(casting::rays_in_packet));
  const Instances& instances = *content.instances();
  const glm::vec4 depth_row(to_clip[0].z, to_clip[1].z, to_clip[2].z, to_clip[3].z);
  const glm::vec4 w_row(to_clip[0].w, to_clip[1].w, to_clip[2].w, to_clip[3].w);
  for (int y = first_row; y < end_row; y += high)
    for (int x = 0; x < size_.x; x += across) {
      casting::Packet packet;
      casting::Hits hits;
      const auto pixel_of = [&](unsigned ray) {
        return glm::ivec2(x + static_cast<int>(ray) % across, y + static_cast<int>(ray) / across);
      };
      for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
        const glm::ivec2 pixel = pixel_of(ray);
        if (pixel.x >= size_.x || pixel.y >= end_row) continue;
        const PixelRay through = rays.at(pixel.x, pixel.y);
        packet.set(ray, through.origin, through.direction, through.farthest);
      }
      cast.instances()->first_hits(packet, hits);
      for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
        if (!packet.cast[ray]) continue;
        const glm::ivec2 pixel = pixel_of(ray);
        const auto place =
            static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(pixel.x);
        if (!hits.met[ray]) {
          positions_[place] = normals_[place] = glm::vec4(0.0F);
          depths_[place] = {1.0F, 0};
          groups_[place] = 0;
          continue;
        }
        const InstanceGroup& group = instances.groups()[hits.group[ray]];
        const scene::Mesh& mesh = *instances.prototypes()[group.prototype].mesh;
        const glm::vec4* rows = instances.rows(hits.number[ray]);
        const glm::vec3 direction(packet.direction_x[ray], packet.direction_y[ray], packet.direction_z[ray]);
        const glm::vec3 weights(1.0F - hits.second[ray] - hits.third[ray], hits.second[ray], hits.third[ray]);
        const Surface surface =
            surface_at(mesh, rows, mesh.triangles()[hits.triangle[ray]], weights, direction, hits.number[ray]);
        positions_[place] = surface.position;
        normals_[place] = surface.normal;
        if (group.material->textured())
          coordinates_[place] =
              coordinates_at(mesh, rows, mesh.triangles()[hits.triangle[ray]], weights, surface.normal);
        const glm::vec4 from_anchor(glm::vec3(surface.position) + glm::vec3(rows[0].w, rows[1].w, rows[2].w), 1.0F);
        const float depth = 0.5F * glm::dot(depth_row, from_anchor) / glm::dot(w_row, from_anchor) + 0.5F;
        depths_[place] = {std::clamp(depth, 0.0F, 1.0F), 0};
        groups_[place] = hits.group[ray] + 1;
      }
    }
}

std::size_t CastSurfaces::seen() const {
  std::set<float> numbers;
  for (const glm::vec4& normal : normals_)
    if (normal.w != 0.0F) numbers.insert(std::abs(normal.w));
  return numbers.size();
}

void CastSurfaces::upload(gl::Texture& position, gl::Texture& normal, gl::Texture& depth, std::size_t first) {
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const std::size_t group = groups_[i];
    depths_[i].stencil = group > 0 ? static_cast<std::uint32_t>(stencil_mark(group - 1, first)) : 0;
  }
  position.upload(GL_RGBA, GL_FLOAT, positions_.data());
  normal.upload(GL_RGBA, GL_FLOAT, normals_.data());
  depth.upload(GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, depths_.data());
}

}  // namespace mesograin::render
