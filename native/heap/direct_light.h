// What the lights make grains and walls send out: D of S = D + G S.
#pragma once

#include "heap/coefficients.h"
#include "heap/heap.h"
#include "heap/links.h"
#include "heap/lit.h"

namespace mesograin::heap {

/// What light does that comes straight from the lights, and from the world if that is an image. `rays` to each
/// light. `lit`: as large as the space; where there are `moves`, what was found before
/// them, of which only what they touch is found again.
void find_direct_light(const Space& space, const Heap& heap, const Rays& rays, const Moves* moves, Lit& lit,
                       const transport::Effort& effort);

}  // namespace mesograin::heap
