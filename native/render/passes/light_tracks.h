// Rays of a sample's suns that a grain's walks meet inside it, and the cells of a lattice that they leave their tracks
// in.
#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "gl/program.h"
#include "gl/volume.h"
#include "render/device_cache.h"

namespace mesograin::render {

class LightTracks {
 public:
  /// So many lights can share a lattice.
  static constexpr std::size_t most_together = 16;

  /// Layers of textures that each light takes, of a grain that is stored at `nodes`.
  static int layers(const glm::ivec3& nodes);

  /// Other rays in every sample, of lights that are bound as storage, in a grain that is stored at `nodes`. `together`:
  /// they share a lattice.
  void trace(DeviceCache& cache, const DeviceMaterial& material, const glm::ivec3& nodes,
             const glm::mat3& grain_to_prototype, std::size_t lights, bool together, int sample);

  /// To a program that is compiled for them.
  void bind(const gl::Program& program) const;

 private:
  std::optional<gl::Volume> tracks_;
  std::optional<gl::Volume> drawn_rays_;
  std::optional<gl::Volume> pieces_;
};

}  // namespace mesograin::render
