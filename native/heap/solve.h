// Solves S = D + G S.
#pragma once

#include "heap/coefficients.h"
#include "heap/links.h"

namespace mesograin::heap {

struct Solved {
  Field sent;
  int steps = 0;
  float residual = 0.0F;  ///< the largest channel's, over D
};

/// From `guess`, which may be of any size, to a residual of `tolerance` of D.
Solved solve(const Links& links, const Field& direct, const Field& guess, float tolerance,
             const transport::Effort& effort);

}  // namespace mesograin::heap
