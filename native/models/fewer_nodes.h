// What is known at many nodes of a box, told by fewer: linear between these it is as near to it as can be.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace mesograin::models {

/// `values` are at `size` nodes, x fastest, and the result is at `fewer` nodes of the same box, at least 2 along each
/// side, such that the squares of what it is off at all `size` nodes make the least sum.
std::vector<float> at_fewer_nodes(const std::vector<float>& values, const glm::ivec3& size, const glm::ivec3& fewer);

}  // namespace mesograin::models
