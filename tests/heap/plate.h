// A clear plate as a grain, which is no ball: what is known of one exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "heap/facet_walk.h"
#include "heap/heap.h"

namespace mesograin::heap {

inline constexpr float half_thickness = 0.05F;
inline const glm::vec3 up(0.0F, 0.0F, 1.0F);

/// Between two planes, with nothing else around.
class Plate : public Facets {
 public:
  /// `flat`: its surfaces are told to be.
  explicit Plate(const Finish& finish, bool flat = false) : finish_(finish), flat_(flat) {}

  std::optional<Meeting> inside(std::uint32_t grain, const glm::vec3& origin,
                                const glm::vec3& direction) const override {
    constexpr float level = 1e-6F;
    if (std::abs(direction.z) < level) return std::nullopt;
    const float side = std::copysign(1.0F, direction.z);
    const float distance = std::max((side * half_thickness - origin.z) / direction.z, 0.0F);
    return Meeting{false, grain, origin + distance * direction, side * up, flat_};
  }
  std::optional<Meeting> beyond(std::uint32_t, const glm::vec3&, const glm::vec3&) const override {
    return std::nullopt;
  }
  Finish finish(std::uint32_t) const override { return finish_; }

 private:
  Finish finish_;
  bool flat_;
};

inline Heap plate() {
  Heap heap;
  Optics glass;
  glass.surface = Surface::dielectric;
  glass.eta = 1.5;
  glass.sigma_t = glm::dvec3(0.4);
  glass.albedo = glm::dvec3(1.0);
  heap.grains.kinds = {glass};
  heap.grains.grains = {{glm::vec3(0.0F), 1.0F, 0}};
  return heap;
}

}  // namespace mesograin::heap
