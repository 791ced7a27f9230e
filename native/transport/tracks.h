// What rays leave at the nodes that they pass.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "transport/grid.h"
#include "transport/random.h"

namespace mesograin::transport {

/// The fluence of rays at a grid's nodes, for each of some extinctions, sigma_t per unit of the body. It is summed in
/// cells, eight numbers beside one another, and comes to the nodes at the end: summed at each node that was passed it
/// took half of the time that a new mesh takes.
class Tracks {
 public:
  Tracks(const Grid& grid, const std::vector<double>& extinctions);

  /// Leaves the fluence of a ray of `flux` on its way; each extinction has so much of it left as `left` says.
  void add(const glm::vec3& place, const glm::vec3& direction, float length, float flux, std::vector<float>& left,
           Random& random);

  /// [node * extinctions + extinction].
  std::vector<float> at_nodes() const;

 private:
  const Grid& grid_;
  glm::vec3 per_spacing_;
  std::vector<float> extinctions_;
  std::vector<float> sums_;    // [(cell * extinctions + extinction) * 8 + corner]
  std::vector<float> passed_;  // of a step, for each extinction
  std::vector<float> tracks_;  // of a whole ray's step
  float step_;
};

}  // namespace mesograin::transport
