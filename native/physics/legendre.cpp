// By the recurrence in the order (Abramowitz & Stegun 22.7.10), which is stable on [-1, 1].
#include "physics/legendre.h"

#include <cstddef>

namespace mesograin::physics {

void legendre_polynomials(double x, std::vector<double>& values) {
  double before = 0.0;
  double value = 1.0;
  for (std::size_t l = 0; l < values.size(); ++l) {
    values[l] = value;
    const double order = static_cast<double>(l);
    const double next = ((2.0 * order + 1.0) * x * value - order * before) / (order + 1.0);
    before = value;
    value = next;
  }
}

}  // namespace mesograin::physics
