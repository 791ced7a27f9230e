// Adds what surfaces of facets mirror of the world, where nothing stands in the way.
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "gl/program.h"
#include "gl/vertex_array.h"
#include "render/cast_shadows.h"
#include "render/passes/array_visibility.h"
#include "render/passes/sample.h"
#include "render/passes/surface_pass.h"

namespace mesograin::render {

class MirrorPass {
 public:
  MirrorPass();

  /// After everything seen is shaded. False if ended.
  bool run(const Sample& sample, const ArrayVisibility& arrays, SurfacePass& surfaces);

  /// Whether the last sample needed it.
  bool ran() const { return ran_; }

  /// That the last run took of this side.
  double milliseconds() const { return milliseconds_; }

 private:
  gl::Program program_;
  gl::FullScreenTriangle full_screen_;
  CastShadows cast_;
  std::vector<glm::vec4> from_;
  bool ran_ = false;
  double milliseconds_ = 0.0;
};

}  // namespace mesograin::render
