// A tree over boxes as a device walks it: two boxes a node, in one list.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace mesograin::casting {

struct Box {
  glm::vec3 lower;
  glm::vec3 upper;
};

/// As shaders/render/tree_node.glsl has it.
struct FlatNode {
  glm::vec4 first_lower;
  glm::vec4 first_upper;
  glm::vec4 second_lower;
  glm::vec4 second_upper;
};

struct FlatTree {
  std::vector<FlatNode> nodes;       ///< the first is the root
  std::vector<std::uint32_t> order;  ///< which boxes the leaves hold, one after the other
};

/// Numbers of nodes and boxes are told as floats, which are whole up to here.
inline constexpr std::size_t most_in_flat_tree = std::size_t{1} << 24U;

/// By the surface area heuristic, on all cores; up to `most_in_leaf` boxes to a leaf, and `most_depth` nodes on the way
/// to it. Throws Error for more boxes than most_in_flat_tree, for such as need more nodes, and if there is no memory.
FlatTree flat_tree(const std::vector<Box>& boxes, std::size_t most_in_leaf, unsigned most_depth);

}  // namespace mesograin::casting
