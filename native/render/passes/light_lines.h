// Straight lines from a sample's suns through a grain that does not refract, cut at its surface once for all pixels.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <optional>
#include <vector>

#include "gl/program.h"
#include "gl/volume.h"
#include "render/device_cache.h"
#include "render/lighting.h"

namespace mesograin::render {

class LightLines {
 public:
  /// How many stand side by side in a grain that so many pixels show: 0 where light does not go straight in it, or
  /// where they cost more than that each pixel follows it.
  static int across(const DeviceMaterial& material, const std::vector<LightDirection>& lights, double pixels);

  /// So many squared for each of the lights that are bound as storage.
  void cut(DeviceCache& cache, const DeviceMaterial& material, const glm::mat3& grain_to_prototype, std::size_t lights,
           int across);

  /// To a program that is compiled for them.
  void bind(const gl::Program& program) const { program.set("light_lines", *lines_); }

 private:
  std::optional<gl::Volume> lines_;
};

}  // namespace mesograin::render
