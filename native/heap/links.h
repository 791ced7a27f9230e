// Which grains and walls send light to which: G of S = D + G S, as the rays it was found by.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "heap/coefficients.h"
#include "heap/heap.h"

namespace mesograin::heap {

/// A ray that leaves a grain at a normal (GrainTable::seen_place) because of light that another one sent out at one of
/// its own; of a node of walls, which sends out the same at every normal, it is 0.
struct Link {
  std::uint32_t from;
  std::int16_t sent_at[3];
  std::int16_t leaves_at[3];
  float weight[3];
};

struct Links {
  std::vector<std::size_t> first;  ///< of each grain, then of each node of walls, and one past the last
  std::vector<Link> links;

  /// What light sent out by others makes the grains send out.
  void gather(const Field& sent, Field& answer, const transport::Effort& effort) const;
};

/// What leaves grains and walls because of an even world: without and with other grains on the way.
struct WorldLit {
  Field direct;
  Field crossed;
};

/// How many rays leave each.
struct Rays {
  int of_grain;
  int of_node;  ///< of walls
};

/// `radiance` from outside the heap wherever a ray leaves
/// it.
Links find_links(const Space& space, const Rays& rays, const glm::vec3& radiance, WorldLit& lit,
                 const transport::Effort& effort);

/// By what four numbers know a look straight through a ball, at a normal and from a direction: halfway between that
/// direction and the place, seen from behind, where the look leaves the ball; of all looks spread evenly. As
/// shaders/heap/light_from_grains.glsl has it.
glm::vec3 look_through(const glm::vec3& normal, const glm::vec3& towards);

/// The light that is seen straight through transparent grains, by look_through(): what others send, 0 where no grain
/// stands behind.
Links find_behind(const Space& space, int rays, const transport::Effort& effort);

}  // namespace mesograin::heap
