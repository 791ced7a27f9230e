// How much more a grain makes of the light that comes to it than one of another material does, at once: enough until
// its table is known.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "heap/optics.h"

namespace mesograin::heap {

/// Of light from everywhere; 1 where two materials are alike.
struct AnsweredMore {
  glm::vec3 of_all{1.0F};  ///< what leaves the one, unless it crosses straight, over what leaves the other
  glm::vec3 of_met{1.0F};  ///< the same of what did not cross
  /// The same of what entered a surface that refracts.
  glm::vec3 of_entered{1.0F};
};

AnsweredMore answered_more(const Optics& now, const Optics& before);

/// Of as many kinds.
std::vector<AnsweredMore> answered_more(const std::vector<Optics>& now, const std::vector<Optics>& before);

}  // namespace mesograin::heap
