// A cross bilateral filter (Eisemann and Durand, "Flash photography enhancement via intrinsic relighting", 2004) whose
// guide is noiseless: whose surface it is, and a direction. Rows first, then columns, which costs 2 n instead of n^2
// neighbours and hardly differs (Pham and van Vliet, "Separable bilateral filtering for fast video preprocessing",
// 2005).
#include "render/denoiser.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/cast_work.h"

namespace mesograin::render {
namespace {

// The Gaussian's variance falls with the root of the samples, between what keeps the blur of the sum from vanishing and
// what keeps its noise (Knaus and Zwicker, "Progressive photon mapping: a probabilistic approach", 2011, section 4).
constexpr double shrinking = 0.5;

// A Gaussian narrower than this leaves a pixel 97 % of itself.
constexpr double least_deviation = 0.35;

// After two, what a pixel gives and keeps comes to one within a few per cent.
constexpr int rescalings = 2;

using Pictures = std::vector<std::vector<glm::vec4>*>;

/// A Gaussian's weights at whole pixels, from the middle on.
std::vector<float> gaussian(double deviation) {
  std::vector<float> weights;
  for (int distance = 0; distance <= std::ceil(2.0 * deviation); ++distance)
    weights.push_back(static_cast<float>(std::exp(-0.5 * distance * distance / (deviation * deviation))));
  return weights;
}

/// Of what one pixel's light tells of the other's, apart from how far they are from each other.
float alike(const Likeness& one, const Likeness& other) {
  if (one.object != other.object) return 0.0F;
  const float cosine = glm::dot(one.direction, other.direction);
  const float share = std::max(cosine - one.least_alike, 0.0F) / (1.0F - one.least_alike);
  return share * share;
}

/// Pixels of the picture's rows, or of its columns.
struct Line {
  std::size_t first;
  std::size_t step;
  std::size_t length;

  std::size_t pixel(std::size_t i) const { return first + i * step; }
};

/// Filters lines one after another. What a pixel takes of another's light that one takes of its: at an edge, where
/// neighbours are fewer, pixels would else take more from those within than they give, and light would come or go. So
/// weights are scaled until each pixel's come to one (Milanfar, "Symmetrizing smoothing filters", 2013, section 2.2),
/// and what is left to that it keeps.
class LineFilter {
 public:
  explicit LineFilter(const std::vector<float>& gaussian) : gaussian_(gaussian) {}

  /// Adds to `pictures`, which hold what `relative` does, to each pixel's share.
  void run(const Line& line, const std::vector<Likeness>& likenesses, const Pictures& relative,
           const Pictures& pictures) {
    weigh(line, likenesses);
    each_pair([&](std::size_t i, std::size_t j, float weight) {
      const std::size_t one = line.pixel(i);
      const std::size_t other = line.pixel(j);
      const glm::vec4 shared(weight * glm::min(likenesses[one].share, likenesses[other].share), weight);
      for (std::size_t k = 0; k < relative.size(); ++k) {
        const glm::vec4 given = shared * ((*relative[k])[other] - (*relative[k])[one]);
        (*pictures[k])[one] += given;
        (*pictures[k])[other] -= given;
      }
    });
  }

 private:
  void weigh(const Line& line, const std::vector<Likeness>& likenesses) {
    weights_.assign(line.length * gaussian_.size(), 0.0F);
    for (std::size_t i = 0; i < line.length; ++i) {
      const Likeness& its = likenesses[line.pixel(i)];
      if (its.object == 0.0F) continue;
      for (std::size_t apart = 1; apart < std::min(gaussian_.size(), line.length - i); ++apart)
        weights_[i * gaussian_.size() + apart] = gaussian_[apart] * alike(its, likenesses[line.pixel(i + apart)]);
    }
    scales_.assign(line.length, 1.0F);
    for (int scaled = 0; scaled < rescalings; ++scaled) {
      sums_ = scales_;
      for (float& sum : sums_) sum *= sum;
      each_pair([&](std::size_t i, std::size_t j, float weight) {
        sums_[i] += weight;
        sums_[j] += weight;
      });
      for (std::size_t i = 0; i < line.length; ++i) scales_[i] /= std::sqrt(sums_[i]);
    }
  }

  template <typename Do>
  void each_pair(const Do& what) const {
    for (std::size_t i = 0; i < scales_.size(); ++i)
      for (std::size_t apart = 1; apart < std::min(gaussian_.size(), scales_.size() - i); ++apart)
        if (const float weight = weights_[i * gaussian_.size() + apart]; weight > 0.0F)
          what(i, i + apart, scales_[i] * scales_[i + apart] * weight);
  }

  const std::vector<float>& gaussian_;
  std::vector<float> weights_;  // of each pixel and those after it
  std::vector<float> scales_;
  std::vector<float> sums_;
};

}  // namespace

bool Denoiser::run(const glm::ivec2& size, std::uint32_t index, const std::vector<Likeness>& likenesses,
                   const std::vector<std::vector<glm::vec4>*>& pictures, double deviation, const GoOn& go_on) {
  deviation *= std::pow(index + 1.0, -0.5 * shrinking);
  if (deviation < least_deviation) return true;
  if (std::none_of(likenesses.begin(), likenesses.end(), [](const Likeness& its) { return its.object != 0.0F; }))
    return true;  // no pixel has noise
  const std::vector<float> weights = gaussian(deviation);
  const auto width = static_cast<std::size_t>(size.x);
  const auto height = static_cast<std::size_t>(size.y);
  const auto along = [&](int lines, const auto& line_at) {
    relative_.resize(pictures.size());
    Pictures relative;
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      relative_[k] = *pictures[k];
      for (std::size_t i = 0; i < likenesses.size(); ++i) relative_[k][i] /= glm::vec4(likenesses[i].share, 1.0F);
      relative.push_back(&relative_[k]);
    }
    return cast_rows(lines, go_on, [&](int first, int end) {
      LineFilter filter(weights);
      for (int i = first; i < end; ++i)
        filter.run(line_at(static_cast<std::size_t>(i)), likenesses, relative, pictures);
    });
  };
  return along(size.y,
               [&](std::size_t y) {
                 return Line{y * width, 1, width};
               }) &&
         along(size.x, [&](std::size_t x) {
           return Line{x, width, height};
         });
}

}  // namespace mesograin::render
