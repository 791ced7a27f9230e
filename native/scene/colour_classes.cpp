// Splits the class that reaches farthest at the middle of its range, again and again.
#include "scene/colour_classes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

namespace mesograin::scene {
namespace {

constexpr float near_enough = 0.02F;  // from end to end of a class
constexpr float darkest = 1e-3F;      // below it factors are all alike
constexpr std::size_t dimensions = 9;

// Looks follow coefficients by their ratio, and reflectances by their difference.
using Features = std::array<float, dimensions>;

struct Class {
  std::vector<std::uint32_t> members;
  std::size_t widest = 0;  // of the dimensions
  float reach = 0.0F;
  float middle = 0.0F;
};

class Splitting {
 public:
  Splitting(const ColourFactors& factors, std::size_t count) : features_(count) {
    for (std::size_t i = 0; i < count; ++i)
      for (int channel = 0; channel < 3; ++channel) {
        const auto ratio = [&](const std::vector<glm::vec3>& of) {
          return of.empty() ? 0.0F : std::log(std::max(of[i][channel], darkest));
        };
        const auto at = static_cast<std::size_t>(channel);
        features_[i][at] = ratio(factors.sigma_a);
        features_[i][at + 3] = ratio(factors.sigma_s);
        features_[i][at + 6] = factors.reflectance.empty() ? 0.0F : factors.reflectance[i][channel];
      }
  }

  std::vector<Class> run(std::size_t most) const {
    std::vector<std::uint32_t> all(features_.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    std::vector<Class> classes{measured(std::move(all))};
    while (classes.size() < most) {
      const auto widest = std::max_element(classes.begin(), classes.end(),
                                           [](const Class& a, const Class& b) { return a.reach < b.reach; });
      if (widest->reach <= near_enough) break;
      const auto is_low = [&](std::uint32_t i) { return features_[i][widest->widest] < widest->middle; };
      std::vector<std::uint32_t> members = std::move(widest->members);
      const auto second = std::stable_partition(members.begin(), members.end(), is_low);
      std::vector<std::uint32_t> high(second, members.end());
      members.erase(second, members.end());
      *widest = measured(std::move(members));
      classes.push_back(measured(std::move(high)));
    }
    return classes;
  }

 private:
  Class measured(std::vector<std::uint32_t> members) const {
    Features lower;
    Features upper;
    lower.fill(std::numeric_limits<float>::max());
    upper.fill(-std::numeric_limits<float>::max());
    for (const std::uint32_t i : members)
      for (std::size_t d = 0; d < dimensions; ++d) {
        lower[d] = std::min(lower[d], features_[i][d]);
        upper[d] = std::max(upper[d], features_[i][d]);
      }
    Class found{std::move(members), 0, 0.0F, 0.0F};
    for (std::size_t d = 0; d < dimensions; ++d)
      if (upper[d] - lower[d] > found.reach) {
        found.widest = d;
        found.reach = upper[d] - lower[d];
        found.middle = 0.5F * (upper[d] + lower[d]);
      }
    return found;
  }

  std::vector<Features> features_;
};

glm::dvec3 mean(const std::vector<glm::vec3>& factors, const std::vector<std::uint32_t>& members) {
  if (factors.empty()) return glm::dvec3(1.0);
  glm::dvec3 sum(0.0);
  for (const std::uint32_t i : members) sum += glm::dvec3(factors[i]);
  return sum / static_cast<double>(members.size());
}

// Where tables depend on the grain's size, too, each size that has tables of its own has them for each colour.
std::size_t most_classes(const InstanceArray& array) {
  const ModelTraits& traits = traits_of(array.material.model);
  if (traits.mesh) return 8;
  if (!traits.grain_radius) return 32;
  double least = std::numeric_limits<double>::max();
  double most = 0.0;
  for (const glm::dmat4 place : array.object_to_world()) {
    const double volume = std::abs(glm::determinant(glm::dmat3(place)));
    least = std::min(least, volume);
    most = std::max(most, volume);
  }
  constexpr double sizes_an_octave = 8.0;
  const double sizes = 1.0 + sizes_an_octave * std::log2(std::cbrt(most / least));
  return static_cast<std::size_t>(std::clamp(64.0 / sizes, 4.0, 16.0));
}

}  // namespace

std::vector<InstanceArray> by_colour(const std::vector<InstanceArray>& arrays) {
  std::vector<InstanceArray> plain;
  for (const InstanceArray& array : arrays) {
    const Transforms& places = array.object_to_world();
    const ColourFactors& factors = array.factors();
    if (!factors.any() || places.empty()) {
      plain.push_back(array);
      continue;
    }
    for (const Class& one : Splitting(factors, places.size()).run(most_classes(array))) {
      Material material = array.material;
      material.sigma_a *= mean(factors.sigma_a, one.members);
      material.sigma_s *= mean(factors.sigma_s, one.members);
      material.reflectance = glm::min(material.reflectance * mean(factors.reflectance, one.members), glm::dvec3(1.0));
      plain.emplace_back(array.mesh, material, places.chosen(one.members));
    }
  }
  return plain;
}

}  // namespace mesograin::scene
