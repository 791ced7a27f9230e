// Runs photons in batches on all cores; the spread between batches is the noise, and the answer depends on the seed
// alone.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "rng.h"

namespace mesograin::referee {

struct Estimate {
  double value = 0;
  double noise = 0;  ///< standard error of value
};

struct Effort {
  std::uint64_t photons = 1'000'000;
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: as many as the machine has
};

/// `trace(rng, photons, tally)` adds up `tally` (zeroed) over its photons; returned are the means per photon.
std::vector<Estimate> run_batches(const Effort& effort, std::size_t tally_size,
                                  const std::function<void(Rng&, std::uint64_t, std::span<double>)>& trace);

}  // namespace mesograin::referee
