// One solution from nothing but what is sent.
#include "heap/exchange.h"

#include "heap/solver.h"

namespace mesograin::heap {

HeapLight solve_exchange(const Heap& heap, const Quality& quality, const Field& before,
                         const transport::Effort& effort) {
  return Solver(before).solve(heap, quality, effort);
}

}  // namespace mesograin::heap
