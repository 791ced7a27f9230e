// Batches are handed to threads as they come free, each with a random stream of its own, and are summed in their order.
#include "batches.h"

#include <algorithm>
#include <cmath>

#include "parallel.h"

namespace mesograin::referee {

std::vector<Estimate> run_batches(const Effort& effort, std::size_t tally_size,
                                  const std::function<void(Rng&, std::uint64_t, std::span<double>)>& trace) {
  constexpr std::uint64_t batch_count = 64;
  const std::uint64_t photons = std::max<std::uint64_t>(1, effort.photons / batch_count);
  std::vector<std::vector<double>> batches(batch_count);
  parallel(batch_count, effort.threads, [&](std::size_t batch) {
    std::vector<double> tally(tally_size,
                              0.0);  // made by its own thread, so that no two threads write to one cache line
    Rng rng(effort.seed, batch);
    trace(rng, photons, tally);
    batches[batch] = std::move(tally);
  });

  std::vector<Estimate> estimates(tally_size);
  for (std::size_t i = 0; i < tally_size; ++i) {
    double sum = 0;
    for (const auto& batch : batches) sum += batch[i];
    const double mean = sum / batch_count;
    double spread = 0;
    for (const auto& batch : batches) spread += (batch[i] - mean) * (batch[i] - mean);
    const double per_photon = 1 / static_cast<double>(photons);
    estimates[i] = {mean * per_photon, std::sqrt(spread / (batch_count * (batch_count - 1.0))) * per_photon};
  }
  return estimates;
}

}  // namespace mesograin::referee
