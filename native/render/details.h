// Levels of detail of a prototype: the mesh with fewer and fewer triangles, for where its instances are small.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "gl/vertex_array.h"
#include "scene/mesh.h"

namespace mesograin::render {

class Details {
 public:
  /// `full` is the whole mesh on the device.
  Details(const scene::Mesh& mesh, std::shared_ptr<gl::VertexArray> full);

  std::size_t count() const { return levels_.size(); }
  const gl::VertexArray& mesh(std::size_t level) const { return *levels_[level].mesh; }

  /// The coarsest level that no picture tells from the mesh where an instance is this many pixels across.
  std::size_t level(double pixels_across) const;

 private:
  struct Level {
    std::shared_ptr<gl::VertexArray> mesh;
    double error;  // how far its surface is from the mesh's, of the mesh's extent
  };
  std::vector<Level> levels_;  // the finest first
};

}  // namespace mesograin::render
