// Legendre polynomials.
#pragma once

#include <vector>

namespace mesograin::physics {

/// P_0 to P_n at `x`, as many as `values` holds.
void legendre_polynomials(double x, std::vector<double>& values);

}  // namespace mesograin::physics
