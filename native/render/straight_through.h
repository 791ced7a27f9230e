// How much light goes straight through single draws that nothing refracts at, along a ray: exp(-sigma_t d), d being the
// way inside (Beer's law).
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "casting/rays.h"
#include "render/cast_content.h"
#include "render/content.h"

namespace mesograin::render {

class StraightThrough {
 public:
  StraightThrough(const CastContent& cast, const Content& content) : cast_(cast), content_(content) {}

  /// What is left of light at the ray's origin that comes from its farthest point. Its direction is of unit length.
  glm::vec3 left(casting::SingleRay ray) const;

  /// Where light along a ray is stopped, all of it: where it comes into the first draw behind which no more than
  /// `drawn` of it is left, on average over the channels, or meets what lets none through. Nothing if it goes on.
  std::optional<casting::Hit> stopped(casting::SingleRay ray, float drawn) const;

 private:
  /// What has been entered, less what has been left, on a way.
  struct Way {
    glm::vec3 depth{0.0F};   // of what was left, less that of what is not up to where it begins
    glm::vec3 inside{0.0F};  // sigma_t
    float length = 0.0F;

    glm::vec3 left() const;
  };

  /// The draw that was met if light may go straight through it; else null.
  const Draw* thin(const casting::Hit& hit) const;
  void go_on(const Draw& draw, const casting::Hit& hit, Way& way, casting::SingleRay& ray) const;

  const CastContent& cast_;
  const Content& content_;
};

}  // namespace mesograin::render
