// Random numbers that depend on a seed and a place in the work alone, so that threads change nothing.
#pragma once

#include <cstdint>

namespace mesograin::transport {

/// PCG32 (O'Neill, "PCG: a family of simple fast space-efficient statistically good algorithms", 2014), one stream for
/// each piece of work.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t piece) : increment_(2U * mixed(piece + 1U) + 1U) {
    bits();
    state_ += mixed(seed);
    bits();
  }

  /// In [0, 1), a multiple of 2^-24.
  float uniform() { return static_cast<float>(bits() >> 8U) * 0x1p-24F; }

  std::uint32_t bits() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<std::uint32_t>(old >> 59U);
    return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
  }

 private:
  // The finaliser of SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
  static std::uint64_t mixed(std::uint64_t bits) {
    bits += 0x9E3779B97F4A7C15ULL;
    bits = (bits ^ (bits >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    bits = (bits ^ (bits >> 27U)) * 0x94D049BB133111EBULL;
    return bits ^ (bits >> 31U);
  }

  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace mesograin::transport
