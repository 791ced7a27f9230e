// A picture in memory: float samples, interleaved, row 0 at the top.
#pragma once

#include <cstddef>
#include <vector>

namespace mesograin::image {

/// Borrowed pixels of shape (height, width, channels), contiguous, row 0 at the top.
struct ImageView {
  const float* pixels = nullptr;
  int width = 0;
  int height = 0;
  int channels = 0;

  const float* at(int x, int y) const { return pixels + (static_cast<std::size_t>(y) * width + x) * channels; }
};

/// Owned pixels of shape (height, width, channels), contiguous, row 0 at the top.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> pixels;

  ImageView view() const { return {pixels.data(), width, height, channels}; }
};

}  // namespace mesograin::image
