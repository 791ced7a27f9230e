// What stands around a heap and is no grain: grounds, bowls, walls. Each is a mesh whose surface sends out light evenly
// to all sides.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/mesh.h"

namespace mesograin::heap {

struct Wall {
  scene::MeshPointer mesh;
  glm::dmat4 to_heap;        ///< from the mesh's own space to where grains have their places
  std::uint32_t kind;        ///< which of Grains::kinds
  glm::vec3 radiance{0.0F};  ///< of its own; lights tell what that does to grains
  bool has_lights = false;   ///< by which most looks through clear grains see it
  bool hollow = false;       ///< a thick grain, whose own parts send each other light

  bool operator==(const Wall&) const = default;

  /// Whether light may meet either side of its triangles: whether it has an edge that one triangle has alone.
  bool open() const;
};

/// Of a mesh's corners where the heap is.
std::vector<glm::vec3> places_of(const scene::Mesh& mesh, const glm::dmat4& to_heap);

}  // namespace mesograin::heap
