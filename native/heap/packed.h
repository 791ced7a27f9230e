// Places on a ball and weights in few bytes: a heap has millions of ways that light goes.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

namespace mesograin::heap {

/// A normal, a place that may be half again as long, or 0, to a thousandth and a half.
class PackedPlace {
 public:
  explicit PackedPlace(const glm::vec3& place) {
    for (int axis = 0; axis < 3; ++axis) {
      const float scaled = std::clamp(std::round(scale * place[axis]), -largest, largest);
      bits_ |= static_cast<std::uint32_t>(static_cast<int>(scaled + largest)) << (10 * axis);
    }
  }

  glm::vec3 whole() const { return {along(0), along(1), along(2)}; }

  std::uint32_t bits() const { return bits_; }

 private:
  static constexpr float largest = 511.0F;
  static constexpr float scale = largest / 1.6F;

  float along(int axis) const {
    return (static_cast<float>((bits_ >> (10 * axis)) & 1023U) - largest) * (1.0F / scale);
  }

  std::uint32_t bits_ = 0;
};

/// Three channels, none below 0, with one exponent (Ward 1991, "Real pixels"): each to eight thousandths of the
/// largest, rounded up as often as it is nearer to that, so that many weights that are all alike are right together.
class PackedWeight {
 public:
  /// `chance`: bits that say which way.
  PackedWeight(const glm::vec3& weight, std::uint32_t chance) {
    const float most = std::max({weight.r, weight.g, weight.b});
    if (!(most > 1e-30F)) return;
    int exponent = 0;
    std::frexp(most, &exponent);
    // What might be rounded up to the next power of two.
    if (std::ldexp(most, steps - exponent) > largest) ++exponent;
    bits_ = static_cast<std::uint32_t>(exponent + bias) << 24U;
    for (int channel = 0; channel < 3; ++channel) {
      const auto up = static_cast<float>((chance >> (8 * channel)) & 255U) * (1.0F / 256.0F);
      bits_ |= static_cast<std::uint32_t>(std::ldexp(weight[channel], steps - exponent) + up) << (8 * channel);
    }
  }

  glm::vec3 whole() const {
    if (bits_ == 0) return glm::vec3(0.0F);
    // Two to the power of the exponent less the steps, as IEEE 754 has it.
    constexpr std::uint32_t of_one = 127;
    const auto step = std::bit_cast<float>(((bits_ >> 24U) + of_one - bias - steps) << 23U);
    return step * glm::vec3(bits_ & 255U, (bits_ >> 8U) & 255U, (bits_ >> 16U) & 255U);
  }

 private:
  static constexpr int steps = 8;
  static constexpr float largest = 255.0F;
  static constexpr int bias = 128;

  std::uint32_t bits_ = 0;
};

}  // namespace mesograin::heap
