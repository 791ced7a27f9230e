// Whether a body is as good as convex.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace mesograin::transport {

/// Whether nothing of the body lies noticeably above any of its faces: quads that bend, cut along the diagonal that
/// lies deeper, make a mesh of a convex body that is not. `normals`: a triangle's each, outwards. Lengths are in units
/// of the body.
bool nearly_convex(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles,
                   const std::vector<glm::vec3>& normals);

}  // namespace mesograin::transport
