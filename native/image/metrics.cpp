// All sums are in double: a million float terms would lose four digits.
#include "image/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"

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

/// The image and its references, of one shape.
class Compared {
 public:
  Compared(const ImageView& image, const std::vector<ImageView>& references) : image_(image), references_(references) {
    if (references.empty()) throw Error("A comparison needs at least one reference; got none.");
    for (const ImageView& reference : references_)
      if (reference.width != image.width || reference.height != image.height)
        throw Error("Image and reference must have one size; got {} x {} and {} x {} pixels.", image.width,
                    image.height, reference.width, reference.height);
    const auto check_channels = [](const ImageView& each) {
      if (each.channels != 1 && each.channels != 3 && each.channels != 4)
        throw Error("An image to compare needs 1, 3 or 4 channels; got {}.", each.channels);
    };
    check_channels(image_);
    std::for_each(references_.begin(), references_.end(), check_channels);
    colours_ = std::min(image.channels, 3);
    for (const ImageView& reference : references_)
      if (std::min(reference.channels, 3) != colours_)
        throw Error("Image and reference must both be grey or both be RGB; got {} and {} channels.", image.channels,
                    reference.channels);
  }

  int width() const { return image_.width; }
  int height() const { return image_.height; }
  int colours() const { return colours_; }
  std::size_t seeds() const { return references_.size(); }
  bool noise_is_known() const { return seeds() > 1; }
  bool covered_references() const {
    return std::all_of(references_.begin(), references_.end(),
                       [](const ImageView& each) { return each.channels == 4; });
  }

  double image(int x, int y, int channel) const { return image_.at(x, y)[channel]; }
  double seed(std::size_t index, int x, int y, int channel) const { return references_[index].at(x, y)[channel]; }
  double reference(int x, int y, int channel) const {
    double sum = 0.0;
    for (const ImageView& reference : references_) sum += reference.at(x, y)[channel];
    return sum / static_cast<double>(seeds());
  }

  /// What a seed's distance from the mean of K is divided by, to be distributed as the error of that mean: the variance
  /// of the distance is (K - 1) / K, that of the mean 1 / K of one seed's.
  double noise_divisor() const { return std::sqrt(static_cast<double>(seeds()) - 1.0); }

  Mask coverage_mask() const {
    Image coverage{.width = width(), .height = height(), .channels = 1, .pixels = {}};
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width(); ++x) {
        float least = references_.front().at(x, y)[3];
        for (const ImageView& reference : references_) least = std::min(least, reference.at(x, y)[3]);
        coverage.pixels.push_back(least);
      }
    return default_mask(coverage.view());
  }

  bool image_is_finite(int x, int y) const {
    return all_of_pixel(image_, x, y, [](float v) { return std::isfinite(v); });
  }
  bool has_nan(int x, int y) const {
    return any_of_pixel(x, y, [](float value) { return std::isnan(value); });
  }
  bool has_inf(int x, int y) const {
    return any_of_pixel(x, y, [](float value) { return std::isinf(value); });
  }

 private:
  template <typename Test>
  bool all_of_pixel(const ImageView& view, int x, int y, Test test) const {
    return std::all_of(view.at(x, y), view.at(x, y) + colours_, test);
  }
  template <typename Test>
  bool any_of_pixel(int x, int y, Test test) const {
    const auto any = [&](const ImageView& view) { return std::any_of(view.at(x, y), view.at(x, y) + colours_, test); };
    return any(image_) || std::any_of(references_.begin(), references_.end(), any);
  }

  ImageView image_;
  std::vector<ImageView> references_;
  int colours_ = 0;
};

