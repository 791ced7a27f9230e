// Azimuths of half a circle stand for all.
#include "physics/body/flowing_lobe.h"

#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {

FlowingLobe::FlowingLobe(const BodySurface& surface) : slope_(exit_lobe(surface).slope), plain_(0.0) {
  constexpr int azimuths = 12;
  // Below the critical cosine nothing comes through to a rarer outside.
  const double critical = surface.eta < 1.0 ? sine_of_cosine(surface.eta) : 0.0;
  for (const QuadratureNode& node : gauss_legendre(16)) {
    const double mu = critical + (1.0 - critical) * node.x;
    const double mu_inside = refracted_cosine(mu, surface.eta);
    const double transmittance = surface.eta == 1.0 ? 1.0 : fresnel_transmittance(mu, mu_inside, surface.eta);
    for (int k = 0; k < azimuths; ++k)
      directions_.push_back({mu_inside, sine_of_cosine(mu_inside) * std::cos(PI * (k + 0.5) / azimuths),
                             node.weight * mu * transmittance});
  }
  for (const Direction& direction : directions_) plain_ += direction.weight * (1.0 + slope_ * direction.mu);
}

double FlowingLobe::share(double flow, double decay) const {
  const double square = decay * decay - flow * flow;
  double flux = 0.0;
  for (const Direction& direction : directions_) {
    const double p = 1.0 - flow * direction.along;
    flux += direction.weight * (p + slope_ * direction.mu) / (p * p - square * direction.mu * direction.mu);
  }
  return plain_ / flux;
}

}  // namespace mesograin::physics
