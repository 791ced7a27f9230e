// Subpixel reconstruction antialiasing (Chajdas, McGuire and Luebke, "Subpixel reconstruction antialiasing for deferred
// shading", 2011), which shades at a pixel's rate what it sees at a finer one; here the nearest alike is taken as it
// is, so that a pixel which shows one thing alone stays untouched.
#include "render/passes/subpixel_pass.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "casting/rays.h"
#include "render/cast_work.h"
#include "render/hit_surface.h"
#include "render/pixel_rays.h"
#include "render/surfaces.h"

namespace mesograin::render {
namespace {

// A picture of more has edges from where its samples are, and nothing that was taken from beside.
constexpr std::uint32_t most_samples = 2;

// Of the nine around a pixel.
constexpr std::uint8_t own_sample = 4;

// A cosine between normals, below which one thing shows two faces.
constexpr float one_face = 0.9F;

/// How much one tells of the other.
float alike(const glm::vec4& one, const glm::vec4& other) {
  if (one.w == 0.0F || other.w == 0.0F) return one.w == other.w ? 1.0F : 0.0F;
  if (std::abs(one.w) != std::abs(other.w)) return 0.0F;
  return std::max(glm::dot(glm::vec3(one), glm::vec3(other)), 1e-3F);
}

/// Point `i` of so many (J. M. Hammersley's; powers of two), each in a row and a column of its own.
glm::dvec2 hammersley(int i, int points) {
  double mirrored = 0.0;
  for (int bit = 1, place = points / 2; place > 0; bit *= 2, place /= 2)
    if ((i & bit) != 0) mirrored += static_cast<double>(place) / points;
  return {static_cast<double>(i) / points, mirrored};
}

}  // namespace

bool SubpixelPass::look(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces) {
  const bool by_rays = sample.cast || sample.device_rays;
  ran_ = by_rays && sample.traced && sample.gathers && sample.index < most_samples;
  if (!ran_) return true;
  const auto start = std::chrono::steady_clock::now();
  const SeenSurfaces seen = surfaces.seen(sample);
  const glm::ivec2 size = sample.size;
  const PixelRays rays(anchor_to_clip(sample.content, sample.camera), size, glm::dvec2(0.0),
                       sample.content.instances()->bounds());
  // Where in its pixel the sample is, and the others are, from the middle on.
  const glm::dvec2 own = -0.5 * glm::dvec2(sample.jitter) * glm::dvec2(size);
  std::array<glm::dvec2, places> at;
  for (int i = 0; i < places; ++i) {
    const glm::dvec2 beside = own + hammersley(i, places);
    at[static_cast<std::size_t>(i)] = beside - glm::floor(beside + 0.5);
  }
  const auto normal_at = [&](int x, int y) -> const glm::vec4& {
    return seen.normals[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x)];
  };
  const auto is_edge = [&](int x, int y) {
    const glm::vec4& its = normal_at(x, y);
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, size.y - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, size.x - 1); ++u)
        if (alike(its, normal_at(u, v)) < one_face) return true;
    return false;
  };
  const auto surface_of = [&](const casting::Packet& packet, const casting::Hits& hits, unsigned ray) {
    return hits.met[ray] ? hit_surface(arrays.tree(), sample.content, packet, hits, ray).normal : glm::vec4(0.0F);
  };
  // Which of the nine samples around a pixel shows what is seen at a place of it, or its own.
  const auto source = [&](int x, int y, const glm::dvec2& place, const glm::vec4& shown) {
    std::uint8_t best = own_sample;
    if (alike(shown, normal_at(x, y)) >= one_face) return best;
    float most = 0.0F;
    for (int v = -1; v <= 1; ++v)
      for (int u = -1; u <= 1; ++u) {
        if (x + u < 0 || x + u >= size.x || y + v < 0 || y + v >= size.y) continue;
        const float near = alike(shown, normal_at(x + u, y + v));
        if (near == 0.0F) continue;
        const glm::vec2 way = glm::vec2(glm::dvec2(u, v) + own - place);
        const float score = near * near * near * near / (1.0F + glm::dot(way, way));
        if (score <= most) continue;
        most = score;
        best = static_cast<std::uint8_t>(3 * (v + 1) + u + 1);
      }
    return best;
  };
  rows_.resize(static_cast<std::size_t>(size.y));
  const bool whole = cast_rows(size.y, sample.go_on, [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      std::vector<Edge>& row = rows_[static_cast<std::size_t>(y)];
      row.clear();
      for (int x = 0; x < size.x; ++x)
        if (is_edge(x, y)) row.push_back({x, {}});
      constexpr unsigned beside = places - 1;
      constexpr unsigned in_packet = casting::rays_in_packet / beside;
      for (std::size_t i = 0; i < row.size(); i += in_packet) {
        casting::Packet packet;
        casting::Hits hits;
        const auto count = static_cast<unsigned>(std::min<std::size_t>(in_packet, row.size() - i));
        for (unsigned j = 0; j < count; ++j)
          for (unsigned k = 0; k < beside; ++k) {
            const PixelRay through = rays.at(glm::dvec2(row[i + j].x, y) + at[k + 1]);
            packet.set(j * beside + k, through.origin, through.direction, through.farthest);
          }
        arrays.tree().first_hits(packet, hits);
        for (unsigned j = 0; j < count; ++j) {
          row[i + j].shows[0] = own_sample;
          for (unsigned k = 0; k < beside; ++k)
            row[i + j].shows[k + 1] = source(row[i + j].x, y, at[k + 1], surface_of(packet, hits, j * beside + k));
        }
      }
    }
  });
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return whole;
}

void SubpixelPass::smooth(const Sample& sample) {
  if (!ran_) return;
  const auto width = static_cast<std::size_t>(sample.size.x);
  shaded_.resize(width * static_cast<std::size_t>(sample.size.y));
  sample.targets.shade.read(&shaded_.front().x);
  smoothed_ = shaded_;
  for (std::size_t y = 0; y < rows_.size(); ++y)
    for (const Edge& edge : rows_[y]) {
      glm::vec4 sum(0.0F);
      for (const std::uint8_t shows : edge.shows)
        sum += shaded_[(y + shows / 3U - 1U) * width + static_cast<std::size_t>(edge.x) + shows % 3U - 1U];
      smoothed_[y * width + static_cast<std::size_t>(edge.x)] = sum / static_cast<float>(places);
    }
  sample.targets.sample.upload(GL_RGBA, GL_FLOAT, smoothed_.data());
}

}  // namespace mesograin::render
