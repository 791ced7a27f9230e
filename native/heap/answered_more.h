// How much more a grain makes of the light that comes to it than one of another material does, at once: enough until
// its table is known.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "heap/optics.h"

namespace mesograin::heap {

/// What leaves `now`, unless it crosses straight, over what leaves `before`, of light from everywhere; 1 where they are
/// alike.
glm::vec3 answered_more(const Optics& now, const Optics& before);

/// The same of as many kinds.
std::vector<glm::vec3> answered_more(const std::vector<Optics>& now, const std::vector<Optics>& before);

}  // namespace mesograin::heap
