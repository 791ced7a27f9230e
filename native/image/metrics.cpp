// All sums are in double: a million float terms would lose four digits.
#include "image/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/error.h"

namespace mesograin::image {
namespace {

constexpr double full_coverage = 1.0 - 1e-4;

double absolute_relative(double difference, double reference) {
  return std::abs(difference) / (reference + relative_epsilon);
}

double squared_relative(double difference, double reference) {
  return difference * difference / (reference * reference + relative_epsilon);
}

double sample_error(ErrorMetric metric, double difference, double reference) {
  switch (metric) {
    case ErrorMetric::e:
      return difference;
    case ErrorMetric::ae:
      return std::abs(difference);
    case ErrorMetric::se:
      return difference * difference;
    case ErrorMetric::rae:
      return absolute_relative(difference, reference);
    case ErrorMetric::rse:
      return squared_relative(difference, reference);
    case ErrorMetric::rse_root:
      return std::sqrt(squared_relative(difference, reference));
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Weighted sums over samples; the weight is 1 for a pixel and the number of its pixels for a block.
class Sums {
 public:
  void add(double difference, double reference, double weight) {
    const double squared = squared_relative(difference, reference);
    weight_ += weight;
    reference_ += weight * reference;
    ae_ += weight * std::abs(difference);
    se_ += weight * difference * difference;
    rae_ += weight * absolute_relative(difference, reference);
    rse_ += weight * squared;
    rse_root_ += weight * std::sqrt(squared);
  }

  double weight() const { return weight_; }
  double reference() const { return reference_; }
  Errors errors() const {
    const double mse = se_ / weight_;
    const double undefined = std::numeric_limits<double>::quiet_NaN();
    return {.ae_mean = ae_ / weight_,
            .se_mean = mse,
            .rae_mean = rae_ / weight_,
            .rse_mean = rse_ / weight_,
            .rse_root_mean = rse_root_ / weight_,
            .mse = mse,
            .rmse = std::sqrt(mse),
            .relative_l1 = reference_ == 0.0 ? undefined : ae_ / reference_};
  }

 private:
  double weight_ = 0.0;
  double reference_ = 0.0;
  double ae_ = 0.0;
  double se_ = 0.0;
  double rae_ = 0.0;
  double rse_ = 0.0;
  double rse_root_ = 0.0;
};

/// The image and its references, of one shape; a single reference stands for both, so that their difference is zero.
class Pair {
 public:
  Pair(const ImageView& image, const ImageView& reference_a, const std::optional<ImageView>& reference_b)
      : image_(image), a_(reference_a), b_(reference_b.value_or(reference_a)), two_(reference_b.has_value()) {
    for (const ImageView* reference : {&a_, &b_})
      if (reference->width != image.width || reference->height != image.height)
        throw Error("Image and reference must have one size; got {} x {} and {} x {} pixels.", image.width,
                    image.height, reference->width, reference->height);
    for (const ImageView* each : {&image_, &a_, &b_})
      if (each->channels != 1 && each->channels != 3 && each->channels != 4)
        throw Error("An image to compare needs 1, 3 or 4 channels; got {}.", each->channels);
    colours_ = std::min(image.channels, 3);
    for (const ImageView* reference : {&a_, &b_})
      if (std::min(reference->channels, 3) != colours_)
        throw Error("Image and reference must both be grey or both be RGB; got {} and {} channels.", image.channels,
                    reference->channels);
  }

  int width() const { return image_.width; }
  int height() const { return image_.height; }
  int colours() const { return colours_; }
  bool two_references() const { return two_; }
  bool covered_references() const { return a_.channels == 4 && b_.channels == 4; }

  double image(int x, int y, int channel) const { return image_.at(x, y)[channel]; }
  double a(int x, int y, int channel) const { return a_.at(x, y)[channel]; }
  double b(int x, int y, int channel) const { return b_.at(x, y)[channel]; }
  double reference(int x, int y, int channel) const { return 0.5 * (a(x, y, channel) + b(x, y, channel)); }
  double difference(int x, int y, int channel) const { return image(x, y, channel) - reference(x, y, channel); }

  Mask coverage_mask() const {
    Image coverage{.width = width(), .height = height(), .channels = 1, .pixels = {}};
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width(); ++x) coverage.pixels.push_back(std::min(a_.at(x, y)[3], b_.at(x, y)[3]));
    return default_mask(coverage.view());
  }

 private:
  ImageView image_;
  ImageView a_;
  ImageView b_;
  bool two_;
  int colours_ = 0;
};

enum class Finiteness { finite, nan, inf };

Finiteness finiteness(const Pair& pair, int x, int y) {
  Finiteness found = Finiteness::finite;
  for (int channel = 0; channel < pair.colours(); ++channel)
    for (const double value : {pair.image(x, y, channel), pair.a(x, y, channel), pair.b(x, y, channel)}) {
      if (std::isnan(value)) return Finiteness::nan;
      if (std::isinf(value)) found = Finiteness::inf;
    }
  return found;
}

bool image_is_finite(const Pair& pair, int x, int y) {
  for (int channel = 0; channel < pair.colours(); ++channel)
    if (!std::isfinite(pair.image(x, y, channel))) return false;
  return true;
}

/// Pixels of `mask` that are finite; the others are counted.
Mask usable_pixels(const Pair& pair, Mask mask, MaskCounts& counts) {
  for (int y = 0; y < pair.height(); ++y)
    for (int x = 0; x < pair.width(); ++x) {
      std::uint8_t& selected = mask.pixels[static_cast<std::size_t>(y) * pair.width() + x];
      if (!selected) continue;
      ++counts.pixels;
      const Finiteness found = finiteness(pair, x, y);
      if (found == Finiteness::finite) {
        ++counts.used;
        continue;
      }
      selected = 0;
      ++(found == Finiteness::nan ? counts.nan : counts.inf);
      if (!image_is_finite(pair, x, y)) ++counts.image_not_finite;
    }
  return mask;
}

/// The value below which the given part of the samples lies, linear between neighbours. Reorders `values`.
double percentile(std::vector<double>& values, double part) {
  const double rank = part * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), below, values.end());
  const double low = *below;
  if (below + 1 == values.end()) return low;
  const double high = *std::min_element(below + 1, values.end());
  return low + (high - low) * (rank - std::floor(rank));
}

Percentiles percentiles(std::vector<double> values) {
  return {percentile(values, 0.50), percentile(values, 0.95), percentile(values, 0.99)};
}

void compare_pixels(const Pair& pair, const Mask& usable, Comparison& result) {
  Sums errors, noise;
  std::vector<double> absolute, relative;
  absolute.reserve(static_cast<std::size_t>(result.mask.used) * static_cast<std::size_t>(pair.colours()));
  relative.reserve(absolute.capacity());
  double difference_sum = 0.0;
  double image_sum = 0.0;
  result.max_error = result.rse_max = -1.0;
  for (int y = 0; y < pair.height(); ++y)
    for (int x = 0; x < pair.width(); ++x) {
      if (!usable.pixels[static_cast<std::size_t>(y) * pair.width() + x]) continue;
      for (int channel = 0; channel < pair.colours(); ++channel) {
        const double reference = pair.reference(x, y, channel);
        const double difference = pair.difference(x, y, channel);
        errors.add(difference, reference, 1.0);
        noise.add(0.5 * (pair.a(x, y, channel) - pair.b(x, y, channel)), reference, 1.0);
        difference_sum += difference;
        image_sum += pair.image(x, y, channel);
        absolute.push_back(std::abs(difference));
        relative.push_back(squared_relative(difference, reference));
        if (absolute.back() > result.max_error) {
          result.max_error = absolute.back();
          result.max_error_at = {x, y, channel};
        }
        if (relative.back() > result.rse_max) {
          result.rse_max = relative.back();
          result.rse_max_at = {x, y, channel};
        }
      }
    }
  result.e_mean = difference_sum / errors.weight();
  result.bias = errors.reference() == 0.0 ? std::numeric_limits<double>::quiet_NaN() : image_sum / errors.reference();
  result.ae = percentiles(std::move(absolute));
  result.rse = percentiles(std::move(relative));
  result.pixels = errors.errors();
  if (pair.two_references()) result.noise_floor = noise.errors();
}

/// Averages over the usable pixels of each block, which weighs as many as it has.
void compare_blocks(const Pair& pair, const Mask& usable, Comparison& result) {
  Sums errors, noise;
  for (int top = 0; top < pair.height(); top += block_size)
    for (int left = 0; left < pair.width(); left += block_size)
      for (int channel = 0; channel < pair.colours(); ++channel) {
        double count = 0.0, difference = 0.0, reference = 0.0, half_spread = 0.0;
        for (int y = top; y < std::min(top + block_size, pair.height()); ++y)
          for (int x = left; x < std::min(left + block_size, pair.width()); ++x) {
            if (!usable.pixels[static_cast<std::size_t>(y) * pair.width() + x]) continue;
            count += 1.0;
            difference += pair.difference(x, y, channel);
            reference += pair.reference(x, y, channel);
            half_spread += 0.5 * (pair.a(x, y, channel) - pair.b(x, y, channel));
          }
        if (count == 0.0) continue;
        errors.add(difference / count, reference / count, count);
        noise.add(half_spread / count, reference / count, count);
      }
  result.blocks = errors.errors();
  if (pair.two_references()) result.noise_floor_blocks = noise.errors();
}

}  // namespace

