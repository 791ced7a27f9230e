// Light from grain to grain: what each grain of a heap sends out because of what the others send (Moon, Walter and
// Marschner 2007, "Rendering discrete random media using precomputed scattering solutions", for paths; here solved for
// all grains at once).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "heap/coefficients.h"
#include "heap/heap.h"
#include "heap/packed_coefficients.h"

namespace mesograin::heap {

/// How much work goes into it.
struct Quality {
  int rays = 128;       ///< from each grain to others
  int wall_rays = 256;  ///< from each node of walls
  int light_rays = 64;  ///< to each light
  int seen_rays = 64;   ///< straight through each transparent grain
  float tolerance = 3e-4F;
  int walks = GrainTable::most_walks;       ///< for each interval of a kind's table, where kinds are few
  bool quick = false;                       ///< links that were found at other materials will do
  int deep_rays = 16;                       ///< of each kind, of grains that lie deep in a heap of many
  int sharing_rays = 36;                    ///< of each kind, of each of the few that answer for all that share numbers
  std::size_t shared_from = 50'000;         ///< as many grains or more share numbers where they lie deep
  std::size_t clear_shared_from = 250'000;  ///< some of them clear: few rays tell too little of what those scatter
};

/// Where there are few grains, finer than the default, but with no more rays in all than 10^4 grains have there.
Quality quality_for(std::size_t grains);

/// As fine as the memory for so many seats allows, and so many more that answer for those that share: a quarter of a
/// gigabyte for links.
Quality affordable(const Quality& quality, std::size_t seats, std::size_t sharing = 0);

/// For a first picture of 10^4 grains or more.
inline constexpr Quality coarse{.rays = 16,
                                .wall_rays = 32,
                                .light_rays = 24,
                                .seen_rays = 8,
                                .tolerance = 5e-3F,
                                .walks = 512,
                                .quick = true,
                                .sharing_rays = 8};

/// For a first picture of so many: within a tenth of what the default finds.
Quality coarse_for(std::size_t grains);

/// How often each part of a solution was found anew.
struct Parts {
  int tables = 0;
  int links = 0;
  int sources = 0;  ///< each light counts
  int solutions = 0;
  std::size_t renewed = 0;  ///< grains and nodes whose links were found again because a few grains had moved
};

/// As `seats` tell it, grains and then nodes of the walls. Radiance that leaves a grain at a normal and a
/// cosine: that of `answer` times the lobe of its kind's table, and that of `behind` times what crosses the grain
/// there.
struct HeapLight {
  Field answer;   ///< exitance over pi, but for what answers to light that comes straight from a light
  Field crossed;  ///< of `answer`: what comes from lights straight through others, but from no even world
  Field behind;   ///< of grains only: what is seen through a transparent one, by look_through()
  /// Of grains in seats of their own only: how much of the world is seen through one that lets light through
  /// unscattered, by look_through() or, refracted, by the place that tells `answer`.
  std::vector<Share> open;
  SharedField sent;  ///< exitance over pi because of all light, to begin the next solution from
  std::shared_ptr<const Seats> seats;
  /// Of clear grains: what they have scattered of `sent`, over the share of light that they scatter, and what of that
  /// answers to what others send; empty where none is clear.
  Field scattered;
  Field scattered_answer;
  /// Of turbid grains in seats of their own, to order 2: what of `sent` lights make them send, but for what their
  /// surface reflects of these; at the places that GrainTable::entered() has. Empty where none is turbid.
  PackedField entered;
  Patches patches;
  std::optional<Neighbourhood> neighbourhood{};  ///< of its grains, where they were not moved since
  std::vector<Kind> kinds;                       ///< what each is to the others
  std::vector<Kind> seen_kinds;                  ///< what is seen of it, where that is something else; or empty
  std::size_t links = 0;
  int steps = 0;
  float residual = 0.0F;
  bool summed_on_device = false;  ///< as Solved has it
  double milliseconds = 0.0;
  Parts parts;  ///< since its solver began
};

/// What is seen of grains, by kind.
inline const std::vector<Kind>& seen_kinds(const HeapLight& light) {
  return light.seen_kinds.empty() ? light.kinds : light.seen_kinds;
}

/// Of a heap that exchanges none: what rays must know of its grains, and nothing that any sends. Throws
/// transport::Stopped.
HeapLight light_alone(const Heap& heap, const transport::Effort& effort);

/// `before` may be a solution for other lights, materials or places. Throws transport::Stopped.
HeapLight solve_exchange(const Heap& heap, const Quality& quality, const Field& before,
                         const transport::Effort& effort);

}  // namespace mesograin::heap
