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

// Small grains' pixels are two fifths off by noise, and coarser ways 3 % by what they are: so many probes that find the
// same both ways count beside those that there are.
constexpr double probes_beforehand = 192.0;

// Beyond that it is noise of very little light.
constexpr double most = 2.0;

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

Level level_of(bool is_ball, float pixels_across) {
  if (pixels_across < walked_from) return Level::told;
  return is_ball || pixels_across >= shaped_from ? Level::own_shape : Level::ball;
}

void Amends::add(const Probe& probe) {
  if (probe.unit >= sums_.size()) sums_.resize(probe.unit + 1);
  Sums& sums = sums_[probe.unit][static_cast<std::size_t>(probe.level)];
  const auto scattered = [](const heap::Gather::All& all) { return all.others - all.straight + all.scattered; };
  const auto straight = [](const heap::Gather::All& all) { return all.straight + all.world; };
  sums.scattered.closest += scattered(probe.closest);
  sums.scattered.coarse += scattered(probe.coarse);
  sums.straight.closest += straight(probe.closest);
  sums.straight.coarse += straight(probe.coarse);
  ++sums.probes;
}

Amends::Factors Amends::factors(std::size_t unit, Level level) const {
  if (unit >= sums_.size()) return {};
  const Sums& sums = sums_[unit][static_cast<std::size_t>(level)];
  const double known = sums.probes / (sums.probes + probes_beforehand);
  const auto factor = [&](const Pair& pair) {
    glm::vec3 result(1.0F);
    for (int channel = 0; channel < 3; ++channel)
      if (pair.coarse[channel] > 0.0)
        result[channel] = static_cast<float>(
            glm::mix(1.0, std::clamp(pair.closest[channel] / pair.coarse[channel], 1.0 / most, most), known));
    return result;
  };
  return {factor(sums.scattered), factor(sums.straight)};
}

}  // namespace mesograin::render
