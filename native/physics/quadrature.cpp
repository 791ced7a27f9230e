// The roots of the Legendre polynomial by Newton's method, once for each count.
#include "physics/quadrature.h"

#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

namespace mesograin::physics {
namespace {

std::vector<QuadratureNode> compute_nodes(int count) {
  std::vector<QuadratureNode> nodes(count);
  for (int i = 0; i < count; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
    double derivative = 0.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double previous = 1.0;
      double legendre = x;
      for (int degree = 2; degree <= count; ++degree) {
        const double next = ((2 * degree - 1) * x * legendre - (degree - 1) * previous) / degree;
        previous = legendre;
        legendre = next;
      }
      derivative = count * (x * legendre - previous) / (x * x - 1.0);
      const double step = legendre / derivative;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    nodes[i] = {0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * derivative * derivative)};
  }
  return nodes;
}

}  // namespace

const std::vector<QuadratureNode>& gauss_legendre(int count) {
  static std::mutex mutex;
  static std::map<int, std::vector<QuadratureNode>> cache;
  const std::lock_guard lock(mutex);
  auto found = cache.find(count);
  if (found == cache.end()) found = cache.emplace(count, compute_nodes(count)).first;
  return found->second;
}

}  // namespace mesograin::physics
