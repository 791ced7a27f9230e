// What hangs together, found by joining two at a time (Tarjan 1975).
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace mesograin::scene {

class Pieces {
 public:
  explicit Pieces(std::size_t things) : parents_(things) { std::iota(parents_.begin(), parents_.end(), 0U); }

  void join(std::uint32_t a, std::uint32_t b) { parents_[of(a)] = of(b); }

  /// The same number for all that hang together, that of one of them.
  std::uint32_t of(std::uint32_t thing) {
    while (parents_[thing] != thing) thing = parents_[thing] = parents_[parents_[thing]];
    return thing;
  }

 private:
  std::vector<std::uint32_t> parents_;
};

}  // namespace mesograin::scene
