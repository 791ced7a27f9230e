// Which pixels differ from a sampled reference by more than its noise: a per-pixel test, corrected for their number.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"
#include "image/metrics.h"

namespace mesograin::image {

struct SignificanceOptions {
  /// Probability that an image without any error is called different.
  double false_alarm_rate = 0.01;

  /// A difference up to this part of the reference, or of its mean over the mask if that is more, is not looked for:
  /// two right renderers still sample edges and tessellate differently.
  double relative_tolerance = 0.002;
};

struct Significance {
  Image p_value;  ///< one channel: the smallest over the pixel's channels; 1 outside the mask
  Image score;    ///< as many channels as compared: signed, in standard deviations of the difference of the means
  std::int64_t pixels = 0;  ///< tested
  std::int64_t tests = 0;   ///< pixels times channels
  std::int64_t significant_pixels = 0;
  double threshold = 0.0;        ///< p-value below which one test is significant (Sidak)
  double score_threshold = 0.0;  ///< |score| above which it is
  bool differs = false;          ///< some pixel is significant
};

/// Tests the mean of one or more images against K >= 2 references of independent noise, by colour: in every masked
/// pixel and channel a t-test of the difference of the means, with the variances pooled over the masked pixels of a
/// square of `variance_window` pixels (so two of either serve), the tails of the noise taken from its kurtosis over the
/// whole mask, the score turned into a normal one after Wallace,
/// "Bounds on normal approximations to Student's and the chi-square distributions" (1959), and the threshold corrected
/// after Sidak, "Rectangular confidence regions for the means of multivariate normal distributions" (1967). A single
/// image counts as exact; of several the noise counts too, with the degrees of freedom of Welch, "The generalization of
/// 'Student's' problem when several different population variances are involved" (1947). Pixels with NaN or Inf in any
/// image are not tested. Throws Error if shapes differ, there is no image, fewer than two references came or no pixel
/// remains.
Significance test_significance(const std::vector<ImageView>& images, const std::vector<ImageView>& references,
                               const Mask& mask, const SignificanceOptions& options = {});

inline constexpr int variance_window = 9;

}  // namespace mesograin::image
