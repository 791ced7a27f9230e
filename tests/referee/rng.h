// The referee's own random numbers: xoshiro256++, one independent stream for each pair of seed and batch.
#pragma once

#include <bit>
#include <cstdint>

namespace mesograin::referee {

/// Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2021; seeded by SplitMix64 as they advise.
class Rng {
 public:
  explicit Rng(std::uint64_t seed, std::uint64_t stream = 0) {
    std::uint64_t state = mix(seed) ^ mix(stream + 0x9e3779b97f4a7c15ULL);
    for (std::uint64_t& word : state_) {
      state += 0x9e3779b97f4a7c15ULL;
      word = mix(state);
    }
  }

  std::uint64_t bits() {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// In [0, 1), 53 bits.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

  /// In (0, 1]: safe under a logarithm.
  double uniform_positive() { return static_cast<double>((bits() >> 11) + 1) * 0x1p-53; }

 private:
  static std::uint64_t mix(std::uint64_t value) {
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
    return value ^ (value >> 31);
  }

  std::uint64_t state_[4];
};

}  // namespace mesograin::referee
