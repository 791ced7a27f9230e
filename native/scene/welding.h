// Which corners of a mesh are one place.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace mesograin::scene {

/// For each position a number that is the same where positions coincide but for rounding, as on the seam of a sphere.
/// tolerance: of the mesh's reach.
std::vector<std::uint32_t> welded(const Mesh& mesh, double tolerance);

}  // namespace mesograin::scene
