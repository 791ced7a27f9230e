// How many samples a picture is given next until it is good enough, or time is up.
#pragma once

#include <optional>

#include "image/image.h"
#include "image/noise_left.h"

namespace mesograin::image {

/// Until the noise of a pixel is no more than a share of its light. Noise is told on the way, in rounds that are short
/// at first.
class UntilError {
 public:
  /// error: that share. Throws Error unless it is above 0 and finite.
  explicit UntilError(double error);

  /// For a picture, (h, w, 4), that is the mean of so many samples: how many come next; 0 if that is all.
  int next(const ImageView& picture, int samples);

  /// Before there is a picture.
  static constexpr int first = 4;

  /// How many are needed, as far as is known.
  int target() const { return target_; }

  /// The relative L1 a pixel that the last picture is expected to have to that of endless samples, if it is known.
  std::optional<double> noise() const { return noise_.relative_l1(); }

 private:
  double error_;
  int target_;
  NoiseLeft noise_;
};

/// For so many seconds, and one sample at least. Times are in seconds from the start.
class UntilTime {
 public:
  /// Throws Error unless they are above 0 and finite.
  explicit UntilTime(double seconds);

  /// There are so many samples now: how many come next; 0 if that is all.
  int next(int samples, double now);

  /// Whether the first sample is still to wait for what light does in and between grains. A picture of what is known is
  /// better than one that comes late.
  bool waits_for_light(double now) const { return now < share_for_light * seconds_; }

  bool is_over(double now) const { return now >= seconds_; }

 private:
  static constexpr double share_for_light = 0.5;

  double seconds_;
  int first_samples_ = 0;
  double first_now_ = 0.0;  // when there were so many
};

}  // namespace mesograin::image
