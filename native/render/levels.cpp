// Thresholds were measured: docs/heaps.md, "Grains of a few pixels".
#include "render/levels.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace mesograin::render {
namespace {

// In pixels across.
constexpr float shaped_from = 8.0F;
constexpr float walked_from = 4.0F;
constexpr float modelled_from = 5.0F;

// Of one sample the noise of walks is no less than what numbers lack; nor is it of larger grains that are no balls,
// since walks in a ball lack something, too, and take three times as long. The light in thick ones is less even.
constexpr float walked_from_where_awaited = 8.0F;
constexpr float walked_from_where_changed = 24.0F;
constexpr double thickest_where_changed = 6.5;
constexpr float modelled_from_where_awaited = 8.0F;

// By how much coarser ways are off, of all light, where probes do not tell that it is more: what they find counts as
// far as their noise is less.
constexpr double expected = 0.03;

// Of one probe, at the least: few do not tell their noise.
constexpr double least_noise = 0.4;

// Beyond that it is noise of very little light.
constexpr double most = 2.0;

/// Of what a number is found to be off by, how much to believe of it; `noise`: the square of what it may be off by
/// chance (James and Stein 1961, "Estimation with quadratic loss", but that chance is given twice its deviation).
double share_believed(double off, double noise) {
  const double meant = std::max(expected * expected, off * off - 4.0 * noise);
  return meant / (meant + noise);
}

}  // namespace

PixelsAcross::PixelsAcross(const glm::mat4& to_clip, const glm::ivec2& size) {
  const glm::mat4 rows = glm::transpose(to_clip);
  depth_ = rows[3];
  pixels_ = std::max(glm::length(glm::vec3(rows[0])) * static_cast<float>(size.x),
                     glm::length(glm::vec3(rows[1])) * static_cast<float>(size.y));
}

float PixelsAcross::of(const glm::vec4& ball) const {
  const float depth = glm::dot(depth_, glm::vec4(glm::vec3(ball), 1.0F));
  return depth > 0.0F ? ball.w * pixels_ / depth : std::numeric_limits<float>::infinity();
}

float PixelsAcross::most(const Bounds& bounds, float radius) const {
  float most = 0.0F;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::bvec3 upper((corner & 1U) != 0, (corner & 2U) != 0, (corner & 4U) != 0);
    most = std::max(most, of(glm::vec4(glm::vec3(glm::mix(bounds.lower, bounds.upper, upper)), radius)));
  }
  return most;
}

float share_told(float pixels_across, Awaited awaited) {
  if (awaited != Awaited::no) return pixels_across < modelled_from_where_awaited ? 1.0F : 0.0F;
  return std::clamp(modelled_from + 0.5F - pixels_across, 0.0F, 1.0F);
}

Level level_of(bool is_ball, double mean_free_paths, float pixels_across, Awaited awaited) {
  const float from = awaited == Awaited::no ? walked_from
                     : awaited == Awaited::changed && mean_free_paths <= thickest_where_changed && !is_ball
                         ? walked_from_where_changed
                         : walked_from_where_awaited;
  if (pixels_across < from) return Level::told;
  return is_ball || pixels_across >= shaped_from ? Level::own_shape : Level::ball;
}

void Amends::Pair::add(const glm::dvec3& one, const glm::dvec3& other) {
  closest += one;
  coarse += other;
  squares += (one - other) * (one - other);
}

void Amends::add(const Probe& probe) {
  if (probe.unit >= sums_.size()) sums_.resize(probe.unit + 1);
  Sums& sums = sums_[probe.unit][static_cast<std::size_t>(probe.level)];
  const auto scattered = [](const heap::Gather::All& all) { return all.others - all.straight + all.scattered; };
  const auto straight = [](const heap::Gather::All& all) { return all.straight + all.world; };
  sums.scattered.add(scattered(probe.closest), scattered(probe.coarse));
  sums.straight.add(straight(probe.closest), straight(probe.coarse));
  ++sums.probes;
}

Amends::Factors Amends::factors(std::size_t unit, Level level) const {
  if (unit >= sums_.size()) return {};
  const Sums& sums = sums_[unit][static_cast<std::size_t>(level)];
  const auto factor = [&](const Pair& pair) {
    glm::vec3 result(1.0F);
    for (int channel = 0; channel < 3; ++channel) {
      const double coarse = pair.coarse[channel];
      if (!(coarse > 0.0)) continue;
      const double noise = std::max(pair.squares[channel] / (coarse * coarse), least_noise * least_noise / sums.probes);
      const double found = std::clamp(pair.closest[channel] / coarse, 1.0 / most, most);
      result[channel] = static_cast<float>(glm::mix(1.0, found, share_believed(found - 1.0, noise)));
    }
    return result;
  };
  return {factor(sums.scattered), factor(sums.straight)};
}

}  // namespace mesograin::render
