// One walk of light through a grain's own facets where nothing refracts at them: from the place that is seen to where
// it leaves.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "heap/facet_walk.h"
#include "heap/flights.h"
#include "heap/sphere_walk.h"

namespace mesograin::heap {

/// Follows a view ray; lengths in `optics` are in `radius`. `scattered` is told of every scattering. Of a transparent
/// grain `across` is where the way straight behind the place that is seen ends (Facets::end), and light that is not
/// scattered on it is left out, as walk() has it. Nothing, where all was absorbed. `hero`: of the grains before it on
/// its way; leaves it that of this one, too.
std::optional<Passage> walk_medium(const Optics& optics, float radius, const SeenFacet& seen,
                                   const std::optional<End>& across, const Facets& facets, transport::Random& random,
                                   const Scattered& scattered = {}, Hero* hero = nullptr);

}  // namespace mesograin::heap
