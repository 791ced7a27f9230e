// Coefficients to order 2 in 54 bytes, of which many grains have several.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "heap/coefficients.h"

namespace mesograin::heap {

/// Each number to four thousandths of itself (the upper half of an IEEE 754 single, rounded to the nearest).
class PackedCoefficients {
 public:
  PackedCoefficients() = default;

  explicit PackedCoefficients(const Coefficients& of) {
    const SecondOrders::Numbers* second = of.second.get();
    for (std::size_t channel = 0; channel < 3; ++channel) {
      for (int i = 0; i < 4; ++i) numbers_[channel][static_cast<std::size_t>(i)] = packed(of.channels[channel][i]);
      for (std::size_t i = 0; i < of_second && second != nullptr; ++i)
        numbers_[channel][4 + i] = packed((*second)[channel][i]);
    }
  }

  Coefficients whole() const {
    Coefficients result;
    SecondOrders::Numbers& second = result.second.made();
    for (std::size_t channel = 0; channel < 3; ++channel) {
      for (int i = 0; i < 4; ++i) result.channels[channel][i] = whole(numbers_[channel][static_cast<std::size_t>(i)]);
      for (std::size_t i = 0; i < of_second; ++i) second[channel][i] = whole(numbers_[channel][4 + i]);
    }
    return result;
  }

 private:
  static constexpr std::size_t of_second = std::tuple_size_v<SecondOrder>;

  static std::uint16_t packed(float number) {
    const auto bits = std::bit_cast<std::uint32_t>(number);
    return static_cast<std::uint16_t>((bits + 0x7FFFU + ((bits >> 16U) & 1U)) >> 16U);
  }

  static float whole(std::uint16_t number) { return std::bit_cast<float>(std::uint32_t{number} << 16U); }

  std::array<std::array<std::uint16_t, 4 + of_second>, 3> numbers_{};
};

using PackedField = std::vector<PackedCoefficients>;

inline void scale(PackedCoefficients& one, const glm::vec3& by) { one = PackedCoefficients(one.whole() * by); }

}  // namespace mesograin::heap
