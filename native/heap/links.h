// Which grains and walls send light to which: G of S = D + G S, as the rays it was found by.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "heap/coefficients.h"
#include "heap/heap.h"
#include "heap/lit.h"
#include "heap/packed.h"

namespace mesograin::heap {

class Moves;

/// A ray that leaves a grain at a normal (GrainTable::seen_place) because of light that another one sent out at one of
/// its own; of a node of walls, which sends out the same at every normal, it is 0.
struct Link {
  std::uint32_t from;
  PackedPlace sent_at;
  PackedPlace leaves_at;
  PackedWeight weight;
};

/// What light does at other materials that goes the same ways.
struct Change {
  std::vector<glm::vec3> answered;  ///< how much more each sends out of what comes to it; empty: just as much
  std::vector<glm::vec3> received;  ///< how much more comes to others of what each sends out
};

/// Of each grain in a seat of its own, the share of the world in what is seen through it unscattered: straight, by
/// look_through(), or refracted, by GrainTable::seen_place(), as what it sends out is told.
using Openness = std::vector<Share>;

/// Of a clear grain: how many of its links, the first, are of light that it has scattered; by which sum of the numbers
/// that tell a place to weigh them, so that in even light it is scattered evenly; and how much of light from everywhere
/// would leave it, so weighed, by all looks that were scattered.
struct Scattering {
  std::uint32_t links = 0;
  std::array<float, 9> even{};
  glm::vec3 share{0.0F};
};

struct Links {
  std::vector<std::vector<Link>> of;  ///< each that answers: grains in their seats, then nodes of walls
  std::vector<bool> fine;             ///< of each, whether it is told to order 2; empty: none is
  Openness open;                      ///< of what the looks that were followed let through
  std::shared_ptr<const Seats> seats;
  /// Of each; empty: none is clear.
  std::vector<Scattering> scattered;

  std::size_t count() const;

  /// What light sent out by others makes the grains send out, as Seats tell it. `change`: since the links were found;
  /// or null.
  void gather(const Field& sent, Field& answer, const transport::Effort& effort, const Change* change = nullptr) const;

  /// Of that, what clear grains have scattered, of each that answers.
  void gather_scattered(const Field& sent, Field& answer, const transport::Effort& effort,
                        const Change* change = nullptr) const;
};

/// Of each grain, whether it lies deep; empty: none does.
using Deep = std::shared_ptr<const std::vector<bool>>;

/// How many rays leave each.
struct Rays {
  int of_grain;
  int of_node;      ///< of walls
  int of_deep = 0;  ///< of grains that lie deep
  Deep deep{};
  std::size_t own = std::numeric_limits<std::size_t>::max();  ///< how many have a seat of their own
  int of_sharing = 0;                                         ///< of the others

  int of(std::size_t answering) const {
    if (deep && (*deep)[answering]) return of_deep;
    return answering < own ? of_grain : of_sharing;
  }

  /// Whether they tell of a grain or node to order 2: order 1 leaves 4 % in a heap of bright opaque balls, whose light
  /// changes at contacts, and a fifth too much light in one of clear glass under a sun, which goes on forward; of
  /// others order 2 tells no more, and few rays tell nothing of it.
  bool fine(const Space& space, std::size_t number) const;
};

/// Grains that no light leaves the heap from but by way of more than `ways` others, as far as a few rays of each tell.
Deep find_deep(const Space& space, int ways, const transport::Effort& effort);

/// By what four numbers know a look straight through a ball, at a normal and from a direction: halfway between that
/// direction and the place, seen from behind, where the look leaves the ball; of all looks spread evenly. As
/// shaders/heap/light_from_grains.glsl has it.
glm::vec3 look_through(const glm::vec3& normal, const glm::vec3& towards);

struct Ways {
  Links links;
  Links behind;  ///< what is seen straight through transparent grains, by look_through(): 0 where no grain stands there
  Lit world;     ///< what light does that comes from outside the heap
};

/// `radiance` from outside the heap wherever a ray leaves it. `ways`: none, or those of fewer rays of the same seats,
/// told as finely, which make way one by one: where this is given up, they are partly the old ones.
void find_ways(const Space& space, const Rays& rays, const Rays& rays_through, const glm::vec3& radiance, Ways& ways,
               const transport::Effort& effort);

/// Finds what a change of places may touch again, to the last bit as it is found from nothing in `space`. `ways`: those
/// of the space before, found with as many rays; left as they are until all is found. Returns of how many grains and
/// nodes there was something to find.
std::size_t renew(const Space& space, const Moves& moves, const Rays& rays, const Rays& rays_through,
                  const glm::vec3& radiance, Ways& ways, const transport::Effort& effort);

}  // namespace mesograin::heap
