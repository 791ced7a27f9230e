// Draws and casts what the camera sees, and reads it back.
#include "render/passes/surface_pass.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace mesograin::render {

bool SurfacePass::run(const Sample& sample, const ArrayVisibility& arrays, std::size_t first) {
  const auto start = std::chrono::steady_clock::now();
  Targets& targets = sample.targets;
  if (sample.cast) {
    if (first == 0 && !cast_.cast(arrays.tree(), sample.content, anchor_to_clip(sample.content, sample.camera),
                                  sample.jitter, sample.size, sample.go_on))
      return false;
    cast_.found().upload(targets, first);
  }
  const bool found = sample.cast || sample.device_rays;
  if (sample.device_rays) {
    if (first == 0)
      device_.cast(sample.cache, arrays.device_rays(), sample.content, anchor_to_clip(sample.content, sample.camera),
                   sample.jitter, targets);
    device_.mark(sample.cache, sample.content, targets, first);
  }
  targets.surfaces.bind();
  glDisable(GL_BLEND);
  if (!found && first == 0) targets.surfaces.clear();
  if (!found && first > 0) targets.surfaces.clear_depth();
  const bool whole = draw_surfaces(sample.cache, sample.content, found ? nullptr : arrays.selection(), sample.camera,
                                   sample.jitter, first, sample.go_on);
  if (sample.cast) glFinish();
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return whole;
}

SeenSurfaces SurfacePass::seen(const Sample& sample) {
  const glm::vec4 viewer = sample.viewer(sample.content.anchor());
  if (sample.cast && sample.content.draws().empty())
    return {cast_.found().positions(), cast_.found().normals(), sample.size, viewer};
  const std::size_t pixels = static_cast<std::size_t>(sample.size.x) * static_cast<std::size_t>(sample.size.y);
  read_positions_.resize(pixels);
  read_normals_.resize(pixels);
  sample.targets.surfaces.read(&read_positions_.front().x, 0);
  sample.targets.surfaces.read(&read_normals_.front().x, 1);
  return {read_positions_, read_normals_, sample.size, viewer};
}

void read_surfaces(const Sample& sample, float* positions, float* normals) {
  const auto width = static_cast<std::size_t>(sample.size.x);
  const auto height = static_cast<std::size_t>(sample.size.y);
  const glm::dvec4 eye(sample.viewer(glm::dvec3(0.0)));
  std::vector<glm::vec4> on_triangle(width * height);
  std::vector<glm::vec4> facing(width * height);
  sample.targets.surfaces.read(glm::value_ptr(on_triangle.front()), 0);
  sample.targets.surfaces.read(glm::value_ptr(facing.front()), 1);
  for (std::size_t i = 0; i < on_triangle.size(); ++i) {
    glm::vec4 position(0.0F);
    glm::vec3 normal(0.0F);
    if (facing[i].w != 0.0F) {
      const auto number = static_cast<std::size_t>(std::abs(facing[i].w)) - 1;
      const glm::dvec3 origin = sample.content.anchor() + glm::dvec3(sample.content.receiver(number).ball);
      normal = glm::vec3(facing[i]);
      const glm::dvec3 place = glm::dvec3(on_triangle[i]) + static_cast<double>(on_triangle[i].w) * glm::dvec3(normal);
      position = glm::vec4(glm::vec3(origin + place), 1.0F);
      if (facing[i].w < 0.0F && glm::dot(glm::dvec3(normal), glm::dvec3(eye) - eye.w * (origin + place)) < 0.0)
        normal = -normal;
    }
    // The device's rows begin at the bottom.
    const std::size_t pixel = (height - 1 - i / width) * width + i % width;
    std::copy_n(glm::value_ptr(position), 4, positions + 4 * pixel);
    std::copy_n(glm::value_ptr(normal), 3, normals + 3 * pixel);
  }
}

}  // namespace mesograin::render
