// Levels of detail of a prototype: the mesh with fewer and fewer triangles, for where its instances are small.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "casting/flat_mesh.h"
#include "gl/vertex_array.h"
#include "scene/mesh.h"

namespace mesograin::render {

class Details {
 public:
  /// `full` is the whole mesh on the device. `mesh` must outlive it.
  Details(const scene::Mesh& mesh, std::shared_ptr<gl::VertexArray> full);

  std::size_t count() const { return levels_.size(); }
  const gl::VertexArray& mesh(std::size_t level) const { return *levels_[level].mesh; }

  /// The same for the device's rays, from the middle of the mesh's bounds; made on first use.
  const casting::FlatMesh& flat(std::size_t level) const;

  /// Half the size of a box around that middle that holds every level.
  const glm::vec3& half() const { return half_; }

  /// How far a level's surface is from the mesh's, of the mesh's extent.
  double error(std::size_t level) const { return levels_[level].error; }

  /// The coarsest level that no picture tells from the mesh where an instance is this many pixels across.
  std::size_t level(double pixels_across) const;

 private:
  struct Level {
    std::shared_ptr<gl::VertexArray> mesh;
    double error;
    scene::MeshPointer coarse;  // null for the mesh itself
    mutable std::unique_ptr<const casting::FlatMesh> flat = nullptr;
  };
  const scene::Mesh& mesh_;
  glm::vec3 half_;
  std::vector<Level> levels_;  // the finest first
};

/// How far a level's surface may be from the mesh's, in pixels.
inline constexpr double most_detail_error = 0.1;

}  // namespace mesograin::render
