// Rays of neighbouring pixels go together.
#include "render/cast_shadows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "render/cast_work.h"
#include "render/pixel_rays.h"

namespace mesograin::render {
namespace {

constexpr int across = 4, high = 2;
static_assert(across * high == static_cast<int>(casting::rays_in_packet));

// Of a grain's radius: how far from its own surface a ray begins that may meet it again.
constexpr float clear_of_itself = 1e-4F;

// What of an instance its shadows depend on.
struct Shaded {
  glm::vec4 ball;
  std::uint32_t number;  // by which shadows know it
  bool itself;           // it may stand in its own light
};

Shaded shaded_of(const Content& content, std::size_t number) {
  const Instances* instances = content.instances();
  const std::size_t count = instances != nullptr ? instances->count() : 0;
  if (number < count)
    return {instances->ball(number), static_cast<std::uint32_t>(number), instances->shades_itself(number)};
  const std::size_t index = number - count;
  const Draw& draw = content.draws()[index];
  return {glm::vec4(glm::vec3(draw.centre - content.anchor()), static_cast<float>(draw.radius)),
          static_cast<std::uint32_t>(content.object_number(index)), content.shades_itself(draw)};
}

// The place where light arrives at a pixel.
struct Lit {
  glm::vec3 place;  // from the anchor
  glm::vec3 normal;
  Shaded shaded;
};

/// Where a ray goes; nowhere if it does not leave the surface.
struct Way {
  glm::vec3 along;
  float farthest = std::numeric_limits<float>::infinity();  // in lengths of it
};

// As shade.frag makes it of what is seen there.
Lit lit_at(const Content& content, const glm::vec4& position, const glm::vec4& facing, const glm::vec4& viewer) {
  const Shaded shaded = shaded_of(content, static_cast<std::size_t>(std::abs(facing.w)) - 1);
  glm::vec3 normal(facing);
  glm::vec3 place = glm::vec3(shaded.ball) + glm::vec3(position);
  const glm::vec3 to_viewer = glm::normalize(glm::vec3(viewer) - viewer.w * place);
  float cosine = glm::dot(normal, to_viewer);
  constexpr float grazing = -0.1F;
  if (facing.w < 0.0F && cosine < grazing) {
    normal = -normal;
    cosine = -cosine;
  }
  constexpr float least_cosine = 1e-4F;
  if (cosine < least_cosine) normal = glm::normalize(normal + (least_cosine - cosine) * to_viewer);
  // From the tangent planes of the triangle's corners: a facet that turns from the light where its curve does not yet
  // would stand in its own light (Hanika, "Hacking the Shadow Terminator", 2021). The curved surface rises half as far.
  if (shaded.itself)
    place += 2.0F * std::max(position.w, 0.0F) * glm::vec3(facing) + clear_of_itself * shaded.ball.w * normal;
  return {place, normal, shaded};
}

}  // namespace

bool CastShadows::cast(const CastContent& cast, const Content& content, const SeenSurfaces& seen,
                       const std::vector<ShadowEye>& eyes, const GoOn& go_on) {
  return cast_rounds(cast, content, seen, eyes.size(), go_on, [&](std::size_t light, std::size_t, const Lit& lit) {
    const glm::vec3 eye(eyes[light]);
    return eyes[light].w > 0.0 ? Way{eye - lit.place, 1.0F} : Way{eye};
  });
}

bool CastShadows::cast(const CastContent& cast, const Content& content, const SeenSurfaces& seen,
                       const std::vector<glm::vec4>& ways, const GoOn& go_on) {
  return cast_rounds(cast, content, seen, 1, go_on,
                     [&](std::size_t, std::size_t pixel, const Lit&) { return Way{glm::vec3(ways[pixel])}; });
}

template <typename WayOf>
bool CastShadows::cast_rounds(const CastContent& cast, const Content& content, const SeenSurfaces& seen,
                              std::size_t rounds, const GoOn& go_on, const WayOf& way_of) {
  const glm::ivec2 size = seen.size;
  reached_.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), 0);
  const auto cast_packet = [&](const glm::ivec2& corner, int end_row) {
    std::size_t places[casting::rays_in_packet];
    Lit lit[casting::rays_in_packet];
    bool seen_there[casting::rays_in_packet] = {};
    bool any = false;
    for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
      const glm::ivec2 pixel = corner + glm::ivec2(static_cast<int>(ray) % across, static_cast<int>(ray) / across);
      if (pixel.x >= size.x || pixel.y >= end_row) continue;
      places[ray] =
          static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(pixel.x);
      const glm::vec4& facing = seen.normals[places[ray]];
      if (facing.w == 0.0F) continue;
      lit[ray] = lit_at(content, seen.positions[places[ray]], facing, seen.viewer);
      seen_there[ray] = any = true;
    }
    for (std::size_t round = 0; any && round < rounds; ++round) {
      casting::Packet packet;
      for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
        if (!seen_there[ray]) continue;
        const Way way = way_of(round, places[ray], lit[ray]);
        if (glm::dot(way.along, lit[ray].normal) <= 0.0F) continue;
        packet.set(ray, lit[ray].place, way.along, way.farthest);
        const Shaded& shaded = lit[ray].shaded;
        packet.from[ray] = shaded.number;
        if (shaded.itself) packet.own[ray] = clear_of_itself * shaded.ball.w / glm::length(way.along);
      }
      cast.find_occluded(packet);
      for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray)
        if (packet.cast[ray]) reached_[places[ray]] |= 1U << round;
    }
  };
  const bool whole = cast_rows(size.y, go_on, [&](int first, int end) {
    for (int y = first; y < end; y += high)
      for (int x = 0; x < size.x; x += across) cast_packet({x, y}, end);
  });
  if (!whole) return false;
  if (!device_ || device_->width() != size.x || device_->height() != size.y) {
    device_.emplace(GL_R32UI, size.x, size.y);
  }
  device_->upload(GL_RED_INTEGER, GL_UNSIGNED_INT, reached_.data());
  return true;
}

