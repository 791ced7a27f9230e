// Draws a view's content: as the camera sees it, for each pixel to be shaded once, and as a light does.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "gl/framebuffer.h"
#include "render/content.h"
#include "render/go_on.h"
#include "render/shadow_maps.h"
#include "render/stencil.h"
#include "scene/camera.h"

namespace mesograin::render {

/// Selected instances on the device.
struct DeviceSelection {
  Selection selection;
  gl::Buffer instances;

  explicit DeviceSelection(Selection from) : selection(std::move(from)), instances(selection.instances) {}
};

/// Draws positions and normals. What is shaded apart, the groups of instances and then the draws, marks the stencil: 1
/// for `first`, and so on up to the last it can hold. `selection` is null without instances, or where they
/// were found by other means. False if ended.
bool draw_surfaces(DeviceCache& cache, const Content& content, const DeviceSelection* selection,
                   const scene::Camera& camera, const glm::vec2& jitter, std::size_t first, const GoOn& go_on);

/// Draws what stands in a light into a layer of shadow maps. False if ended.
bool draw_casters(DeviceCache& cache, const Content& content, const DeviceSelection* selection,
                  const glm::dmat4& anchor_to_clip, const ShadowEye& eye, const gl::Framebuffer& target,
                  const GoOn& go_on);

/// The camera's projection, from the content's anchor.
glm::dmat4 anchor_to_clip(const Content& content, const scene::Camera& camera);

}  // namespace mesograin::render
