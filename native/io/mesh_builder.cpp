// Vertices are shared by equal corners; smooth normals are made on positions alone, so that a UV seam leaves no crease.
#include "io/mesh_builder.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "io/triangulate.h"

namespace mesograin::io {

std::size_t MeshBuilder::CornerHash::operator()(const Corner& corner) const {
  std::uint64_t hash = corner.position;
  for (const std::optional<std::uint32_t>& part : {corner.normal, corner.uv}) {
    hash ^= part ? *part + std::uint64_t{1} : 0;
    hash *= 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio spreads consecutive numbers
    hash ^= hash >> 32U;
  }
  return static_cast<std::size_t>(hash);
}

std::uint32_t MeshBuilder::vertex(const Corner& corner) {
  const auto [found, is_new] = known_.try_emplace(corner, static_cast<std::uint32_t>(vertices_.size()));
  if (is_new) vertices_.push_back(corner);
  return found->second;
}

void MeshBuilder::add_face(std::span<const Corner> corners) {
  std::vector<glm::vec3> outline;
  std::vector<std::uint32_t> numbers;
  for (const Corner& corner : corners) {
    outline.push_back(positions[corner.position]);
    numbers.push_back(vertex(corner));
  }
  for (const glm::uvec3& triangle : triangulate(outline))
    triangles_.emplace_back(numbers[triangle.x], numbers[triangle.y], numbers[triangle.z]);
}

bool MeshBuilder::has_normal(const Corner& corner) const {
  return corner.normal && glm::dot(normals[*corner.normal], normals[*corner.normal]) > 0.0F;
}

std::vector<glm::vec3> MeshBuilder::vertex_normals() const {
  std::vector<glm::vec3> smooth;
  if (!std::all_of(vertices_.begin(), vertices_.end(), [this](const Corner& corner) { return has_normal(corner); })) {
    std::vector<glm::uvec3> triangles;
    for (const glm::uvec3& triangle : triangles_)
      triangles.emplace_back(vertices_[triangle.x].position, vertices_[triangle.y].position,
                             vertices_[triangle.z].position);
    smooth = scene::Mesh(positions, {}, std::move(triangles)).normals();
  }
  std::vector<glm::vec3> result;
  for (const Corner& corner : vertices_)
    result.push_back(has_normal(corner) ? normals[*corner.normal] : smooth[corner.position]);
  return result;
}

scene::Mesh MeshBuilder::build() const {
  std::vector<glm::vec3> vertex_positions;
  std::vector<glm::vec2> vertex_uvs;
  const bool has_uvs = std::all_of(vertices_.begin(), vertices_.end(), [](const Corner& v) { return v.uv; });
  for (const Corner& corner : vertices_) {
    vertex_positions.push_back(positions[corner.position]);
    if (has_uvs) vertex_uvs.push_back(uvs[*corner.uv]);
  }
  return {std::move(vertex_positions), vertex_normals(), triangles_, std::move(vertex_uvs)};
}

}  // namespace mesograin::io
