// What the lights make grains and walls send out: D of S = D + G S.
#pragma once

#include "heap/coefficients.h"
#include "heap/heap.h"

namespace mesograin::heap {

/// Adds what light does that comes straight from the lights, and from the world if that is an image, to `direct`; what
/// has gone through other grains on its way to `crossed`. `rays` of each grain, and of each node of walls,
/// to each light.
void add_direct_light(const Space& space, const Heap& heap, int rays, Field& direct, Field& crossed,
                      const transport::Effort& effort);

}  // namespace mesograin::heap