Errors correct_for_noise(const Errors& value, const Errors& noise_floor) {
  Errors corrected;
  for (const ErrorsMember& member : errors_members) {
    const double raw = value.*member.value;
    const double floor = noise_floor.*member.value;
    const double excess = member.squared ? raw - floor : raw * raw - floor * floor;
    // Not std::max, which would turn an undefined value into 0.
    const double positive = excess < 0.0 ? 0.0 : excess;
    corrected.*member.value = member.squared ? positive : std::sqrt(positive);
  }
  return corrected;
}

Mask default_mask(const ImageView& coverage, int erode) {
  if (coverage.channels != 1) throw Error("Coverage must have one channel; got {}.", coverage.channels);
  if (erode < 0) throw Error("A mask is eroded by 0 or more pixels; got {}.", erode);
  const int width = coverage.width;
  const int height = coverage.height;
  const std::size_t row = static_cast<std::size_t>(width);
  const int reach = std::min(erode, width + height);  // farther than any two pixels are apart

  // Rows to the nearest uncovered pixel in the same column, at most reach + 1: upwards first, then downwards.
  std::vector<int> distance(row * static_cast<std::size_t>(height), reach + 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool covered = *coverage.at(x, y) >= full_coverage;  // false for NaN
      int& here = distance[y * row + x];
      if (!covered)
        here = 0;
      else if (y > 0)
        here = std::min(here, distance[(y - 1) * row + x] + 1);
    }
  for (int y = height - 1; y-- > 0;)
    for (int x = 0; x < width; ++x) {
      int& here = distance[y * row + x];
      here = std::min(here, distance[(y + 1) * row + x] + 1);
    }

  Mask mask{.width = width, .height = height, .pixels = std::vector<std::uint8_t>(distance.size(), 1)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int other = std::max(0, x - reach); other <= std::min(width - 1, x + reach); ++other) {
        const std::int64_t across = other - x;
        const std::int64_t along = distance[y * row + other];
        if (across * across + along * along <= static_cast<std::int64_t>(reach) * reach) {
          mask.pixels[y * row + x] = 0;
          break;
        }
      }
  return mask;
}

