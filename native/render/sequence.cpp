// The additive recurrence with the plastic number, and Sobol's first two dimensions, scrambled as Owen does.
#include "render/sequence.h"

#include <glm/common.hpp>

namespace mesograin::render {
namespace {

// The real root above 1 of x^3 = x + 1.
constexpr double plastic_number = 1.32471795724474602596;

// splitmix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
std::uint64_t mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31U);
}

std::uint32_t reversed(std::uint32_t bits) {
  bits = ((bits & 0x55555555U) << 1U) | ((bits >> 1U) & 0x55555555U);
  bits = ((bits & 0x33333333U) << 2U) | ((bits >> 2U) & 0x33333333U);
  bits = ((bits & 0x0f0f0f0fU) << 4U) | ((bits >> 4U) & 0x0f0f0f0fU);
  bits = ((bits & 0x00ff00ffU) << 8U) | ((bits >> 8U) & 0x00ff00ffU);
  return (bits << 16U) | (bits >> 16U);
}

// Flips each bit or not by a hash of all that are more significant (Owen 1995, by Burley, "Practical Hash-based Owen
// Scrambling", 2020, section 2; the hash is N. Vegdahl's, "Building a Better LK Hash", 2021).
std::uint32_t scrambled(std::uint32_t bits, std::uint32_t seed) {
  bits = reversed(bits);
  bits ^= bits * 0x3d20adeaU;
  bits += seed;
  bits *= (seed >> 16U) | 1U;
  bits ^= bits * 0x05526c56U;
  bits ^= bits * 0x53a22864U;
  return reversed(bits);
}

}  // namespace

glm::dvec2 r2_point(std::uint32_t index, glm::dvec2 offset) {
  const glm::dvec2 step(1.0 / plastic_number, 1.0 / (plastic_number * plastic_number));
  return glm::fract(offset + static_cast<double>(index) * step);
}

glm::dvec2 scrambled_point(std::uint32_t index, std::uint32_t seed) {
  const std::uint64_t scramble = mix(seed);
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  std::uint32_t of_first = 1U << 31U;
  std::uint32_t of_second = 1U << 31U;
  for (; index != 0; index >>= 1U) {
    if ((index & 1U) != 0) {
      first ^= of_first;
      second ^= of_second;
    }
    of_first >>= 1U;
    of_second ^= of_second >> 1U;
  }
  return {0x1.0p-32 * scrambled(first, static_cast<std::uint32_t>(scramble)),
          0x1.0p-32 * scrambled(second, static_cast<std::uint32_t>(scramble >> 32U))};
}

glm::dvec2 seeded_offset(std::uint32_t seed) {
  constexpr double unit = 0x1.0p-53;
  const std::uint64_t first = mix(seed);
  return {static_cast<double>(first >> 11U) * unit, static_cast<double>(mix(first) >> 11U) * unit};
}

}  // namespace mesograin::render
