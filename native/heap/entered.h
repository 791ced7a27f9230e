// What an even world makes turbid grains send, but for what their surface reflects of it.
#pragma once

#include "heap/links.h"
#include "heap/moves.h"
#include "heap/packed_coefficients.h"
#include "transport/effort.h"

namespace mesograin::heap {

/// Of grains in seats of their own; empty where none is turbid. `radiance`: the world's. Throws transport::Stopped.
void find_entered(const Space& space, const Rays& rays, const glm::vec3& radiance, PackedField& entered,
                  const transport::Effort& effort);

/// The same where a few grains have moved, of those that see anything of it.
void renew_entered(const Space& space, const Moves& moves, const Rays& rays, const glm::vec3& radiance,
                   PackedField& entered, const transport::Effort& effort);

}  // namespace mesograin::heap
