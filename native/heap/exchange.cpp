// Tables, rays, solution.
#include "heap/exchange.h"

#include "heap/direct_light.h"
#include "heap/links.h"
#include "heap/solve.h"

namespace mesograin::heap {

HeapLight solve_exchange(const Heap& heap, const Quality& quality, const Field& before,
                         const transport::Effort& effort) {
  HeapLight light;
  light.kinds = kinds_of(heap.grains, transport::part_of(effort, 0.0, 0.1));
  const Space space(heap.grains, light.kinds);
  const glm::vec3 radiance(heap.world.image ? glm::dvec3(0.0) : heap.world.radiance);
  WorldLit lit;
  const Links links = find_links(space, quality.rays, radiance, lit, transport::part_of(effort, 0.1, 0.5));
  add_direct_light(space, heap, quality.light_rays, lit.direct, lit.crossed, transport::part_of(effort, 0.5, 0.7));
  Field first(lit.direct.size());
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = lit.direct[i] + lit.crossed[i];
  Solved solved = solve(links, first, before, quality.tolerance, transport::part_of(effort, 0.7, 0.9));
  light.answer.resize(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) light.answer[i] = solved.sent[i] - lit.direct[i];
  light.behind = seen_through(space, solved.sent, quality.seen_rays, transport::part_of(effort, 0.9, 1.0));
  light.sent = std::move(solved.sent);
  light.steps = solved.steps;
  light.residual = solved.residual;
  return light;
}

}  // namespace mesograin::heap
