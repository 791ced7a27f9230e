// Gauss-Legendre quadrature.
#pragma once

#include <vector>

namespace mesograin::physics {

struct QuadratureNode {
  double x;
  double weight;
};

/// `count` nodes on [0, 1], exact for polynomials up to degree 2 count - 1 (Abramowitz & Stegun 25.4.30).
const std::vector<QuadratureNode>& gauss_legendre(int count);

}  // namespace mesograin::physics
