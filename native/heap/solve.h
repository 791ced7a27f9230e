// Solves S = D + G S.
#pragma once

#include "heap/coefficients.h"
#include "heap/links.h"
#include "heap/sums.h"

namespace mesograin::heap {

struct Solved {
  Field sent;
  int steps = 0;
  float residual = 0.0F;          ///< the largest channel's, over D
  Field left{};                   ///< of each: D + G S - S
  bool summed_on_device = false;  ///< all sums were those that were made for it
};

/// When a solution will do.
struct Goal {
  float tolerance;     ///< for what is left, over D
  float share = 1.0F;  ///< and over what was left to begin with: of a change of few grains D does not tell
};

/// From `guess`, which may be of any size, to the `goal`. All fields as Seats tell them. `change`: as for
/// Links::gather(). `make_sums`: where there is one, its sums are taken as long as they can be.
Solved solve(const Links& links, const Change* change, const Field& direct, Field guess, const Goal& goal,
             const transport::Effort& effort, const MakeSums& make_sums = {});

}  // namespace mesograin::heap
