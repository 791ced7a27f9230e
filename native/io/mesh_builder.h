// Gathers the faces of a mesh file, whose positions, normals and UVs are numbered apart, into one vertex per
// combination.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "scene/mesh.h"

namespace mesograin::io {

class MeshBuilder {
 public:
  /// A corner of a face: numbers into `positions`, `normals` and `uvs`.
  struct Corner {
    std::uint32_t position;
    std::optional<std::uint32_t> normal;
    std::optional<std::uint32_t> uv;

    bool operator==(const Corner&) const = default;
  };

  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uvs;

  /// Adds a polygon of at least 3 corners, all of which name what is there.
  void add_face(std::span<const Corner> corners);

  bool has_faces() const { return !triangles_.empty(); }

  /// Throws Error if the arrays make no mesh.
  scene::Mesh build() const;

 private:
  struct CornerHash {
    std::size_t operator()(const Corner& corner) const;
  };

  std::uint32_t vertex(const Corner& corner);
  /// A normal without length says nothing.
  bool has_normal(const Corner& corner) const;
  std::vector<glm::vec3> vertex_normals() const;

  std::vector<Corner> vertices_;
  std::unordered_map<Corner, std::uint32_t, CornerHash> known_;
  std::vector<glm::uvec3> triangles_;
};

}  // namespace mesograin::io
