// The mean of m samples is that of the first n and that of the others; what these two differ by tells the noise of all.
#include "image/noise_left.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "base/error.h"

namespace mesograin::image {
namespace {

/// Sum of |a - b| over that of |b|, of the colours of pixels that b covers, and where both are finite; 0 for black.
double off_by(std::span<const float> a, std::span<const float> b) {
  double differences = 0.0;
  double values = 0.0;
  for (std::size_t pixel = 0; pixel < b.size(); pixel += 4) {
    if (!(b[pixel + 3] > 0.0F)) continue;
    for (std::size_t channel = pixel; channel < pixel + 3; ++channel) {
      const double difference = std::abs(static_cast<double>(a[channel]) - static_cast<double>(b[channel]));
      if (!std::isfinite(difference)) continue;
      differences += difference;
      values += std::abs(static_cast<double>(b[channel]));
    }
  }
  return values > 0.0 ? differences / values : 0.0;
}

}  // namespace

void NoiseLeft::note(const ImageView& picture, int samples) {
  if (picture.channels != 4)
    throw Error("Noise is told of pictures with 4 channels, colour and coverage; got {}.", picture.channels);
  const bool first = samples_ == 0;
  if (!first && (picture.width != width_ || picture.height != height_))
    throw Error("Noise is told of pictures of one size; got {} x {} after {} x {}.", picture.width, picture.height,
                width_, height_);
  if (samples <= samples_) throw Error("Noise is told of more and more samples; got {} after {}.", samples, samples_);
  const std::span<const float> now(
      picture.pixels, static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) * 4);
  if (!first) {
    // With deviation s of one sample that of the first n's mean from the other m - n's is s sqrt(m / (n (m - n))), and
    // from all m's (m - n) / m times that; all m's own is s / sqrt(m).
    const double earlier = samples_;
    const double later = samples - samples_;
    relative_l1_ = off_by(before_, now) * std::sqrt(earlier / later);
  }
  before_.assign(now.begin(), now.end());
  width_ = picture.width;
  height_ = picture.height;
  samples_ = samples;
}

std::optional<double> NoiseLeft::samples_for(double error) const {
  if (!relative_l1_) return std::nullopt;
  const double ratio = *relative_l1_ / error;
  return std::max(1.0, samples_ * ratio * ratio);
}

}  // namespace mesograin::image
