// Sizes by steps of an octave; stretches by how near they are to one that came before.
#include "render/instance_classes.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <limits>
#include <map>

#include "models/prototype_inputs.h"

namespace mesograin::render {
namespace {

// Sizes to an octave that have tables of their own; an instance takes one of the two nearest, so that on average all is
// as for its own size.
constexpr double sizes_an_octave = 8.0;

// Sizes within this ratio are one.
constexpr double same_size = 1.01;

// Stretches nearer than this share a prototype; beyond so many kinds the nearest will do.
constexpr double same_stretch = 0.05;
constexpr std::size_t most_stretches = 8;

// In [0, 1), of an instance's number alone (the golden ratio's additive recurrence).
double random_of(std::size_t number) {
  constexpr double golden = 0.61803398874989484820;
  const double product = golden * static_cast<double>(number + 1);
  return product - std::floor(product);
}

double scale_of(const glm::dmat4& object_to_world) {
  return std::max(std::cbrt(std::abs(glm::determinant(glm::dmat3(object_to_world)))), 1e-100);
}

// Steps are of the grain's radius, not of how its mesh was scaled: meshes of a heap share their tables.
std::vector<InstanceClass> by_size(const scene::InstanceArray& array) {
  const std::size_t count = array.object_to_world().size();
  const double radius = std::max(array.mesh->equivalent_radius(), 1e-100);
  double least = std::numeric_limits<double>::max();
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    least = std::min(least, scale_of(array.object_to_world()[i]));
    most = std::max(most, scale_of(array.object_to_world()[i]));
  }
  if (most <= same_size * least) {
    InstanceClass all{std::sqrt(least * most), glm::dmat3(1.0), {}};
    for (std::size_t i = 0; i < count; ++i) all.members.push_back(i);
    return {all};
  }
  std::map<int, std::vector<std::size_t>> sizes;
  for (std::size_t i = 0; i < count; ++i)
    sizes[static_cast<int>(
              std::floor(sizes_an_octave * std::log2(radius * scale_of(array.object_to_world()[i])) + random_of(i)))]
        .push_back(i);
  std::vector<InstanceClass> classes;
  classes.reserve(sizes.size());
  for (auto& [size, members] : sizes)
    classes.push_back({std::exp2(size / sizes_an_octave) / radius, glm::dmat3(1.0), std::move(members)});
  return classes;
}

double difference(const glm::dmat3& a, const glm::dmat3& b) {
  double squares = 0.0;
  for (int i = 0; i < 3; ++i) squares += glm::dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(squares);
}

// Tables of this kind take seconds: an octave shares them, about the size that half of the instances exceed, which
// instances of one size all have.
std::vector<InstanceClass> by_stretch(const scene::InstanceArray& array) {
  std::vector<InstanceClass> shapes;
  for (std::size_t i = 0; i < array.object_to_world().size(); ++i) {
    const glm::dmat4 object_to_world = array.object_to_world()[i];
    const glm::dmat3 shape = models::turn_and_stretch(glm::dmat3(object_to_world)).stretch / scale_of(object_to_world);
    const auto nearest =
        std::min_element(shapes.begin(), shapes.end(), [&](const InstanceClass& a, const InstanceClass& b) {
          return difference(a.stretch, shape) < difference(b.stretch, shape);
        });
    if (nearest == shapes.end() ||
        (difference(nearest->stretch, shape) > same_stretch && shapes.size() < most_stretches))
      shapes.push_back({1.0, shape, {i}});
    else
      nearest->members.push_back(i);
  }
  std::vector<InstanceClass> classes;
  for (const InstanceClass& shape : shapes) {
    std::vector<double> scales;
    for (const std::size_t member : shape.members) scales.push_back(scale_of(array.object_to_world()[member]));
    const auto middle = scales.begin() + static_cast<std::ptrdiff_t>(scales.size() / 2);
    std::nth_element(scales.begin(), middle, scales.end());
    const double median = *middle;
    std::map<int, std::vector<std::size_t>> octaves;
    for (const std::size_t member : shape.members)
      octaves[static_cast<int>(std::round(std::log2(scale_of(array.object_to_world()[member]) / median)))].push_back(
          member);
    for (auto& [octave, members] : octaves) {
      const double scale = std::exp2(octave) * median;
      classes.push_back({scale, scale * shape.stretch, std::move(members)});
    }
  }
  return classes;
}

}  // namespace

std::vector<InstanceClass> instance_classes(const scene::InstanceArray& array) {
  const scene::ModelTraits& traits = scene::traits_of(array.material.model);
  if (traits.mesh) return by_stretch(array);
  if (traits.grain_radius) return by_size(array);
  InstanceClass all;
  for (std::size_t i = 0; i < array.object_to_world().size(); ++i) all.members.push_back(i);
  return {all};
}

}  // namespace mesograin::render
