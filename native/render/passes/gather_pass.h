// Gathers what grains send to each grain that a pixel shows, by rays on all cores: where the scene asks for it to all,
// else to clear ones, which are seen through.
#pragma once

#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "gl/program.h"
#include "gl/texture.h"
#include "render/denoiser.h"
#include "render/inner_lights.h"
#include "render/levels.h"
#include "render/passes/array_visibility.h"
#include "render/passes/sample.h"
#include "render/passes/surface_pass.h"

namespace mesograin::render {

class GatherPass {
 public:
  /// After the surfaces are found. Clear grains are looked into where rays find what is seen. False if ended.
  bool run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces);

  /// Whether the last run had anything to gather.
  bool ran() const { return ran_; }

  /// Of the grains that it showed.
  const SeenByLevel& levels() const { return levels_; }

  /// That the last run took of this side.
  double milliseconds() const { return milliseconds_; }

  /// Makes it what shaders/heap/light_from_grains.glsl reads, if there is any.
  void bind(const gl::Program& program) const;

 private:
  bool follow_light(const Sample& sample, const ArrayVisibility& arrays, const SeenSurfaces& seen);
  bool look_straight(const Sample& sample, const SeenSurfaces& seen);
  void make_amends(const Sample& sample, const std::vector<glm::vec4>& normals);

  Denoiser denoiser_;
  InnerLights inner_lights_;
  Amends amends_;
  std::vector<std::optional<Amends::Probe>> probes_;
  SeenByLevel levels_;
  std::vector<Level> seen_by_;  // of each pixel
  std::vector<Likeness> likenesses_;
  std::vector<glm::vec4> others_;      // of what grains send; w: 1 where it was looked
  std::vector<glm::vec4> lights_;      // and the world, seen through grains
  std::vector<glm::vec4> scattered_;   // lights, in grains that no model is asked of
  std::vector<glm::vec4> mirrored_;    // and at their surfaces
  std::vector<glm::vec4> highlights_;  // of lights, there
  std::vector<glm::vec4> chance_;      // and those that few looks through clear grains meet
  std::vector<glm::vec4> straight_;    // of what others send
  std::vector<glm::vec4> steady_;      // what grains' inner light tells
  std::vector<glm::vec4> behind_;      // the world and the film, seen straight through
  std::optional<gl::Texture> device_others_;
  std::optional<gl::Texture> device_lights_;
  std::optional<gl::Texture> device_scattered_;
  std::optional<gl::Texture> device_mirrored_;
  bool ran_ = false;
  double milliseconds_ = 0.0;
};

}  // namespace mesograin::render
