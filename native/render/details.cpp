// Each level has half as many triangles as the one before, as long as the mesh lets itself be simplified.
#include "render/details.h"

#include <meshoptimizer.h>

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

#include "render/device_layout.h"

namespace mesograin::render {
namespace {

constexpr std::size_t fewest_triangles = 12;

// Of the volume. What loses more was no body.
constexpr double most_growth = 2.0;

struct Simplified {
  std::vector<glm::uvec3> triangles;
  double error;
};

Simplified simplified(const scene::Mesh& mesh, std::size_t triangles) {
  const auto* indices = reinterpret_cast<const std::uint32_t*>(mesh.triangles().data());
  std::vector<std::uint32_t> kept(mesh.triangles().size() * 3);
  constexpr float any_error = 1.0F;
  float error = 0.0F;
  const std::size_t count =
      meshopt_simplify(kept.data(), indices, kept.size(), glm::value_ptr(mesh.positions().front()),
                       mesh.positions().size(), sizeof(glm::vec3), triangles * 3, any_error, 0, &error);
  Simplified result{{}, error};
  for (std::size_t i = 0; i + 2 < count; i += 3) result.triangles.emplace_back(kept[i], kept[i + 1], kept[i + 2]);
  return result;
}

// Six times the volume that the triangles enclose, of a closed mesh.
double volume(const scene::Mesh& mesh, const std::vector<glm::uvec3>& triangles) {
  const glm::dvec3 middle = 0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper()));
  double sum = 0.0;
  for (const glm::uvec3& triangle : triangles)
    sum += glm::dot(glm::dvec3(mesh.positions()[triangle.x]) - middle,
                    glm::cross(glm::dvec3(mesh.positions()[triangle.y]) - middle,
                               glm::dvec3(mesh.positions()[triangle.z]) - middle));
  return sum;
}

// Without the vertices that no triangle uses. Chords lie inside a grain: a coarse level would be seen as smaller, and
// so grows until it has the mesh's volume. An open mesh, whose volume says nothing, stays.
scene::MeshPointer compact(const scene::Mesh& mesh, std::vector<glm::uvec3> triangles) {
  const double ratio = volume(mesh, mesh.triangles()) / volume(mesh, triangles);
  const double growth = ratio > 1.0 && ratio < most_growth ? std::cbrt(ratio) : 1.0;
  const glm::vec3 middle = 0.5F * (mesh.lower() + mesh.upper());
  constexpr std::uint32_t unused = 0xFFFFFFFFU;
  std::vector<std::uint32_t> places(mesh.positions().size(), unused);
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uvs;
  for (glm::uvec3& triangle : triangles)
    for (int corner = 0; corner < 3; ++corner) {
      std::uint32_t& place = places[triangle[corner]];
      if (place == unused) {
        place = static_cast<std::uint32_t>(positions.size());
        positions.push_back(middle + static_cast<float>(growth) * (mesh.positions()[triangle[corner]] - middle));
        normals.push_back(mesh.normals()[triangle[corner]]);
        if (!mesh.uvs().empty()) uvs.push_back(mesh.uvs()[triangle[corner]]);
      }
      triangle[corner] = place;
    }
  return std::make_shared<const scene::Mesh>(std::move(positions), std::move(normals), std::move(triangles),
                                             std::move(uvs));
}

}  // namespace

Details::Details(const scene::Mesh& mesh, std::shared_ptr<gl::VertexArray> full)
    : mesh_(mesh), half_(0.5 * (glm::dvec3(mesh.upper()) - glm::dvec3(mesh.lower()))) {
  const glm::vec3 middle = 0.5F * (mesh.lower() + mesh.upper());
  std::size_t triangles = mesh.triangles().size();
  levels_.push_back({std::move(full), 0.0, nullptr});
  while (triangles / 2 >= fewest_triangles) {
    Simplified coarser = simplified(mesh, triangles / 2);
    // Where hardly anything is gained, such as on a soup of triangles that share no vertices, nothing more will be.
    if (coarser.triangles.size() < fewest_triangles || coarser.triangles.size() * 4 > triangles * 3) break;
    triangles = coarser.triangles.size();
    scene::MeshPointer coarse = compact(mesh, std::move(coarser.triangles));
    levels_.push_back(
        {std::make_shared<gl::VertexArray>(coarse->positions(), coarse->normals(), coarse->uvs(), coarse->triangles()),
         coarser.error, coarse});
    half_ = glm::max(half_, glm::max(coarse->upper() - middle, middle - coarse->lower()));
  }
}

const casting::FlatMesh& Details::flat(std::size_t level) const {
  const Level& of = levels_[level];
  if (!of.flat) {
    const glm::vec3 middle(0.5 * (glm::dvec3(mesh_.lower()) + glm::dvec3(mesh_.upper())));
    of.flat = std::make_unique<const casting::FlatMesh>(
        casting::flat_mesh(of.coarse ? *of.coarse : mesh_, middle, layout::MOST_DEPTH_OF_MESH));
  }
  return *of.flat;
}

std::size_t Details::level(double pixels_across) const {
  std::size_t level = levels_.size() - 1;
  while (level > 0 && levels_[level].error * pixels_across > most_detail_error) --level;
  return level;
}

}  // namespace mesograin::render
