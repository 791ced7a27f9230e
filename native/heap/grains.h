// The grains of a heap as light between them sees them: spheres, each of a kind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "heap/optics.h"

namespace mesograin::heap {

struct Grain {
  glm::vec3 middle;  ///< from a place amid the heap
  float radius;
  std::uint32_t kind;  ///< which of Grains::kinds

  bool operator==(const Grain&) const = default;
};

struct Grains {
  std::vector<Grain> grains;
  std::vector<Optics> kinds;

  /// The number of a kind of these optics, added if there is none.
  std::uint32_t kind(const Optics& optics);

  bool operator==(const Grains&) const = default;
};

/// Which grain a ray meets, and where.
struct Meeting {
  std::uint32_t grain;
  glm::vec3 normal;  ///< outwards; the place is the grain's middle + radius * normal
};

/// The grains as rays find them (Embree). Places in it come from Grains.
class Neighbourhood {
 public:
  explicit Neighbourhood(const Grains& grains);

  /// The first grain that a ray comes to from outside; grains that it starts in are not met.
  bool first(const glm::vec3& origin, const glm::vec3& direction, Meeting& meeting) const;

 private:
  struct Device;
  std::shared_ptr<const Device> device_;
};

}  // namespace mesograin::heap
