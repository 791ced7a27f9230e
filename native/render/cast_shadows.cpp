// Rays of neighbouring pixels go together.
#include "render/cast_shadows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/cast_work.h"
#include "render/lit_place.h"
#include "render/pixel_rays.h"

namespace mesograin::render {
namespace {

constexpr int across = 4, high = 2;
static_assert(across * high == static_cast<int>(casting::rays_in_packet));

casting::SingleRay alone(const casting::Packet& packet, unsigned ray) {
  const glm::vec3 along(packet.direction_x[ray], packet.direction_y[ray], packet.direction_z[ray]);
  const float length = glm::length(along);
  return {.origin = {packet.origin_x[ray], packet.origin_y[ray], packet.origin_z[ray]},
          .direction = along / length,
          .from = packet.from[ray],
          .own = packet.own[ray] * length,
          .farthest = packet.farthest[ray] * length};
}

float fraction(float number) { return number - std::floor(number); }

// In [0, 1), of each pixel and light: the golden ratio's sequence over the samples, begun so that neighbours have
// nearly all of it between them (interleaved gradient noise: Jimenez, "Next generation post processing in Call of Duty:
// Advanced Warfare", 2014), for each light elsewhere.
float draw_of(const glm::ivec2& pixel, std::size_t light, std::uint32_t index) {
  const glm::vec2 at = glm::vec2(pixel) + 5.588238F * static_cast<float>(light);
  const float begun = fraction(52.9829189F * fraction(0.06711056F * at.x + 0.00583715F * at.y));
  return fraction(begun + 0x1p-32F * static_cast<float>(2654435769U * index));
}

}  // namespace

bool CastShadows::cast(const CastContent& cast, const Content& content, const SeenSurfaces& seen,
                       const std::function<bool(std::size_t)>& asks, const std::vector<ShadowEye>& eyes,
                       const StraightThrough* through, std::uint32_t index, const GoOn& go_on) {
  const glm::ivec2 size = seen.size;
  const std::size_t channels = through != nullptr ? 3 : 1;
  reached_.assign(channels * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), 0);
  const auto cast_packet = [&](const glm::ivec2& corner, int end_row) {
    std::size_t places[casting::rays_in_packet];
    LitPlace lit[casting::rays_in_packet];
    bool seen_there[casting::rays_in_packet] = {};
    bool any = false;
    for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
      const glm::ivec2 pixel = corner + glm::ivec2(static_cast<int>(ray) % across, static_cast<int>(ray) / across);
      if (pixel.x >= size.x || pixel.y >= end_row) continue;
      places[ray] =
          static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(pixel.x);
      const glm::vec4& facing = seen.normals[places[ray]];
      if (facing.w == 0.0F || !asks(static_cast<std::size_t>(std::abs(facing.w)) - 1)) continue;
      lit[ray] = lit_place(content, seen.positions[places[ray]], facing, seen.viewer_of(places[ray]));
      seen_there[ray] = any = true;
    }
    for (std::size_t light = 0; any && light < eyes.size(); ++light) {
      const glm::vec3 eye(eyes[light]);
      const bool near = eyes[light].w > 0.0;
      casting::Packet packet;
      for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
        if (!seen_there[ray]) continue;
        if (near)
          set_off(packet, ray, lit[ray], eye - lit[ray].place, 1.0F);
        else
          set_off(packet, ray, lit[ray], eye);
      }
      casting::Packet unhindered = packet;
      cast.find_occluded(unhindered);
      for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
        if (!packet.cast[ray]) continue;
        const bool whole = unhindered.cast[ray];
        if (!whole && through == nullptr) continue;
        const glm::vec3 left = whole ? glm::vec3(1.0F) : through->left(alone(packet, ray));
        const glm::ivec2 pixel(static_cast<int>(places[ray]) % size.x, static_cast<int>(places[ray]) / size.x);
        const float drawn = whole ? 0.0F : draw_of(pixel, light, index);
        for (std::size_t channel = 0; channel < channels; ++channel)
          if (drawn < left[static_cast<int>(channel)]) reached_[channels * places[ray] + channel] |= 1U << light;
      }
    }
  };
  const bool whole = cast_rows(size.y, go_on, [&](int first, int end) {
    for (int y = first; y < end; y += high)
      for (int x = 0; x < size.x; x += across) cast_packet({x, y}, end);
  });
  if (!whole) return false;
  on_device(size, channels);
  device_->upload(channels == 3 ? GL_RGB_INTEGER : GL_RED_INTEGER, GL_UNSIGNED_INT, reached_.data());
  return true;
}

const gl::Texture& CastShadows::on_device(const glm::ivec2& size, std::size_t channels) {
  if (!device_ || device_->width() != size.x || device_->height() != size.y || channels_ != channels) {
    device_.emplace(channels == 3 ? GL_RGB32UI : GL_R32UI, size.x, size.y);
    if (channels == 1) device_->show_first_as_all();
    channels_ = channels;
  }
  return *device_;
}

void CastShadows::bind(const gl::Program& program) const {
  if (device_) program.set("lights_that_reach", *device_);
}

bool cast_shadow_map(const CastContent& cast, const Content& content, const glm::dmat4& anchor_to_clip,
                     const ShadowEye& eye, const ThroughToMap& through, int resolution, std::vector<glm::vec2>& texels,
                     const GoOn& go_on) {
  const PixelRays rays(anchor_to_clip, glm::dvec2(resolution), glm::dvec2(0.0), content.bounds());
  texels.resize(static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution));
  const glm::vec3 from(eye);
  const auto cast_packet = [&](int x, int y) {
    casting::Packet packet;
    casting::Hits hits;
    PixelRay pixels[casting::rays_in_packet];
    for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
      const PixelRay& pixel = pixels[ray] =
          rays.at(x + static_cast<int>(ray) % across, y + static_cast<int>(ray) / across);
      packet.set(ray, pixel.origin, pixel.direction, pixel.farthest);
    }
    cast.first_hits(packet, hits);
    for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
      const glm::ivec2 at(x + static_cast<int>(ray) % across, y + static_cast<int>(ray) / across);
      const std::size_t number =
          static_cast<std::size_t>(at.y) * static_cast<std::size_t>(resolution) + static_cast<std::size_t>(at.x);
      texels[number] = glm::vec2(-3e38F, 0.0F);
      if (!hits.met[ray]) continue;
      const PixelRay& pixel = pixels[ray];
      float distance = hits.distance[ray];
      std::uint32_t of = hits.number[ray];
      if (through.straight != nullptr) {
        const float drawn = draw_of(at, through.light, through.index);
        const std::optional<casting::Hit> stopped = through.straight->stopped(
            {.origin = pixel.origin, .direction = pixel.direction, .farthest = pixel.farthest}, drawn);
        if (!stopped) continue;
        distance = stopped->distance;
        of = stopped->number;
      }
      const glm::vec3 place = pixel.origin + distance * pixel.direction;
      const float nearness = eye.w > 0.0 ? -glm::distance(place, from) : glm::dot(place, from);
      texels[number] = {nearness, static_cast<float>(of + 1)};
    }
  };
  return cast_rows(resolution, go_on, [&](int first, int end) {
    for (int y = first; y < end; y += high)
      for (int x = 0; x < resolution; x += across) cast_packet(x, y);
  });
}

}  // namespace mesograin::render
