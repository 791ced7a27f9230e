// A mesh that rays are cast into, the middle of its bounds at the origin.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "scene/mesh.h"

namespace mesograin::casting {

/// Whether rays can be cast on this machine.
bool available();

class MeshTree {
 public:
  /// Throws Error if there is no memory for it.
  explicit MeshTree(const scene::Mesh& mesh);
  ~MeshTree();
  MeshTree(const MeshTree&) = delete;
  MeshTree& operator=(const MeshTree&) = delete;

  /// Half the size of its bounds, which lie evenly around the origin.
  const glm::vec3& half() const { return half_; }

  /// Embree's scene.
  void* scene() const { return scene_; }

 private:
  glm::vec3 half_;
  void* scene_;
};

}  // namespace mesograin::casting
