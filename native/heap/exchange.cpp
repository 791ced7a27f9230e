// How finely, and one solution from nothing but what is sent.
#include "heap/exchange.h"

#include <algorithm>

#include "heap/solver.h"

namespace mesograin::heap {

Quality quality_for(std::size_t grains) {
  constexpr std::size_t most_links = 16'000'000;
  const auto each = static_cast<int>(most_links / std::max(grains, std::size_t{1}));
  Quality quality;
  // The noise of a grain's rays is seen where grains are few and large; there they cost no more than those of 10^4 do.
  constexpr std::size_t affordable = 10'000;
  constexpr std::size_t most = 8;
  const auto finer = static_cast<int>(std::clamp(affordable / std::max(grains, std::size_t{1}), std::size_t{1}, most));
  quality.rays *= finer;
  quality.light_rays *= finer;
  quality.seen_rays *= finer;
  quality.rays = std::clamp(each, coarse.rays, quality.rays);
  quality.light_rays = std::clamp(each, coarse.light_rays, quality.light_rays);
  quality.seen_rays = std::clamp(each / 2, coarse.seen_rays, quality.seen_rays);
  return quality;
}

HeapLight solve_exchange(const Heap& heap, const Quality& quality, const Field& before,
                         const transport::Effort& effort) {
  return Solver(before).solve(heap, quality, effort);
}

}  // namespace mesograin::heap
