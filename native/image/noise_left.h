// How noisy a picture still is that gets better with every sample: by what its later samples differ from the earlier.
#pragma once

#include <optional>
#include <vector>

#include "image/image.h"

namespace mesograin::image {

/// Of the mean of more and more samples, which are independent of each other. Where they are spread more evenly than
/// that it tells more noise than there is, and so it does of what a picture's first samples are off.
class NoiseLeft {
 public:
  /// A picture of shape (h, w, 4), premultiplied by coverage, that is the mean of so many samples, among which are all
  /// of those of the picture before. Throws Error for another shape, or no more samples than before.
  void note(const ImageView& picture, int samples);

  /// The relative L1 a pixel that the last picture is expected to have to that of endless samples, over pixels that
  /// anything covers; nothing before the second picture.
  std::optional<double> relative_l1() const { return relative_l1_; }

  /// After how many samples it is expected to be `error`; nothing before the second picture. It falls as their root.
  std::optional<double> samples_for(double error) const;

 private:
  std::vector<float> before_;
  int width_ = 0;
  int height_ = 0;
  int samples_ = 0;
  std::optional<double> relative_l1_;
};

}  // namespace mesograin::image