/// Pixels of `mask` that are finite; the others are counted.
Mask usable_pixels(const Compared& compared, Mask mask, MaskCounts& counts) {
  for (int y = 0; y < compared.height(); ++y)
    for (int x = 0; x < compared.width(); ++x) {
      std::uint8_t& selected = mask.pixels[static_cast<std::size_t>(y) * compared.width() + x];
      if (!selected) continue;
      ++counts.pixels;
      const bool nan = compared.has_nan(x, y);
      if (!nan && !compared.has_inf(x, y)) {
        ++counts.used;
        continue;
      }
      selected = 0;
      ++(nan ? counts.nan : counts.inf);
      if (!compared.image_is_finite(x, y)) ++counts.image_not_finite;
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

void compare_pixels(const Compared& compared, const Mask& usable, Comparison& result) {
  Sums errors, noise;
  std::vector<double> absolute, relative;
  absolute.reserve(static_cast<std::size_t>(result.mask.used) * static_cast<std::size_t>(compared.colours()));
  relative.reserve(absolute.capacity());
  double difference_sum = 0.0;
  double image_sum = 0.0;
  result.max_error = result.rse_max = -1.0;
  for (int y = 0; y < compared.height(); ++y)
    for (int x = 0; x < compared.width(); ++x) {
      if (!usable.pixels[static_cast<std::size_t>(y) * compared.width() + x]) continue;
      for (int channel = 0; channel < compared.colours(); ++channel) {
        const double image = compared.image(x, y, channel);
        const double reference = compared.reference(x, y, channel);
        const double difference = image - reference;
        errors.add(difference, reference, 1.0);
        for (std::size_t seed = 0; compared.noise_is_known() && seed < compared.seeds(); ++seed)
          noise.add((compared.seed(seed, x, y, channel) - reference) / compared.noise_divisor(), reference, 1.0);
        difference_sum += difference;
        image_sum += image;
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
  if (compared.noise_is_known()) result.noise_floor = noise.errors();
}

/// Averages over the usable pixels of each block, which weighs as many as it has.
void compare_blocks(const Compared& compared, const Mask& usable, Comparison& result) {
  Sums errors, noise;
  std::vector<double> seeds(compared.seeds());
  for (int top = 0; top < compared.height(); top += block_size)
    for (int left = 0; left < compared.width(); left += block_size)
      for (int channel = 0; channel < compared.colours(); ++channel) {
        double count = 0.0, image = 0.0, reference = 0.0;
        std::fill(seeds.begin(), seeds.end(), 0.0);
        for (int y = top; y < std::min(top + block_size, compared.height()); ++y)
          for (int x = left; x < std::min(left + block_size, compared.width()); ++x) {
            if (!usable.pixels[static_cast<std::size_t>(y) * compared.width() + x]) continue;
            count += 1.0;
            image += compared.image(x, y, channel);
            reference += compared.reference(x, y, channel);
            for (std::size_t seed = 0; seed < seeds.size(); ++seed) seeds[seed] += compared.seed(seed, x, y, channel);
          }
        if (count == 0.0) continue;
        errors.add((image - reference) / count, reference / count, count);
        for (std::size_t seed = 0; compared.noise_is_known() && seed < seeds.size(); ++seed)
          noise.add((seeds[seed] - reference) / count / compared.noise_divisor(), reference / count, count);
      }
  result.blocks = errors.errors();
  if (compared.noise_is_known()) result.noise_floor_blocks = noise.errors();
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

Comparison compare(const ImageView& image, const std::vector<ImageView>& references, const std::optional<Mask>& mask) {
  const Compared compared(image, references);
  Comparison result;
  Mask selected;
  if (mask) {
    if (mask->width != image.width || mask->height != image.height)
      throw Error("The mask must have the image's size; got {} x {} for {} x {} pixels.", mask->width, mask->height,
                  image.width, image.height);
    selected = *mask;
    result.mask.source = "given";
  } else if (compared.covered_references()) {
    selected = compared.coverage_mask();
    result.mask.source = "reference coverage";
  } else {
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    selected = {.width = image.width, .height = image.height, .pixels = std::vector<std::uint8_t>(pixels, 1)};
    result.mask.source = "all pixels";
  }
  const Mask usable = usable_pixels(compared, std::move(selected), result.mask);
  if (result.mask.pixels == 0)
    throw Error("The mask ({}) selects no pixel; at least one is needed to compare.", result.mask.source);
  if (result.mask.used == 0)
    throw Error(
        "None of the {} masked pixels is finite in image and reference ({} hold NaN, {} Inf); nothing is left "
        "to compare.",
        result.mask.pixels, result.mask.nan, result.mask.inf);
  compare_pixels(compared, usable, result);
  compare_blocks(compared, usable, result);
  return result;
}

Image error_image(const ImageView& image, const std::vector<ImageView>& references, ErrorMetric metric) {
  const Compared compared(image, references);
  Image errors{.width = image.width, .height = image.height, .channels = compared.colours(), .pixels = {}};
  errors.pixels.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                        static_cast<std::size_t>(compared.colours()));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int channel = 0; channel < compared.colours(); ++channel) {
        const double reference = compared.reference(x, y, channel);
        errors.pixels.push_back(
            static_cast<float>(sample_error(metric, compared.image(x, y, channel) - reference, reference)));
      }
  return errors;
}

ErrorMetric parse_error_metric(std::string_view name) {
  const auto found = std::find(error_metric_names.begin(), error_metric_names.end(), name);
  if (found == error_metric_names.end())
    throw Error("metric must be one of {}; got '{}'.", fmt::join(error_metric_names, ", "), name);
  return static_cast<ErrorMetric>(found - error_metric_names.begin());
}

}  // namespace mesograin::image
