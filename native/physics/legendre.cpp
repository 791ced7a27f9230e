// By the recurrence in the order (Abramowitz & Stegun 22.7.10), which is stable on [-1, 1].
#include "physics/legendre.h"

#include <cstddef>

namespace mesograin::physics {

void legendre_polynomials(double x, std::vector<double>& values) {
  double before = 0.0;
  double value = 1.0;
  for (std::size_t l = 0; l < values.size(); ++l) {
    values[l] = value;
    // No quotient waits for the order before.
    const double share = 1.0 / (static_cast<double>(l) + 1.0);
    const double next = (2.0 - share) * x * value - (1.0 - share) * before;
    before = value;
    value = next;
  }
}

void legendre_polynomials(const SideBySide& x, std::vector<SideBySide>& values) {
  SideBySide before{};
  SideBySide value;
  value.fill(1.0);
  for (std::size_t l = 0; l < values.size(); ++l) {
    values[l] = value;
    const double share = 1.0 / (static_cast<double>(l) + 1.0);
    for (std::size_t i = 0; i < side_by_side; ++i) {
      const double next = (2.0 - share) * x[i] * value[i] - (1.0 - share) * before[i];
      before[i] = value[i];
      value[i] = next;
    }
  }
}

}  // namespace mesograin::physics
