// Stored transport under the very lights of a sample: what pixels would each sum anew is summed once at its nodes, and
// light that nothing has scattered is followed into the grain once, where walks ask for it or it goes straight.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/volume.h"
#include "render/device_cache.h"
#include "render/draw.h"
#include "render/lighting.h"
#include "render/passes/light_lines.h"
#include "render/passes/light_tracks.h"
#include "render/passes/sample.h"

namespace mesograin::render {

class ProductSums {
 public:
  /// Whether it costs less than what it spares a thing that so many pixels show.
  static bool pay(const DeviceMaterial& material, const std::vector<LightDirection>& lights, double pixels);

  /// Whether pixels ask for nothing but sums and tracks: then all lights may share them, where nothing stands in their
  /// way.
  static bool can_be_together(const DeviceMaterial& material, std::size_t lights);

  /// For a draw that they pay for, if it, its turn or a light is another than the last time; what is followed, anew in
  /// every sample. `stored`: the draw's number if what single lights do in it is stored or will be; `lines`:
  /// how many tell of light that goes straight, side by side, or 0. Binds textures of its own: a program's come after.
  void sum(const Sample& sample, const Draw& draw, std::optional<std::size_t> stored, int lines, bool together);

  /// To a program that is compiled for them.
  void bind(const gl::Program& program) const;

 private:
  /// What they depend on.
  struct Of {
    std::weak_ptr<const DeviceMaterial> material;
    int version = 0;
    int stored_lights = 0;  // StoredLights::version
    int lines = 0;          // LightLines::across
    glm::mat3 grain_to_prototype{0.0F};
    std::vector<glm::vec3> to_lights;
    std::vector<glm::vec3> irradiances;  // if they are summed together
  };

  bool hold(const Of& of) const;

  Of of_;
  std::optional<gl::Buffer> directions_;
  std::optional<gl::Volume> sums_;
  bool tracked_ = false;
  std::uint32_t tracked_sample_ = 0;
  LightTracks tracks_;
  LightLines lines_;
};

}  // namespace mesograin::render
