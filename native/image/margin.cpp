// Grows the covered texels outwards, one ring at a time; each ring looks only at the texels next to the last.
#include "image/margin.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "base/error.h"

namespace mesograin::image {
namespace {

struct Texel {
  int x;
  int y;
};

class Growth {
 public:
  explicit Growth(Image& texture) : texture_(texture) {
    for (int y = 0; y < texture.height; ++y)
      for (int x = 0; x < texture.width; ++x)
        if (covered(x, y)) last_.push_back({x, y});
  }

  bool done() const { return last_.empty(); }

  void grow() {
    std::vector<Texel> ring;
    for (const Texel& texel : last_)
      for_neighbours(texel, [&](int x, int y) {
        // Marked until the ring is filled, so that it is listed once and does not count as covered.
        if (at(x, y)[3] != 0.0F) return;
        at(x, y)[3] = listed;
        ring.push_back({x, y});
      });
    std::vector<std::array<float, 3>> means(ring.size());
    for (std::size_t i = 0; i < ring.size(); ++i) means[i] = mean(ring[i]);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      float* pixel = at(ring[i].x, ring[i].y);
      std::copy(means[i].begin(), means[i].end(), pixel);
      pixel[3] = 1.0F;
    }
    last_ = std::move(ring);
  }

 private:
  static constexpr float listed = -1.0F;

  float* at(int x, int y) {
    return texture_.pixels.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(texture_.width) + static_cast<std::size_t>(x)) * 4;
  }
  bool covered(int x, int y) { return at(x, y)[3] > 0.0F; }

  template <typename Visit>
  void for_neighbours(const Texel& texel, const Visit& visit) {
    for (int y = std::max(texel.y - 1, 0); y <= std::min(texel.y + 1, texture_.height - 1); ++y)
      for (int x = std::max(texel.x - 1, 0); x <= std::min(texel.x + 1, texture_.width - 1); ++x) visit(x, y);
  }

  std::array<float, 3> mean(const Texel& texel) {
    std::array<double, 3> sum{};
    int count = 0;
    for_neighbours(texel, [&](int x, int y) {
      if (!covered(x, y)) return;
      for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += static_cast<double>(at(x, y)[channel]);
      ++count;
    });
    std::array<float, 3> result{};
    for (std::size_t channel = 0; channel < 3; ++channel) result[channel] = static_cast<float>(sum[channel] / count);
    return result;
  }

  Image& texture_;
  std::vector<Texel> last_;
};

}  // namespace

Image extend_margin(const ImageView& texture, int margin) {
  constexpr int largest = 32767;
  if (texture.channels != 4)
    throw Error("A margin needs a texture with 4 channels, the last its coverage; got {}.", texture.channels);
  if (margin < 0 || margin > largest) throw Error("margin must lie between 0 and {}; got {}.", largest, margin);
  const std::size_t size = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height) * 4;
  Image result{texture.width, texture.height, 4, {texture.pixels, texture.pixels + size}};
  if (margin == 0) return result;
  for (std::size_t i = 0; i < size; i += 4) {
    const float coverage = result.pixels[i + 3];
    if (coverage <= 0.0F) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) result.pixels[i + channel] /= coverage;
    result.pixels[i + 3] = 1.0F;
  }
  Growth growth(result);
  for (int ring = 0; ring < margin && !growth.done(); ++ring) growth.grow();
  return result;
}

}  // namespace mesograin::image
