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
  Quality quality;
  const int finer = finer_for(grains, 8);
  quality.rays *= finer;
  quality.light_rays *= finer;
  quality.seen_rays *= finer;
  return quality;
}

Quality affordable(const Quality& quality, std::size_t seats, std::size_t sharing) {
  constexpr std::size_t most_links = 15'000'000;
  constexpr std::size_t most_of_sharing = most_links / 4;
  // Fewer tell too little of a cell's light.
  constexpr int fewest_of_sharing = 12;
  Quality result = quality;
  result.sharing_rays = std::clamp(static_cast<int>(most_of_sharing / std::max(sharing, std::size_t{1})),
                                   std::min(fewest_of_sharing, quality.sharing_rays), quality.sharing_rays);
  const std::size_t links_of_sharing = sharing * static_cast<std::size_t>(result.sharing_rays);
  const std::size_t left = most_links - std::min(links_of_sharing, most_links);
  const auto each = static_cast<int>(left / std::max(seats, std::size_t{1}));
  result.rays = std::clamp(each, std::min(coarse.rays, quality.rays), quality.rays);
  result.light_rays = std::clamp(each, std::min(coarse.light_rays, quality.light_rays), quality.light_rays);
  result.seen_rays = std::clamp(each / 2, std::min(coarse.seen_rays, quality.seen_rays), quality.seen_rays);
  return result;
}

Quality coarse_for(std::size_t grains) {
  Quality quality = coarse;
  quality.rays *= finer_for(grains, 3);
  return quality;
}

HeapLight light_alone(const Heap& heap, const transport::Effort& effort) {
  // What goes straight through a grain asks for no walks.
  constexpr int walks = GrainTable::outcomes;
  HeapLight light;
  light.kinds = kinds_of(heap.grains.kinds, walks, effort);
  light.seats = std::make_shared<const Seats>(heap.grains.grains.size());
  light.patches = patches_about(heap.grains);
  return light;
}

HeapLight solve_exchange(const Heap& heap, const Quality& quality, const Field& before,
                         const transport::Effort& effort) {
  return Solver(before).solve(heap, quality, effort);
}

}  // namespace mesograin::heap
