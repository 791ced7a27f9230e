// How finely, and one solution from nothing but what is sent.
#include "heap/exchange.h"

#include <algorithm>

#include "heap/solver.h"

namespace mesograin::heap {

namespace {

/// How many times as many rays, `most` at the most, so many grains can have: the noise of a grain's rays is seen where
/// grains are few and large; there they cost no more than those of 10^4 do.
int finer_for(std::size_t grains, std::size_t most) {
  constexpr std::size_t affordable = 10'000;
  return static_cast<int>(std::clamp(affordable / std::max(grains, std::size_t{1}), std::size_t{1}, most));
}

}  // namespace

Quality quality_for(std::size_t grains) {
  constexpr std::size_t most_links = 16'000'000;
  const auto each = static_cast<int>(most_links / std::max(grains, std::size_t{1}));
  Quality quality;
  const int finer = finer_for(grains, 8);
  quality.rays *= finer;
  quality.light_rays *= finer;
  quality.seen_rays *= finer;
  quality.rays = std::clamp(each, coarse.rays, quality.rays);
  quality.light_rays = std::clamp(each, coarse.light_rays, quality.light_rays);
  quality.seen_rays = std::clamp(each / 2, coarse.seen_rays, quality.seen_rays);
  return quality;
}

Quality coarse_for(std::size_t grains) {
  Quality quality = coarse;
  quality.rays *= finer_for(grains, 3);
  return quality;
}

HeapLight solve_exchange(const Heap& heap, const Quality& quality, const Field& before,
                         const transport::Effort& effort) {
  return Solver(before).solve(heap, quality, effort);
}

}  // namespace mesograin::heap
