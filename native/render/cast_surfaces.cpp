// Eight neighbouring pixels at a time.
#include "render/cast_surfaces.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "render/cast_work.h"

namespace mesograin::render {

bool CastSurfaces::cast(const CastContent& cast, const Content& content, const glm::dmat4& anchor_to_clip,
                        const glm::vec2& jitter, const glm::ivec2& size, const GoOn& go_on) {
  size_ = size;
  found_.resize(size, content.textured());
  const PixelRays rays(anchor_to_clip, size, jitter, content.instances()->bounds());
  const glm::mat4 to_clip(anchor_to_clip);
  return cast_rows(size.y, go_on, [&](int first, int end) { cast_band(cast, content, to_clip, rays, first, end); });
}

void CastSurfaces::cast_band(const CastContent& cast, const Content& content, const glm::mat4& to_clip,
                             const PixelRays& rays, int first_row, int end_row) {
  constexpr int across = 4, high = 2;
  static_assert(across * high == static_cast<int>(casting::rays_in_packet));
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
          found_.put_nothing(place);
          continue;
        }
        const HitSurface surface = hit_surface(cast, content, packet, hits, ray);
        const glm::vec4 from_anchor(glm::vec3(surface.position) + surface.origin, 1.0F);
        const float depth = 0.5F * glm::dot(depth_row, from_anchor) / glm::dot(w_row, from_anchor) + 0.5F;
        found_.put(place, surface, std::clamp(depth, 0.0F, 1.0F));
      }
    }
}

std::size_t CastSurfaces::seen() const {
  std::set<float> numbers;
  for (const glm::vec4& normal : found_.normals())
    if (normal.w != 0.0F) numbers.insert(std::abs(normal.w));
  return numbers.size();
}

}  // namespace mesograin::render
