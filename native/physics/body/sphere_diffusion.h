// The diffusion equation in a homogeneous unit sphere with a partly reflecting boundary, solved order by order in
// Legendre polynomials.
#pragma once

#include <vector>

#include "physics/side_by_side.h"

namespace mesograin::physics {

/// -D lap(phi) + sigma phi = Q in r < 1, phi + b dphi/dr = 0 at r = 1 (b = 2 A D: the partial-current condition, d'Eon
/// & Irving 2011 section 5.2). With the exitance constants that go with A, the exitance is phi/(2A) and every photon is
/// accounted for.
class SphereDiffusion {
 public:
  /// `decay` is sqrt(sigma/D), `boundary_length` is b; solves for orders 0 to `largest_order`.
  SphereDiffusion(double decay, double boundary_length, int largest_order);

  int largest_order() const { return static_cast<int>(boundary_.size()) - 1; }

  /// The response to point sources of unit power at radii `r`: exitance at the angle gamma from one is
  /// sum_l (2l+1)/(4 pi) transfer[l] P_l(cos gamma), with
  /// transfer[l] = i_l(decay r)/i_l(decay) / (1 + b decay i_l'(decay)/i_l(decay)), i_l the modified spherical Bessel
  /// function.
  void transfer(const SideBySide& r, std::vector<SideBySide>& transfer) const;

 private:
  double decay_;
  std::vector<double> ratios_;    // i_{l+1}/i_l at the surface, over the decay
  std::vector<double> boundary_;  // 1/(1 + b gamma_l)
  mutable std::vector<SideBySide> scratch_;
};

}  // namespace mesograin::physics
