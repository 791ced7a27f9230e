// The per-pixel test against several seeds of one reference.
#include "image/significance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scene/error.h"

namespace mesograin::image {
namespace {

// Sums over squares around every pixel, from running sums along rows and then columns.
std::vector<double> box_sums(const std::vector<double>& values, int width, int height, int radius) {
  const auto at = [width](int x, int y) { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x; };
  std::vector<double> rows(values.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0.0;
      for (int u = std::max(0, x - radius); u <= std::min(width - 1, x + radius); ++u) sum += values[at(u, y)];
      rows[at(x, y)] = sum;
    }
  std::vector<double> sums(values.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0.0;
      for (int v = std::max(0, y - radius); v <= std::min(height - 1, y + radius); ++v) sum += rows[at(x, v)];
      sums[at(x, y)] = sum;
    }
  return sums;
}

bool all_finite(const ImageView& image, const std::vector<ImageView>& references, int colours, int x, int y) {
  const auto finite = [&](const ImageView& view) {
    return std::all_of(view.at(x, y), view.at(x, y) + colours, [](float value) { return std::isfinite(value); });
  };
  return finite(image) && std::all_of(references.begin(), references.end(), finite);
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;  // of one reference, unbiased
};

Moments moments(const std::vector<ImageView>& references, int x, int y, int channel) {
  const auto count = static_cast<double>(references.size());
  double sum = 0.0;
  for (const ImageView& reference : references) sum += reference.at(x, y)[channel];
  const double mean = sum / count;
  double squares = 0.0;
  for (const ImageView& reference : references) squares += std::pow(reference.at(x, y)[channel] - mean, 2);
  return {mean, squares / (count - 1.0)};
}

// The normal score with nearly the tail of Student's t: Wallace 1959, equation 2.
double normal_score(double t, double degrees_of_freedom) {
  return (8.0 * degrees_of_freedom + 1.0) / (8.0 * degrees_of_freedom + 3.0) *
         std::sqrt(degrees_of_freedom * std::log1p(t * t / degrees_of_freedom));
}

void check(const ImageView& image, const std::vector<ImageView>& references, const Mask& mask) {
  if (references.size() < 2)
    throw Error("A significance test needs two or more references of independent noise; got {}.", references.size());
  for (const ImageView& reference : references)
    if (reference.width != image.width || reference.height != image.height || reference.channels != image.channels)
      throw Error("Image and references must have one shape; got ({}, {}, {}) and ({}, {}, {}).", image.height,
                  image.width, image.channels, reference.height, reference.width, reference.channels);
  if (mask.width != image.width || mask.height != image.height)
    throw Error("The mask must have the image's size, {} x {}; got {} x {}.", image.width, image.height, mask.width,
                mask.height);
}

}  // namespace

Significance test_significance(const ImageView& image, const std::vector<ImageView>& references, const Mask& mask,
                               const SignificanceOptions& options) {
  check(image, references, mask);
  const int colours = image.channels == 4 ? 3 : image.channels;
  const int width = image.width;
  const int height = image.height;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto count = static_cast<double>(references.size());

  std::vector<double> tested(pixels, 0.0);
  double used = 0.0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x;
      if (mask.pixels[pixel] != 0 && all_finite(image, references, colours, x, y)) used += tested[pixel] = 1.0;
    }
  if (used == 0.0) throw Error("A significance test needs at least one masked pixel that is finite in every image.");
  const std::vector<double> neighbours = box_sums(tested, width, height, variance_window / 2);

  Significance result;
  result.p_value = {width, height, 1, std::vector<float>(pixels, 1.0F)};
  result.score = {width, height, colours, std::vector<float>(pixels * static_cast<std::size_t>(colours), 0.0F)};
  result.tests = static_cast<std::int64_t>(used) * colours;
  result.threshold = -std::expm1(std::log1p(-options.false_alarm_rate) / static_cast<double>(result.tests));

  for (int channel = 0; channel < colours; ++channel) {
    std::vector<double> means(pixels, 0.0);
    std::vector<double> variances(pixels, 0.0);
    std::vector<double> levels(pixels, 0.0);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      if (tested[pixel] == 0.0) continue;
      const int x = static_cast<int>(pixel % static_cast<std::size_t>(width));
      const int y = static_cast<int>(pixel / static_cast<std::size_t>(width));
      const Moments here = moments(references, x, y, channel);
      means[pixel] = here.mean;
      variances[pixel] = here.variance;
      levels[pixel] = std::abs(image.at(x, y)[channel]);
    }
    const std::vector<double> variance_sums = box_sums(variances, width, height, variance_window / 2);
    const std::vector<double> level_sums = box_sums(levels, width, height, variance_window / 2);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      if (tested[pixel] == 0.0) continue;
      const int x = static_cast<int>(pixel % static_cast<std::size_t>(width));
      const int y = static_cast<int>(pixel / static_cast<std::size_t>(width));
      const double difference = image.at(x, y)[channel] - means[pixel];
      constexpr double rounding = 1e-6;  // of single precision, on both sides
      const double excess = std::abs(difference) - (options.relative_tolerance + rounding) * std::abs(means[pixel]);
      if (excess <= 0.0) continue;
      // The variance of Monte Carlo grows with what is estimated, so neighbours share it in proportion to the level.
      // The level is taken from the image, which is right if the hypothesis is, and not from the references: a pixel
      // that came out dark by chance would seem less noisy than it is.
      const double share = level_sums[pixel] > 0.0 ? levels[pixel] / level_sums[pixel] : 1.0 / neighbours[pixel];
      const double deviation = std::sqrt(variance_sums[pixel] * share / count);
      const double score = deviation > 0.0 ? normal_score(excess / deviation, (count - 1.0) * neighbours[pixel]) : 1e3;
      const double p_value = std::erfc(score / std::sqrt(2.0));
      result.score.pixels[pixel * static_cast<std::size_t>(colours) + static_cast<std::size_t>(channel)] =
          static_cast<float>(std::copysign(score, difference));
      result.p_value.pixels[pixel] = std::min(result.p_value.pixels[pixel], static_cast<float>(p_value));
    }
  }
  result.significant_pixels =
      std::count_if(result.p_value.pixels.begin(), result.p_value.pixels.end(),
                    [&](float p_value) { return static_cast<double>(p_value) < result.threshold; });
  result.differs = result.significant_pixels > 0;
  return result;
}

}  // namespace mesograin::image
