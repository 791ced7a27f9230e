// Stored transport under the very lights of a sample: what pixels would each sum anew is summed once at its nodes.
#pragma once

#include <glm/mat3x3.hpp>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/volume.h"
#include "render/device_cache.h"
#include "render/lighting.h"

namespace mesograin::render {

class ProductSums {
 public:
  /// Whether it costs less than what it spares a thing that so many pixels show.
  static bool pay(const DeviceMaterial& material, const std::vector<LightDirection>& lights, double pixels);

  /// For a material that they pay for; `grain_to_prototype` is a turn. Binds textures of its own: a program's come
  /// after.
  void sum(DeviceCache& cache, const DeviceMaterial& material, const std::vector<LightDirection>& lights,
           const glm::mat3& grain_to_prototype);

  /// To a program that is compiled for them.
  void bind(const gl::Program& program) const { program.set("summed", *sums_); }

 private:
  std::optional<gl::Buffer> directions_;
  std::optional<gl::Volume> sums_;
};

}  // namespace mesograin::render
