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
  void add(const ColourFactors& factors, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      Features& features = features_.emplace_back();
      for (int channel = 0; channel < 3; ++channel) {
        const auto ratio = [&](const std::vector<glm::vec3>& of) {
          return of.empty() ? 0.0F : std::log(std::max(of[i][channel], darkest));
        };
        const auto at = static_cast<std::size_t>(channel);
        features[at] = ratio(factors.sigma_a);
        features[at + 3] = ratio(factors.sigma_s);
        features[at + 6] = factors.reflectance.empty() ? 0.0F : factors.reflectance[i][channel];
      }
    }
  }

  /// Of instances numbered as they were added.
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

/// Arrays of grains of one material, whatever their meshes, with the instances of all numbered through.
struct Alike {
  std::vector<const InstanceArray*> arrays;
  std::vector<std::size_t> ends;  ///< of each array's numbers
};

std::vector<Alike> alike(const std::vector<InstanceArray>& arrays) {
  std::vector<Alike> found;
  for (const InstanceArray& array : arrays) {
    if (!array.factors().any() || array.object_to_world().empty()) continue;
    auto same = std::ranges::find_if(
        found, [&](const Alike& others) { return others.arrays.front()->material == array.material; });
    if (same == found.end()) same = found.insert(found.end(), Alike{});
    same->ends.push_back((same->ends.empty() ? 0 : same->ends.back()) + array.object_to_world().size());
    same->arrays.push_back(&array);
  }
  return found;
}

/// Of all members; those of an array without such factors count as 1.
glm::dvec3 mean(const Alike& of, const std::vector<std::uint32_t>& members,
                std::vector<glm::vec3> ColourFactors::*which) {
  glm::dvec3 sum(0.0);
  for (const std::uint32_t member : members) {
    const std::size_t array = static_cast<std::size_t>(std::ranges::upper_bound(of.ends, member) - of.ends.begin());
    const std::vector<glm::vec3>& factors = of.arrays[array]->factors().*which;
    sum += factors.empty() ? glm::dvec3(1.0) : glm::dvec3(factors[member - (array == 0 ? 0 : of.ends[array - 1])]);
  }
  return sum / static_cast<double>(members.size());
}

// Where tables depend on the grain's size, too, each size that has tables of its own has them for each colour.
std::size_t most_classes(const Alike& of) {
  const ModelTraits& traits = traits_of(of.arrays.front()->material.model);
  if (traits.mesh) return 8;
  if (!traits.grain_radius) return 32;
  double least = std::numeric_limits<double>::max();
  double most = 0.0;
  for (const InstanceArray* array : of.arrays)
    for (const glm::dmat4 place : array->object_to_world()) {
      const double radius = array->mesh->equivalent_radius() * std::cbrt(std::abs(glm::determinant(glm::dmat3(place))));
      least = std::min(least, radius);
      most = std::max(most, radius);
    }
  constexpr double sizes_an_octave = 8.0;
  const double sizes = 1.0 + sizes_an_octave * std::log2(most / least);
  return static_cast<std::size_t>(std::clamp(64.0 / sizes, 4.0, 16.0));
}

}  // namespace

std::vector<InstanceArray> by_colour(const std::vector<InstanceArray>& arrays) {
  std::vector<InstanceArray> plain;
  for (const InstanceArray& array : arrays)
    if (!array.factors().any() || array.object_to_world().empty()) plain.push_back(array);
  for (const Alike& of : alike(arrays)) {
    Splitting splitting;
    for (const InstanceArray* array : of.arrays) splitting.add(array->factors(), array->object_to_world().size());
    for (Class& one : splitting.run(most_classes(of))) {
      Material material = of.arrays.front()->material;
      material.sigma_a *= mean(of, one.members, &ColourFactors::sigma_a);
      material.sigma_s *= mean(of, one.members, &ColourFactors::sigma_s);
      material.reflectance =
          glm::min(material.reflectance * mean(of, one.members, &ColourFactors::reflectance), glm::dvec3(1.0));
      std::ranges::sort(one.members);
      auto member = one.members.begin();
      for (std::size_t array = 0; array < of.arrays.size(); ++array) {
        const auto first = static_cast<std::uint32_t>(array == 0 ? 0 : of.ends[array - 1]);
        std::vector<std::uint32_t> own;
        for (; member != one.members.end() && *member < of.ends[array]; ++member) own.push_back(*member - first);
        if (!own.empty())
          plain.emplace_back(of.arrays[array]->mesh, material, of.arrays[array]->object_to_world().chosen(own));
      }
    }
  }
  return plain;
}

}  // namespace mesograin::scene
