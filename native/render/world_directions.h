// Directions of the world's light for the samples of a picture.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "lights/world_light.h"
#include "render/spread_directions.h"

namespace mesograin::render {

/// An endless row for each seed, of the same luminance all. Without an image they are SpreadDirections; of an image
/// scrambled points (scrambled_point) choose them, and of some scramblings it is the one whose first few light planes
/// of any normal, and level ground, of which pictures show most, as nearly as the world does.
class WorldDirections {
 public:
  explicit WorldDirections(const lights::WorldLight& world);

  /// One of them, as WorldLight::draw has it, of the world that it was made for.
  lights::LightDraw at(const lights::WorldLight& world, std::uint32_t index, std::uint32_t seed);

 private:
  /// How far the first few of a scrambling are from lighting planes as the world does.
  double off(const lights::WorldLight& world, std::uint32_t scramble) const;

  std::uint32_t best_scramble(const lights::WorldLight& world, std::uint32_t seed) const;

  SpreadDirections spread_;
  std::vector<double> irradiances_;  // of planes, by an image of that luminance
  std::optional<std::uint32_t> seed_;
  std::uint32_t scramble_ = 0;  // for that seed
};

}  // namespace mesograin::render
