// Grains that come into a closed mesh as others make room for them below.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "pile/room.h"
#include "pile/start.h"

namespace mesograin::pile {

class Pouring {
 public:
  /// `waiting`: grains of which nothing but size and shape is known. Throws Error if none of them fits.
  Pouring(std::vector<Grain> waiting, const Triangles& surface, std::uint64_t seed);

  /// Adds those for which there is a free place; returns how many.
  std::size_t pour(std::vector<Grain>& grains);

  bool done() const { return waiting_.empty(); }

 private:
  std::mt19937_64 random_;
  std::vector<Grain> waiting_;
  double reach_ = 0.0;             // of the largest
  double room_ = 0.0;              // that it needs among others
  std::vector<glm::dvec3> spots_;  // where it fits, the lowest first
};

}  // namespace mesograin::pile
