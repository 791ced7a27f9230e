// Integrals over rings: the light's cosine over the part of a ring that is lit.
#include "physics/body/entering_ring.h"

#include <algorithm>
#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int distance_nodes = 64;

}  // namespace

double entering_ring(const BodySurface& surface, double cosine, double ring_cosine) {
  const double axial = cosine * ring_cosine;
  const double lateral = sine_of_cosine(cosine) * sine_of_cosine(ring_cosine);
  if (axial + lateral <= 0.0) return 0.0;
  const double lit = axial >= lateral ? PI : std::acos(std::clamp(-axial / lateral, -1.0, 1.0));
  double sum = 0.0;
  for (const QuadratureNode& node : gauss_legendre(8)) {
    const double mu = std::clamp(axial + lateral * std::cos(lit * node.x), 0.0, 1.0);
    const double transmittance =
        surface.eta == 1.0 ? 1.0 : fresnel_transmittance(mu, refracted_cosine(mu, surface.eta), surface.eta);
    sum += 2.0 * lit * node.weight * mu * transmittance;
  }
  return sum;
}

SphereUnscattered::SphereUnscattered(const BodySurface& surface, const std::vector<double>& cosines)
    : entering_(cosines.size()) {
  for (const QuadratureNode& node : gauss_legendre(distance_nodes)) {
    // Squares, so that dense spheres have nodes enough near the point.
    const double d = 2.0 * node.x * node.x;
    const double weight = 4.0 * node.x * node.weight;
    distances_.push_back(d);
    // A ring of this distance is d wide per d; the geometry term is 1 / (4 pi).
    for (std::size_t i = 0; i < cosines.size(); ++i)
      entering_[i].push_back(weight * d * entering_ring(surface, cosines[i], 1.0 - 0.5 * d * d) / (4.0 * PI));
  }
}

std::vector<double> SphereUnscattered::exitance(double optical_radius) const {
  std::vector<double> attenuation;
  attenuation.reserve(distances_.size());
  for (const double d : distances_) attenuation.push_back(std::exp(-optical_radius * d));
  std::vector<double> result;
  result.reserve(entering_.size());
  for (const std::vector<double>& entering : entering_) {
    double sum = 0.0;
    for (std::size_t j = 0; j < distances_.size(); ++j) sum += attenuation[j] * entering[j];
    result.push_back(sum);
  }
  return result;
}

}  // namespace mesograin::physics
