// Positions are sorted into cells as wide as the tolerance.
#include "scene/welding.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace mesograin::scene {

std::vector<std::uint32_t> welded(const Mesh& mesh, double tolerance) {
  const double cell = tolerance * std::max(mesh.reach(), 1e-300);
  std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, std::uint32_t> known;
  std::vector<std::uint32_t> numbers;
  numbers.reserve(mesh.positions().size());
  const glm::dvec3 middle = 0.5 * (glm::dvec3(mesh.lower()) + glm::dvec3(mesh.upper()));
  for (const glm::vec3& position : mesh.positions()) {
    const glm::dvec3 place = (glm::dvec3(position) - middle) / cell;
    numbers.push_back(known
                          .try_emplace({std::llround(place.x), std::llround(place.y), std::llround(place.z)},
                                       static_cast<std::uint32_t>(known.size()))
                          .first->second);
  }
  return numbers;
}

}  // namespace mesograin::scene
