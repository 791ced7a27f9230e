// The numbers are those of docs/accuracy.md and docs/shapes.md: relative L1 against photons, in %.
#include "scene/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

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

/// Radii in mean free paths, with scattering reduced by g, of the channels that scatter.
std::vector<double> radii_of(const Material& material, double volume) {
  const double radius = std::cbrt(0.75 * volume / std::numbers::pi);
  const glm::dvec3 extinction = material.scale * (material.sigma_a + (1.0 - material.g) * material.sigma_s);
  std::vector<double> radii;
  for (int channel = 0; channel < 3; ++channel)
    if (material.sigma_s[channel] > 0.0) radii.push_back(radius * extinction[channel]);
  // What scatters nothing is as thick as it absorbs.
  if (radii.empty())
    for (int channel = 0; channel < 3; ++channel) radii.push_back(radius * extinction[channel]);
  std::ranges::sort(radii);
  return radii;
}

/// 1 for a sphere (the isoperimetric quotient).
double roundness(const Shape& shape) {
  return 36.0 * std::numbers::pi * shape.volume * shape.volume / std::pow(shape.area, 3.0);
}

/// In the mean of all channels, straight in the roundness between what was measured.
double error_of(const automatic::OfModel& model, const std::vector<double>& radii, double roundness) {
  constexpr double less_round = automatic::roundness_of_less_round, flat = automatic::roundness_of_flat;
  const double other = std::clamp((1.0 - roundness) / (1.0 - less_round), 0.0, 1.0);
  const double flatter = std::clamp((less_round - roundness) / (less_round - flat), 0.0, 1.0);
  double sum = 0.0;
  for (const double radius : radii) {
    const double of_less_round = error_at(model.less_round, radius);
    // Thinner flat grains were not measured: they are no nearer than others.
    const double of_flat = std::max(error_at(model.flat, radius), of_less_round);
    sum +=
        (1.0 - other) * error_at(model.round, radius) + other * ((1.0 - flatter) * of_less_round + flatter * of_flat);
  }
  return sum / static_cast<double>(radii.size());
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

Advice forwards(double g) {
  const automatic::Forwards* told =
      std::ranges::find_if(automatic::forwards, [&](const auto& entry) { return std::abs(g) <= entry.g; });
  if (told == automatic::forwards.end()) told = &automatic::forwards.back();
  return {
      Model::transport, told->error,
      fmt::format("{}: light scatters {} (g {:.2g}); measured {:.2g} % off on a grain of sand at g {:.2g}, radius 3 "
                  "mean free paths.",
                  named(Model::transport), g > 0.0 ? "forwards" : "backwards", g, told->error, told->g)};
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

Advice advise(const Material& material, const Shape& shape, double tolerance) {
  const std::vector<double> radii = radii_of(material, shape.volume);
  const double radius = radii[radii.size() / 2];
  if (!(radius > 0.0 && std::isfinite(radii.back()) && shape.area > 0.0))
    return {preferred(), 0.0,
            fmt::format("{}: nothing was measured for what encloses no volume, or is empty.", named(preferred()))};
  if (shape.closed && material.sigma_s == glm::dvec3(0.0))
    return {Model::transport, 0.0,
            fmt::format("{}: nothing is scattered, and no other model shows what is behind a clear grain of any shape.",
                        named(Model::transport))};
  const bool thick = radius > automatic::most_transported;
  const bool transported =
      shape.closed && radii.back() <= (thick ? automatic::all_transported : automatic::densest_transported);
  if (transported && std::abs(material.g) > automatic::most_g) return forwards(material.g);
  const double round = roundness(shape);
  const std::string_view told = round > 0.99 ? "a sphere" : "grains about as round";
  std::optional<Advice> nearest;
  for (const automatic::OfModel& model : automatic::of_models) {
    const double error = error_of(model, radii, round);
    if (error <= tolerance) return measured(model.model, error, told, radius);
    if (!nearest || error < nearest->error) nearest = measured(model.model, error, told, radius);
  }
  const std::string_view others = thick ? "five shapes of radius 20" : "cube, flake and rice";
  const double of_transport = thick ? automatic::thick_transport_error : automatic::transport_error;
  const double of_model_3 = thick ? automatic::thick_model_3_error : automatic::model_3_error;
  const Advice any_shape =
      transported ? measured(Model::transport, of_transport, others, radius)
                  : Advice{Model::model_3, of_model_3,
                           fmt::format("{}: {}, which transport cannot take; measured {:.2g} % off on {}.",
                                       named(Model::model_3), shape.closed ? "it is too thick" : "its mesh is open",
                                       of_model_3, others)};
  // Of shapes like a cube's the tables above say nothing beyond what is taken for near enough of any.
  const bool nearer = nearest->error <= automatic::tolerance && nearest->error < any_shape.error;
  return nearer && any_shape.error > tolerance ? *nearest : any_shape;
}

}  // namespace mesograin::scene
