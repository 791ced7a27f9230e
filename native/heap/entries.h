// Where light came into a grain that leaves it at a place towards a viewer: a shadow belongs there.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

#include "heap/sphere_walk.h"

namespace mesograin::heap {

/// Of a unit sphere: equally likely entries for each bin of how the light, the normal where it leaves and the viewer
/// lie. As shaders/models/entries.glsl reads them.
class Entries {
 public:
  static constexpr int angles = 12;   ///< between normal and light, from 0 to pi
  static constexpr int cosines = 4;   ///< of the viewer, squared, from 0 to 1
  static constexpr int azimuths = 4;  ///< between light and viewer about the normal, from 0 to pi
  static constexpr int each = 32;     ///< of each bin
  static constexpr std::size_t bins = std::size_t{angles} * cosines * azimuths;

  /// A walk of light that came in at the cosine `mu`, in the frame of sphere_walk.h.
  struct Passage {
    float mu;
    Outcome outcome;
  };

  Entries() = default;
  explicit Entries(const std::vector<Passage>& passages);

  /// Seen from the light, from the place where light leaves to where it came in: x away from below the light, y to the
  /// viewer's side; bins * each, in each bin by x, or none.
  const std::vector<glm::vec2>& offsets() const { return offsets_; }

  /// Of a normal, a direction to a light and one to a viewer.
  static std::size_t bin(const glm::vec3& normal, const glm::vec3& to_light, const glm::vec3& to_viewer);

 private:
  std::vector<glm::vec2> offsets_;
};

}  // namespace mesograin::heap
