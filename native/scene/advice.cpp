// The numbers are those of docs/accuracy.md and docs/shapes.md: relative L1 against photons, in %.
#include "scene/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "scene/auto.h"
#include "scene/welding.h"

namespace mesograin::scene {
namespace {

constexpr double weld = 1e-6;  // of the mesh's reach

bool is_closed(const Mesh& mesh) {
  const std::vector<std::uint32_t> numbers = welded(mesh, weld);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const glm::uvec3& triangle : mesh.triangles()) {
    const glm::uvec3 corners{numbers[triangle.x], numbers[triangle.y], numbers[triangle.z]};
    if (corners.x == corners.y || corners.y == corners.z || corners.z == corners.x) continue;
    for (int corner = 0; corner < 3; ++corner) ++edges[std::minmax({corners[corner], corners[(corner + 1) % 3]})];
  }
  return std::ranges::all_of(edges, [](const auto& edge) { return edge.second % 2 == 0; });
}

/// Of a table at a radius, straight in the logarithm between what was measured.
double error_at(std::span<const automatic::Measured> table, double radius) {
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (radius > table[i].radius) continue;
    const double share = std::log(std::max(radius, table[i - 1].radius) / table[i - 1].radius) /
                         std::log(table[i].radius / table[i - 1].radius);
    return (1.0 - share) * table[i - 1].error + share * table[i].error;
  }
  return table.back().error;
}

/// Of the channel in the middle, with scattering reduced by g.
double mean_free_path(const Material& material) {
  const glm::dvec3 extinction = material.scale * (material.sigma_a + (1.0 - material.g) * material.sigma_s);
  const double middle =
      std::max(std::min(extinction.x, extinction.y), std::min(std::max(extinction.x, extinction.y), extinction.z));
  return 1.0 / middle;
}

std::string named(Model model) {
  std::string name(name_of(model));
  std::ranges::replace(name, '_', ' ');
  name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
  return name;
}

Advice measured(Model model, double error, std::string_view shape, double radius) {
  return {model, error,
          fmt::format("{}: measured {:.2g} % off on {}, radius {:.2g} mean free paths.", named(model), error, shape,
                      radius)};
}

Model preferred() {
  const auto found = std::ranges::find_if(model_traits, [](const ModelTraits& traits) { return traits.preferred; });
  return static_cast<Model>(found - model_traits.begin());
}

}  // namespace

Shape shape_of(const Mesh& mesh, const glm::dmat3& to_world) {
  double volume = 0.0;
  double area = 0.0;
  const glm::dvec3 middle = 0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper()));
  const auto place = [&](std::uint32_t number) { return to_world * (glm::dvec3(mesh.positions()[number]) - middle); };
  for (const glm::uvec3& triangle : mesh.triangles()) {
    const glm::dvec3 a = place(triangle.x);
    const glm::dvec3 across = glm::cross(place(triangle.y) - a, place(triangle.z) - a);
    volume += glm::dot(a, across) / 6.0;
    area += 0.5 * glm::length(across);
  }
  return {std::abs(volume), area, is_closed(mesh)};
}

Advice advise(const Material& material, const Shape& shape) {
  const double radius = std::cbrt(0.75 * shape.volume / std::numbers::pi) / mean_free_path(material);
  if (!(radius > 0.0 && std::isfinite(radius) && shape.area > 0.0))
    return {preferred(), 0.0,
            fmt::format("{}: nothing was measured for what encloses no volume, or is empty.", named(preferred()))};
  if (shape.closed && material.sigma_s == glm::dvec3(0.0))
    return {Model::transport, 0.0,
            fmt::format("{}: nothing is scattered, and no other model shows what is behind a clear grain of any shape.",
                        named(Model::transport))};
  const double roundness = 36.0 * std::numbers::pi * shape.volume * shape.volume / std::pow(shape.area, 3.0);
  const bool round = roundness > automatic::roundest_other;
  if (round || radius > automatic::most_transported)
    for (const auto& [model, table] : automatic::of_round)
      if (const double error = error_at(table, radius); error <= automatic::tolerance)
        return measured(model, error, round ? "a sphere" : "a grain too thick for transport", radius);
  if (shape.closed && material.g > automatic::most_g)
    return {Model::transport, automatic::forwards_error,
            fmt::format("{}: light scatters forwards (g {:.2g}); measured {:.2g} % off on a grain of sand at g 0.85, "
                        "radius 3 mean free paths.",
                        named(Model::transport), material.g, automatic::forwards_error)};
  if (shape.closed) return measured(Model::transport, automatic::transport_error, "cube, flake and rice", radius);
  return {
      Model::model_3, automatic::model_3_error,
      fmt::format("{}: its mesh is open, which transport cannot take; measured {:.2g} % off on cube, flake and rice.",
                  named(Model::model_3), automatic::model_3_error)};
}

}  // namespace mesograin::scene
