// Whichever scrambling is chosen is a (0,2)-sequence: many of its directions do as well as any other's.
#include "render/world_directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "render/sequence.h"

namespace mesograin::render {
namespace {

constexpr std::uint32_t scramblings = 64;

// Those that the world's own irradiance is found by.
constexpr std::uint32_t many = 4096;

// Samples of four directions whose pictures are to be right.
constexpr std::array<std::uint32_t, 4> few = {4, 8, 12, 16};

constexpr std::size_t tilted = 16;

// Of level ground, against the others together.
constexpr double worth_of_level = 4.0;

/// Normals all round, on a spiral of equal areas, and straight up.
std::array<glm::dvec3, tilted + 1> make_normals() {
  std::array<glm::dvec3, tilted + 1> normals;
  for (std::size_t i = 0; i < tilted; ++i) {
    const double up = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / tilted;
    const double across = std::sqrt(1.0 - up * up);
    const double azimuth = glm::two_pi<double>() * static_cast<double>(i) / glm::golden_ratio<double>();
    normals[i] = {across * std::cos(azimuth), across * std::sin(azimuth), up};
  }
  normals[tilted] = {0.0, 0.0, 1.0};
  return normals;
}

const std::array<glm::dvec3, tilted + 1> normals = make_normals();

}  // namespace

WorldDirections::WorldDirections(const lights::WorldLight& world) {
  if (world.even()) return;
  irradiances_.resize(normals.size());
  for (std::uint32_t i = 0; i < many; ++i) {
    const glm::dvec3 to_light = world.draw(scrambled_point(i, 0)).to_light;
    for (std::size_t k = 0; k < normals.size(); ++k)
      irradiances_[k] += std::max(glm::dot(to_light, normals[k]), 0.0) / many;
  }
}

lights::LightDraw WorldDirections::at(const lights::WorldLight& world, std::uint32_t index, std::uint32_t seed) {
  if (world.even()) return world.from(spread_.at(index, seed));
  if (seed_ != seed) {
    scramble_ = best_scramble(world, seed);
    seed_ = seed;
  }
  return world.draw(scrambled_point(index, scramble_));
}

std::uint32_t WorldDirections::best_scramble(const lights::WorldLight& world, std::uint32_t seed) const {
  std::uint32_t best = seed;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < scramblings; ++i) {
    const std::uint32_t tried = scramblings * seed + i;
    const double tried_off = off(world, tried);
    if (tried_off >= least) continue;
    least = tried_off;
    best = tried;
  }
  return best;
}

double WorldDirections::off(const lights::WorldLight& world, std::uint32_t scramble) const {
  std::array<double, tilted + 1> sums{};
  double all = 0.0;
  std::uint32_t drawn = 0;
  for (const std::uint32_t count : few) {
    for (; drawn < count; ++drawn) {
      const glm::dvec3 to_light = world.draw(scrambled_point(drawn, scramble)).to_light;
      for (std::size_t k = 0; k < normals.size(); ++k) sums[k] += std::max(glm::dot(to_light, normals[k]), 0.0);
    }
    for (std::size_t k = 0; k < normals.size(); ++k) {
      const double error = sums[k] / count - irradiances_[k];
      all += count * error * error * (k < tilted ? 1.0 / tilted : worth_of_level);
    }
  }
  return all;
}

}  // namespace mesograin::render