Comparison compare(const ImageView& image, const ImageView& reference_a, const std::optional<ImageView>& reference_b,
                   const std::optional<Mask>& mask) {
  const Pair pair(image, reference_a, reference_b);
  Comparison result;
  Mask selected;
  if (mask) {
    if (mask->width != image.width || mask->height != image.height)
      throw Error("The mask must have the image's size; got {} x {} for {} x {} pixels.", mask->width, mask->height,
                  image.width, image.height);
    selected = *mask;
    result.mask.source = "given";
  } else if (pair.covered_references()) {
    selected = pair.coverage_mask();
    result.mask.source = "reference coverage";
  } else {
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    selected = {.width = image.width, .height = image.height, .pixels = std::vector<std::uint8_t>(pixels, 1)};
    result.mask.source = "all pixels";
  }
  const Mask usable = usable_pixels(pair, std::move(selected), result.mask);
  if (result.mask.pixels == 0)
    throw Error("The mask ({}) selects no pixel; at least one is needed to compare.", result.mask.source);
  if (result.mask.used == 0)
    throw Error(
        "None of the {} masked pixels is finite in image and reference ({} hold NaN, {} Inf); nothing is left "
        "to compare.",
        result.mask.pixels, result.mask.nan, result.mask.inf);
  compare_pixels(pair, usable, result);
  compare_blocks(pair, usable, result);
  return result;
}

Image error_image(const ImageView& image, const ImageView& reference_a, const std::optional<ImageView>& reference_b,
                  ErrorMetric metric) {
  const Pair pair(image, reference_a, reference_b);
  Image errors{.width = pair.width(), .height = pair.height(), .channels = pair.colours(), .pixels = {}};
  errors.pixels.reserve(static_cast<std::size_t>(pair.width()) * static_cast<std::size_t>(pair.height()) *
                        static_cast<std::size_t>(pair.colours()));
  for (int y = 0; y < pair.height(); ++y)
    for (int x = 0; x < pair.width(); ++x)
      for (int channel = 0; channel < pair.colours(); ++channel)
        errors.pixels.push_back(
            static_cast<float>(sample_error(metric, pair.difference(x, y, channel), pair.reference(x, y, channel))));
  return errors;
}

ErrorMetric parse_error_metric(std::string_view name) {
  const auto found = std::find(error_metric_names.begin(), error_metric_names.end(), name);
  if (found == error_metric_names.end())
    throw Error("metric must be one of {}; got '{}'.", fmt::join(error_metric_names, ", "), name);
  return static_cast<ErrorMetric>(found - error_metric_names.begin());
}

}  // namespace mesograin::image
