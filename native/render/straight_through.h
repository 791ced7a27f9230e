// How much light goes straight through single draws that nothing refracts at, along a ray: exp(-sigma_t d), d being the
// way inside (Beer's law).
#pragma once

#include <glm/vec3.hpp>

#include "casting/rays.h"
#include "render/cast_content.h"
#include "render/content.h"

namespace mesograin::render {

class StraightThrough {
 public:
  StraightThrough(const CastContent& cast, const Content& content) : cast_(cast), content_(content) {}

  /// What is left of light at the ray's origin that comes from its farthest point. Its direction is of unit length.
  glm::vec3 left(casting::SingleRay ray) const;

 private:
  const CastContent& cast_;
  const Content& content_;
};

}  // namespace mesograin::render
