// Legendre polynomials.
#pragma once

#include <vector>

#include "physics/side_by_side.h"

namespace mesograin::physics {

/// P_0 to P_n at `x`, as many as `values` holds.
void legendre_polynomials(double x, std::vector<double>& values);
void legendre_polynomials(const SideBySide& x, std::vector<SideBySide>& values);

}  // namespace mesograin::physics
