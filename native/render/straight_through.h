// How much light goes straight through single draws along a ray: through those that nothing refracts at exp(-sigma_t
// d), d being the way inside (Beer's law), and through panes what a sheet of their glass passes.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "casting/rays.h"
#include "render/cast_content.h"
#include "render/content.h"
#include "render/exchange.h"

namespace mesograin::render {

class StraightThrough {
 public:
  /// What `exchange` tells goes straight through is left out.
  StraightThrough(const CastContent& cast, const Content& content, const Exchange& exchange)
      : cast_(cast), content_(content), exchange_(exchange) {}

  /// What is left of light at the ray's origin that comes from its farthest point. Its direction is of unit length.
  glm::vec3 left(casting::SingleRay ray) const;

  /// Where light along a ray is stopped, all of it: where it comes into the first draw behind which no more than
  /// `drawn` of it is left, on average over the channels, or meets what lets none through. Nothing if it goes on.
  std::optional<casting::Hit> stopped(casting::SingleRay ray, float drawn) const;

 private:
  /// What has been entered, less what has been left, on a way.
  struct Way {
    glm::vec3 depth{0.0F};   // of what was left, less that of what is not up to where it begins; panes' whole
    glm::vec3 inside{0.0F};  // sigma_t
    float length = 0.0F;

    glm::vec3 left() const;
  };

  /// On through a draw that was met, to where light may meet something else; returns whether it has come into that.
  /// Nothing, if light does not go straight through it.
  std::optional<bool> go_on(const casting::Hit& hit, Way& way, casting::SingleRay& ray) const;
  bool go_on_thin(const Draw& draw, const casting::Hit& hit, Way& way, casting::SingleRay& ray) const;
  bool go_on_pane(const Draw& draw, const casting::Hit& hit, Way& way, casting::SingleRay& ray) const;

  const CastContent& cast_;
  const Content& content_;
  const Exchange& exchange_;
};

}  // namespace mesograin::render
