// Many instances of a few meshes that rays are cast into: a tree over their boxes, whose leaves are the meshes' trees.
// An instance costs its place in that tree and nothing else.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "casting/mesh_tree.h"
#include "casting/rays.h"

namespace mesograin::casting {

/// Instances of one mesh.
struct PlacedGroup {
  std::shared_ptr<const MeshTree> mesh;
  const glm::vec4* rows;  ///< three an instance, from the mesh's axes to the scene's; must outlive the tree
  std::uint32_t count;
  std::uint32_t first_number;  ///< of the first instance; the others follow
};

class PlacedTree {
 public:
  /// Throws Error if there is no memory for it.
  explicit PlacedTree(std::vector<PlacedGroup> groups);
  ~PlacedTree();
  PlacedTree(const PlacedTree&) = delete;
  PlacedTree& operator=(const PlacedTree&) = delete;

  /// What the rays meet first. Leaves alone the hits of rays that meet nothing nearer than `farthest`, and moves that
  /// to what others meet, so that several trees can be asked one after the other.
  void first_hits(Packet& packet, Hits& hits) const;

  /// The same of a ray alone, in half the time that it takes in a packet; nothing, if it meets nothing so near.
  std::optional<Hit> first_hit(const SingleRay& ray) const;

  /// What a ray meets of one instance, whatever stands before it, from `near` on.
  std::optional<Hit> hit_of(std::uint32_t number, const SingleRay& ray, float near) const;

  /// False only if no instance of this tree has a place so near to another.
  bool may_reach(const glm::vec3& place, float distance) const;

  /// Whether something stands between each origin and what is `farthest` from there; such rays are no longer `cast`.
  void find_occluded(Packet& packet) const;

 private:
  std::vector<PlacedGroup> groups_;
  void* scene_;
};

}  // namespace mesograin::casting
