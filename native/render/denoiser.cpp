// A cross bilateral filter (Eisemann and Durand, "Flash photography enhancement via intrinsic relighting", 2004) whose
// guide is noiseless: whose surface it is, and its normal. Rows first, then columns, which costs 2 n instead of n^2
// neighbours and hardly differs (Pham and van Vliet, "Separable bilateral filtering for fast video preprocessing",
// 2005).
#include "render/denoiser.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "render/cast_work.h"

namespace mesograin::render {
namespace {

// In pixels, of the first sample's Gaussian.
constexpr double first_deviation = 2.0;

// Its variance falls with the root of the samples, between what keeps the blur of the sum from vanishing and what keeps
// its noise (Knaus and Zwicker, "Progressive photon mapping: a probabilistic approach", 2011, section 4).
constexpr double shrinking = 0.5;

// A Gaussian narrower than this leaves a pixel 97 % of itself.
constexpr double least_deviation = 0.35;

// Of the cosine between two normals: 26 degrees apart, pixels tell each other nothing.
constexpr float least_alike = 0.9F;

/// A Gaussian's weights at whole pixels, from the middle on.
std::vector<float> gaussian(double deviation) {
  std::vector<float> weights;
  for (int distance = 0; distance <= std::ceil(2.0 * deviation); ++distance)
    weights.push_back(static_cast<float>(std::exp(-0.5 * distance * distance / (deviation * deviation))));
  return weights;
}

/// Pixels of the picture's rows, or of its columns.
struct Line {
  std::size_t first;
  std::size_t step;
  int length;
};

void filter(const Line& line, const std::vector<float>& weights, const std::vector<glm::vec4>& guides,
            const std::vector<glm::vec4>& from, std::vector<glm::vec4>& to) {
  const int reach = static_cast<int>(weights.size()) - 1;
  for (int i = 0; i < line.length; ++i) {
    const std::size_t here = line.first + static_cast<std::size_t>(i) * line.step;
    const glm::vec4& guide = guides[here];
    if (guide.w == 0.0F) continue;
    glm::vec4 sum(0.0F);
    float all = 0.0F;
    for (int j = std::max(i - reach, 0); j <= std::min(i + reach, line.length - 1); ++j) {
      const std::size_t there = line.first + static_cast<std::size_t>(j) * line.step;
      const glm::vec4& other = guides[there];
      if (other.w != guide.w) continue;
      const float cosine = glm::dot(glm::vec3(guide), glm::vec3(other));
      const float alike = std::max(cosine - least_alike, 0.0F) / (1.0F - least_alike);
      const float weight = weights[static_cast<std::size_t>(std::abs(i - j))] * alike * alike;
      sum += weight * from[there];
      all += weight;
    }
    to[here] = sum / all;
  }
}

}  // namespace

bool Denoiser::run(const SeenSurfaces& seen, std::uint32_t index, const std::vector<glm::vec4>& looked_at,
                   const std::vector<std::vector<glm::vec4>*>& pictures, const GoOn& go_on) {
  const double deviation = first_deviation * std::pow(index + 1.0, -0.5 * shrinking);
  if (deviation < least_deviation) return true;
  const std::vector<float> weights = gaussian(deviation);
  guides_.resize(seen.normals.size());
  for (std::size_t i = 0; i < guides_.size(); ++i)
    guides_[i] = glm::vec4(glm::vec3(seen.normals[i]), looked_at[i].w != 0.0F ? std::abs(seen.normals[i].w) : 0.0F);
  across_.resize(pictures.size());
  for (std::size_t k = 0; k < pictures.size(); ++k) across_[k].resize(guides_.size());
  const auto width = static_cast<std::size_t>(seen.size.x);
  return cast_rows(seen.size.y, go_on,
                   [&](int first, int end) {
                     for (int y = first; y < end; ++y)
                       for (std::size_t k = 0; k < pictures.size(); ++k)
                         filter({static_cast<std::size_t>(y) * width, 1, seen.size.x}, weights, guides_, *pictures[k],
                                across_[k]);
                   }) &&
         cast_rows(seen.size.x, go_on, [&](int first, int end) {
           for (int x = first; x < end; ++x)
             for (std::size_t k = 0; k < pictures.size(); ++k)
               filter({static_cast<std::size_t>(x), width, seen.size.y}, weights, guides_, across_[k], *pictures[k]);
         });
}

}  // namespace mesograin::render
