// Adds what surfaces of facets mirror: the world, or what stands before it, which is shaded as if it were seen.
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <vector>

#include "gl/program.h"
#include "gl/vertex_array.h"
#include "render/cast_mirrors.h"
#include "render/passes/array_visibility.h"
#include "render/passes/sample.h"
#include "render/passes/shade_pass.h"
#include "render/passes/shadow_pass.h"
#include "render/passes/surface_pass.h"

namespace mesograin::render {

class MirrorPass {
 public:
  MirrorPass();

  /// After everything seen is shaded; what was found of surfaces is gone then. False if ended.
  bool run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces, ShadowPass& shadows,
           ShadePass& shade);

  /// Whether the last sample needed it.
  bool ran() const { return ran_; }

  /// That the last run took, of this side and the device.
  double milliseconds() const { return milliseconds_; }

 private:
  /// Whether anything in these boxes, which rays found, shows what stands behind it.
  static bool any_goes_on(const Sample& sample, const std::vector<PixelBox>& boxes);

  /// Those that `through` are not, cleared.
  static const MirrorTargets& targets_behind(Targets& targets, const MirrorTargets& through);

  /// What the rays found. False if ended.
  bool add(const Sample& sample, const ArrayVisibility& arrays, const MirroredBy& by,
           const std::vector<PixelBox>& boxes, const std::vector<glm::vec4>& looks, ShadowPass& shadows,
           ShadePass& shade);
  void add_world(const Sample& sample, const MirrorTargets& through);

  gl::Program program_;
  gl::FullScreenTriangle full_screen_;
  CastMirrors cast_;
  std::array<std::vector<glm::vec4>, 2> looks_;  // of a layer and of the one before
  bool ran_ = false;
  double milliseconds_ = 0.0;
};

}  // namespace mesograin::render
