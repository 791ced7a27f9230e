// Straight lines from a sample's suns through a grain that does not refract, cut at its surface once for all pixels.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <optional>

#include "gl/program.h"
#include "gl/volume.h"
#include "render/device_cache.h"

namespace mesograin::render {

class LightLines {
 public:
  /// For lights that are bound as storage, and a grain that so many pixels show.
  void cut(DeviceCache& cache, const DeviceMaterial& material, const glm::mat3& grain_to_prototype, std::size_t lights,
           double pixels);

  /// To a program that is compiled for them.
  void bind(const gl::Program& program) const { program.set("light_lines", *lines_); }

 private:
  std::optional<gl::Volume> lines_;
};

}  // namespace mesograin::render
