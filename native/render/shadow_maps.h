// What each light sees of the scene, so that objects shade each other.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/texture_array.h"
#include "render/bounds.h"
#include "render/receivers.h"

namespace mesograin::render {

/// Where a shadow map is seen from: the place of the light if w is 1, the direction towards it if w is 0.
using ShadowEye = glm::dvec4;

class ShadowMaps {
 public:
  /// Fills a layer with all that may stand in the light, as this projection and this eye see it; says false to stop.
  /// `depth` is as large as a layer.
  using DrawCasters = std::function<bool(const glm::dmat4& anchor_to_clip, const ShadowEye& eye, gl::TextureArray& maps,
                                         int layer, const gl::Texture& depth)>;

  /// Draws a map for each eye, around what is lit. `casters` hold all that may stand in the light, `over_ground` what
  /// may stand in that of the ground. `jitter`, in [0, 1)^2, moves the texels, so that the mean over many has no
  /// stairs. False if stopped.
  bool update(const std::vector<ShadowEye>& eyes, const Receivers& receivers, const Bounds& casters,
              const Bounds& over_ground, int resolution, const glm::dvec2& jitter, const DrawCasters& draw);

  /// Makes them what shaders/scene/shadows.glsl reads.
  void bind(const gl::Program& program) const;

 private:
  std::optional<gl::TextureArray> maps_;
  std::optional<gl::Texture> depth_;
  std::optional<gl::Buffer> views_;
};

}  // namespace mesograin::render
