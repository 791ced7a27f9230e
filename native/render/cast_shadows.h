// What other objects leave of each light, found by rays: from what is seen to the light, a bit for each light and
// pixel; or, where light is known beneath the surface too, from the light, as a shadow map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "gl/program.h"
#include "gl/texture.h"
#include "render/cast_content.h"
#include "render/content.h"
#include "render/go_on.h"
#include "render/shadow_maps.h"
#include "render/straight_through.h"

namespace mesograin::render {

/// Each has a bit.
inline constexpr std::size_t most_cast_lights = 32;

/// What a picture shows, as surface.frag writes it.
struct SeenSurfaces {
  const std::vector<glm::vec4>& positions;
  const std::vector<glm::vec4>& normals;
  glm::ivec2 size;
  glm::vec4 viewer;                               ///< as in lit_point.glsl, from the anchor
  const std::vector<glm::vec4>* looks = nullptr;  ///< where another surface mirrors them, along which: a pixel each

  /// Of one pixel.
  glm::vec4 viewer_of(std::size_t pixel) const {
    return looks != nullptr ? glm::vec4(-glm::vec3((*looks)[pixel]), 0.0F) : viewer;
  }
};

class CastShadows {
 public:
  /// Casts a ray from each pixel to each light, where it shows an object by whose number `asks` says so. `through`:
  /// what goes straight through what stands in the way, or null if nothing does. A share of light is a bit that is set
  /// as often, in each channel and the samples of these indices. False if ended.
  bool cast(const CastContent& cast, const Content& content, const SeenSurfaces& seen,
            const std::function<bool(std::size_t)>& asks, const std::vector<ShadowEye>& eyes,
            const StraightThrough* through, std::uint32_t index, const GoOn& go_on);

  /// Where rays that the device follows tell them, for a picture of this size.
  const gl::Texture& on_device(const glm::ivec2& size, std::size_t channels = 1);

  /// Makes them what shaders/scene/shadows.glsl reads.
  void bind(const gl::Program& program) const;

 private:
  std::vector<std::uint32_t> reached_;  // a bit a light; of each channel, or of all together
  std::optional<gl::Texture> device_;
  std::size_t channels_ = 0;  // of it
};

/// What goes straight through what stands in a light's way to its shadow map, or null if nothing does: a share of light
/// is the texels that it is stopped at no more, others in the samples of these indices.
struct ThroughToMap {
  const StraightThrough* straight;
  std::size_t light;
  std::uint32_t index;
};

/// Fills a shadow map of this many texels on a side. False if ended.
bool cast_shadow_map(const CastContent& cast, const Content& content, const glm::dmat4& anchor_to_clip,
                     const ShadowEye& eye, const ThroughToMap& through, int resolution, std::vector<glm::vec2>& texels,
                     const GoOn& go_on);

}  // namespace mesograin::render
