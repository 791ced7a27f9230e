// Gauss-Legendre in the cosine on the side where no light is totally reflected, on intervals that shrink towards
// grazing.
#include "physics/fresnel_moments.h"

#include <algorithm>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int nodes_per_interval = 24;

// Integrates over [0, 1] by halves, quarters, ... down to 2^-40: near eta = 1 the transmittance rises within sqrt(eta^2
// - 1) of grazing.
template <typename Integrand>
double integrate_towards_zero(Integrand integrand) {
  double sum = 0.0;
  double high = 1.0;
  for (int interval = 0; interval < 40; ++interval, high *= 0.5)
    for (const QuadratureNode& node : gauss_legendre(nodes_per_interval))
      sum += 0.5 * high * node.weight * integrand(0.5 * high * (1.0 + node.x));
  return sum;
}

}  // namespace

FresnelMoments fresnel_moments(double eta) {
  if (eta == 1.0) return {1.0, 1.0};
  // Behind a rarer medium (eta < 1) the cosine of refraction covers [0, 1] and mu dmu = eta^2 mu_t dmu_t.
  const bool rarer = eta < 1.0;
  const auto integrate = [&](auto weight) {
    return integrate_towards_zero([&](double cosine) {
      const double other = refracted_cosine(cosine, rarer ? 1.0 / eta : eta);
      const double mu = rarer ? other : cosine;
      const double mu_refracted = rarer ? cosine : other;
      const double transmittance = fresnel_transmittance(mu, mu_refracted, eta);
      return transmittance * (rarer ? eta * eta * mu_refracted : mu) * weight(mu);
    });
  };
  return {integrate([](double) { return 2.0; }), integrate([](double mu) { return 3.0 * mu; })};
}

DiffusionBoundary diffusion_boundary(double eta) {
  const FresnelMoments inside = fresnel_moments(1.0 / eta);
  const FresnelMoments outside = fresnel_moments(eta);
  return {(1.0 + inside.three_c2()) / inside.one_minus_two_c1, 0.25 * inside.one_minus_two_c1,
          0.5 * inside.one_minus_three_c2, outside.one_minus_two_c1};
}

}  // namespace mesograin::physics
