// How far an image is from its reference, in numbers; docs/metrics.md defines every one of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace mesograin::image {

/// The epsilon in the denominators of RAE and RSE, as in the image viewer tev.
inline constexpr double relative_epsilon = 0.01;

/// Block values are taken after averaging over squares of this many pixels a side.
inline constexpr int block_size = 8;

/// Which pixels count: 1 byte each, 0 or 1, row 0 at the top.
struct Mask {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

/// What a metric says of one sample, before any sum.
enum class ErrorMetric { e, ae, se, rae, rse, rse_root };
inline constexpr std::array<std::string_view, 6> error_metric_names{"e", "ae", "se", "rae", "rse", "rse_root"};

/// The metrics that the reference's noise raises. NaN where a metric is not defined (a black reference).
struct Errors {
  double ae_mean = 0.0;
  double se_mean = 0.0;
  double rae_mean = 0.0;
  double rse_mean = 0.0;
  double rse_root_mean = 0.0;
  double mse = 0.0;
  double rmse = 0.0;
  double relative_l1 = 0.0;
};

/// The name of each member of Errors, and whether it grows with the square of the difference.
struct ErrorsMember {
  std::string_view name;
  double Errors::*value;
  bool squared;
};
inline constexpr std::array<ErrorsMember, 8> errors_members{{
    {"ae_mean", &Errors::ae_mean, false},
    {"se_mean", &Errors::se_mean, true},
    {"rae_mean", &Errors::rae_mean, false},
    {"rse_mean", &Errors::rse_mean, true},
    {"rse_root_mean", &Errors::rse_root_mean, false},
    {"mse", &Errors::mse, true},
    {"rmse", &Errors::rmse, false},
    {"relative_l1", &Errors::relative_l1, false},
}};

/// A sample's position: column, row (0 at the top), channel.
struct Place {
  int x = 0;
  int y = 0;
  int channel = 0;
};

struct Percentiles {
  double p50 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
};

/// Pixel counts. A pixel with a NaN in any image counts as nan, one with an Inf and no NaN as inf; neither enters a
/// sum.
struct MaskCounts {
  std::string source;  ///< "given", "reference coverage" or "all pixels"
  std::int64_t pixels = 0;
  std::int64_t nan = 0;
  std::int64_t inf = 0;
  std::int64_t used = 0;              ///< pixels - nan - inf
  std::int64_t image_not_finite = 0;  ///< of nan + inf, those where the image itself is to blame
};

struct Comparison {
  double e_mean = 0.0;
  double bias = 0.0;  ///< NaN for a black reference
  double max_error = 0.0;
  Place max_error_at;
  double rse_max = 0.0;
  Place rse_max_at;
  Percentiles ae;
  Percentiles rse;
  Errors pixels;
  Errors blocks;
  std::optional<Errors> noise_floor;         ///< known with two or more references
  std::optional<Errors> noise_floor_blocks;  ///< known with two or more references
  MaskCounts mask;
};

/// What remains of `value` when the reference's noise is taken off in quadrature.
Errors correct_for_noise(const Errors& value, const Errors& noise_floor);

/// Pixels whose coverage is 1 (within 1e-4), less those nearer than or at `erode` pixels to one whose coverage is not.
/// `coverage` has one channel. Throws Error if it has not, or `erode` is negative.
Mask default_mask(const ImageView& coverage, int erode = 2);

/// Compares the colour of `image` (1, 3 or 4 channels; a fourth is coverage and not compared) with a reference, or with
/// the mean of several references of independent noise. Without a mask: the default mask of the references' coverage if
/// they have 4 channels, else all pixels.
/// Throws Error if there is no reference, shapes differ, the mask is empty or no masked pixel is finite.
Comparison compare(const ImageView& image, const std::vector<ImageView>& references,
                   const std::optional<Mask>& mask = std::nullopt);

/// The metric of each sample, with 1 or 3 channels. NaN and Inf pass through. Throws Error if shapes differ.
Image error_image(const ImageView& image, const std::vector<ImageView>& references, ErrorMetric metric);

/// Throws Error listing the names allowed.
ErrorMetric parse_error_metric(std::string_view name);

}  // namespace mesograin::image
