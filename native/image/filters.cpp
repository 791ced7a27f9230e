// The masks of a comparison besides the silhouette.
#include "image/filters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/error.h"

namespace mesograin::image {
namespace {

void require_same_size(const ImageView& error, const Mask& mask) {
  if (error.width != mask.width || error.height != mask.height)
    throw Error("The mask must have the error image's size, {} x {}; got {} x {}.", error.width, error.height,
                mask.width, mask.height);
}

// The mean over the channels, as the error of the pixel; NaN or Inf if one of them is.
std::vector<double> pixel_errors(const ImageView& error) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(error.width) * static_cast<std::size_t>(error.height));
  for (int y = 0; y < error.height; ++y)
    for (int x = 0; x < error.width; ++x) {
      double sum = 0.0;
      for (int channel = 0; channel < error.channels; ++channel) sum += error.at(x, y)[channel];
      values.push_back(sum / error.channels);
    }
  return values;
}

Mask keep_up_to(const std::vector<double>& values, const Mask& mask, double threshold) {
  Mask kept = mask;
  for (std::size_t pixel = 0; pixel < values.size(); ++pixel)
    if (std::isfinite(values[pixel]) && values[pixel] > threshold) kept.pixels[pixel] = 0;
  return kept;
}

// Each masked pixel's median over the masked finite pixels of a square; its own value if it is not finite.
std::vector<double> medians(const std::vector<double>& values, const Mask& mask, int size) {
  std::vector<double> result = values;
  std::vector<double> window;
  const int before = (size - 1) / 2;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const auto pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) + static_cast<std::size_t>(x);
      if (mask.pixels[pixel] == 0 || !std::isfinite(values[pixel])) continue;
      window.clear();
      for (int v = std::max(0, y - before); v < std::min(mask.height, y - before + size); ++v)
        for (int u = std::max(0, x - before); u < std::min(mask.width, x - before + size); ++u) {
          const auto other =
              static_cast<std::size_t>(v) * static_cast<std::size_t>(mask.width) + static_cast<std::size_t>(u);
          if (mask.pixels[other] != 0 && std::isfinite(values[other])) window.push_back(values[other]);
        }
      const auto middle = window.begin() + static_cast<std::ptrdiff_t>(window.size() / 2);
      std::nth_element(window.begin(), middle, window.end());
      result[pixel] = *middle;
    }
  return result;
}

// The value that parts the sorted values with the largest variance between the two classes; +inf if they are all equal.
double otsu_threshold(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double total = 0.0;
  for (const double value : values) total += value;
  double best = 0.0;
  double threshold = std::numeric_limits<double>::infinity();
  double below = 0.0;
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    below += values[i];
    if (values[i] == values[i + 1]) continue;
    const auto lower = static_cast<double>(i + 1);
    const auto upper = static_cast<double>(values.size() - i - 1);
    const double between = lower * upper * std::pow(below / lower - (total - below) / upper, 2);
    if (between > best) {
      best = between;
      threshold = values[i];
    }
  }
  return threshold;
}

}  // namespace

Mask crop_mask(const Mask& mask, int left, int top, int right, int bottom) {
  if (left < 0 || top < 0 || right > mask.width || bottom > mask.height || left >= right || top >= bottom)
    throw Error("A crop must be left top right bottom inside {} x {} pixels; got {} {} {} {}.", mask.width, mask.height,
                left, top, right, bottom);
  Mask cropped = mask;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (x < left || x >= right || y < top || y >= bottom)
        cropped
            .pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) + static_cast<std::size_t>(x)] =
            0;
  return cropped;
}

Mask mean_deviation_mask(const ImageView& error, const Mask& mask, double deviations) {
  require_same_size(error, mask);
  const std::vector<double> values = pixel_errors(error);
  double count = 0.0;
  double sum = 0.0;
  for (std::size_t pixel = 0; pixel < values.size(); ++pixel)
    if (mask.pixels[pixel] != 0 && std::isfinite(values[pixel])) {
      ++count;
      sum += values[pixel];
    }
  if (count == 0.0) return mask;
  const double mean = sum / count;
  double squares = 0.0;
  for (std::size_t pixel = 0; pixel < values.size(); ++pixel)
    if (mask.pixels[pixel] != 0 && std::isfinite(values[pixel])) squares += std::pow(values[pixel] - mean, 2);
  return keep_up_to(values, mask, mean + deviations * std::sqrt(squares / count));
}

Mask otsu_mask(const ImageView& error, const Mask& mask, int median_size) {
  require_same_size(error, mask);
  if (median_size < 1) throw Error("A median filter needs a size of at least 1 pixel; got {}.", median_size);
  const std::vector<double> smoothed = medians(pixel_errors(error), mask, median_size);
  std::vector<double> masked;
  for (std::size_t pixel = 0; pixel < smoothed.size(); ++pixel)
    if (mask.pixels[pixel] != 0 && std::isfinite(smoothed[pixel])) masked.push_back(smoothed[pixel]);
  return keep_up_to(smoothed, mask, otsu_threshold(std::move(masked)));
}

}  // namespace mesograin::image
