// Has the device follow rays: what the camera sees of instances, and what stands in a light.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "gl/texture.h"
#include "gl/texture_array.h"
#include "gl/vertex_array.h"
#include "render/content.h"
#include "render/device_rays.h"
#include "render/passes/targets.h"
#include "render/shadow_maps.h"

namespace mesograin::render {

/// What the camera sees of instances, found by the device's rays; the same that surface.frag draws.
class DeviceSurfaces {
 public:
  /// Writes positions and normals of every pixel.
  void cast(DeviceCache& cache, const DeviceRays& rays, const Content& content, const glm::dmat4& anchor_to_clip,
            const glm::vec2& jitter, const Targets& targets);

  /// Makes their depths those drawn so far, and marks the stencil: 1 for the group `first`, and so on up to the last it
  /// can hold.
  void mark(DeviceCache& cache, const Content& content, const Targets& targets, std::size_t first) const;

  /// x: depth; y: which group, from 1.
  const gl::Texture& marks() const { return *marks_; }

 private:
  std::optional<gl::Texture> marks_;
  gl::FullScreenTriangle full_screen_;
};

/// Whether this light reaches what the camera sees: the bit of its number in `reached`. Those of number 0 come first,
/// and begin anew. `viewer`: as in lit_place.
void cast_shadows(DeviceCache& cache, const DeviceRays& rays, const glm::dmat4& anchor_to_clip, const Targets& targets,
                  const DeviceSurfaces& surfaces, const glm::vec4& viewer, int light, const ShadowEye& eye,
                  const gl::Texture& reached);

/// Fills a layer of shadow maps.
void cast_shadow_map(DeviceCache& cache, const DeviceRays& rays, const Content& content,
                     const glm::dmat4& anchor_to_clip, const ShadowEye& eye, const gl::TextureArray& maps, int layer);

}  // namespace mesograin::render
