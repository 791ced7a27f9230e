// One walk of light through a spherical grain, from where it comes in to where it leaves.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>

#include "heap/optics.h"
#include "transport/random.h"

namespace mesograin::heap {

/// Light as it leaves the unit sphere around the origin.
struct Outcome {
  glm::vec3 normal;        ///< where; also the place
  glm::vec3 direction;     ///< whereto
  glm::vec3 weight;        ///< linear RGB, of what came in
  bool refracted = false;  ///< through a surface that refracts, and scattered nowhere
  bool scattered = false;  ///< below a surface that refracts

  /// Whether it is no light that a surface which refracts has reflected.
  bool entered() const { return refracted || scattered; }
};

/// Which way light is followed: the same but where what enters and what leaves meet different surfaces.
enum class Sense { from_light, from_viewer };

/// Follows what comes in at (0, 0, 1), travelling along (sine, 0, -mu). Light that a transparent grain did not scatter
/// is left out: what is followed are walks that were scattered, each weighed by how likely that was. Nothing, where all
/// was absorbed.
/// `scattered` is told of every scattering: where, the direction before, and the weight after it.
using Scattered = std::function<void(const glm::vec3& place, const glm::vec3& direction, const glm::vec3& weight)>;
std::optional<Outcome> walk(const Optics& optics, Sense sense, float mu, transport::Random& random,
                            const Scattered& scattered = {});

}  // namespace mesograin::heap
