// A triangle mesh as every room sees it: copied from wherever it came, checked once, never changed.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

namespace mesograin::scene {

class Mesh {
 public:
  /// Throws Error if there is no triangle, an index points past the positions, sizes disagree or a number is not
  /// finite. Empty `normals` asks for smooth ones, weighted by the triangles' areas; empty `uvs` means the mesh has
  /// none.
  Mesh(std::vector<glm::vec3> positions, std::vector<glm::vec3> normals, std::vector<glm::uvec3> triangles,
       std::vector<glm::vec2> uvs = {});

  const std::vector<glm::vec3>& positions() const { return positions_; }
  const std::vector<glm::vec3>& normals() const { return normals_; }
  const std::vector<glm::uvec3>& triangles() const { return triangles_; }
  const std::vector<glm::vec2>& uvs() const { return uvs_; }

  /// Corners of the axis-aligned box around the positions, in the mesh's own space.
  const glm::vec3& lower() const { return lower_; }
  const glm::vec3& upper() const { return upper_; }

  /// No position is farther from the middle of the box than this.
  double reach() const { return reach_; }

  /// Radius of the sphere that has the same mean chord, 4 volume/area (Cauchy), in the mesh's own space. A mesh that
  /// encloses no volume stands for the sphere around its box.
  double equivalent_radius() const { return equivalent_radius_; }

 private:
  std::vector<glm::vec3> positions_;
  std::vector<glm::vec3> normals_;
  std::vector<glm::uvec3> triangles_;
  std::vector<glm::vec2> uvs_;
  glm::vec3 lower_{0.0F};
  glm::vec3 upper_{0.0F};
  double reach_ = 0.0;
  double equivalent_radius_ = 0.0;
};

using MeshPointer = std::shared_ptr<const Mesh>;

}  // namespace mesograin::scene