void CastShadows::bind(const gl::Program& program) const {
  if (device_) program.set("lights_that_reach", *device_);
}

bool cast_shadow_map(const CastContent& cast, const Content& content, const glm::dmat4& anchor_to_clip,
                     const ShadowEye& eye, int resolution, std::vector<glm::vec2>& texels, const GoOn& go_on) {
  const PixelRays rays(anchor_to_clip, glm::dvec2(resolution), glm::dvec2(0.0), content.bounds());
  texels.resize(static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution));
  const glm::vec3 from(eye);
  const auto cast_packet = [&](int x, int y) {
    casting::Packet packet;
    casting::Hits hits;
    for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
      const PixelRay through = rays.at(x + static_cast<int>(ray) % across, y + static_cast<int>(ray) / across);
      packet.set(ray, through.origin, through.direction, through.farthest);
    }
    cast.first_hits(packet, hits);
    for (unsigned ray = 0; ray < casting::rays_in_packet; ++ray) {
      const auto row = static_cast<std::size_t>(y) + ray / across;
      glm::vec2& texel =
          texels[row * static_cast<std::size_t>(resolution) + static_cast<std::size_t>(x) + ray % across];
      texel = glm::vec2(-3e38F, 0.0F);
      if (!hits.met[ray]) continue;
      const glm::vec3 place =
          glm::vec3(packet.origin_x[ray], packet.origin_y[ray], packet.origin_z[ray]) +
          hits.distance[ray] * glm::vec3(packet.direction_x[ray], packet.direction_y[ray], packet.direction_z[ray]);
      const float nearness = eye.w > 0.0 ? -glm::distance(place, from) : glm::dot(place, from);
      texel = {nearness, static_cast<float>(hits.number[ray] + 1)};
    }
  };
  return cast_rows(resolution, go_on, [&](int first, int end) {
    for (int y = first; y < end; y += high)
      for (int x = 0; x < resolution; x += across) cast_packet(x, y);
  });
}

}  // namespace mesograin::render
