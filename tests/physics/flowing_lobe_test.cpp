// Light that fades as it flows: its lobe against the integral along the ray that it stands for, and what leaves by it.
#include "physics/body/flowing_lobe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

BodySurface smooth(double eta) {
  BodySurface surface;
  surface.eta = eta;
  surface.diffusion = diffusion_boundary(eta);
  return surface;
}

// int exp(-s) phi(x + s w) ds over the fluence that the lobe assumes, by quadrature.
double along_ray(double flow, double decay, double slope, double mu, double along) {
  const double square = decay * decay - flow * flow;
  const double q = std::sqrt(std::abs(square));
  double sum = 0.0;
  constexpr int pieces = 400;
  constexpr double end = 200.0;
  for (int piece = 0; piece < pieces; ++piece)
    for (const QuadratureNode& node : gauss_legendre(8)) {
      const double s = end * (piece + node.x) / pieces;
      const double z = q * s * mu;
      const double even = square > 0.0 ? std::cosh(z) : std::cos(z);
      const double odd = q < 1e-9 ? s * mu : (square > 0.0 ? std::sinh(z) : std::sin(z)) / q;
      sum += end / pieces * node.weight * std::exp(-s * (1.0 - flow * along)) * (even + slope * odd);
    }
  return sum;
}

TEST(FlowingLobe, SendsOutAsMuchAsThePlainLobe) {
  for (const double eta : {1.0, 1.3, 1.5}) {
    const BodySurface surface = smooth(eta);
    const ExitLobe plain = exit_lobe(surface);
    const FlowingLobe lobe(surface);
    EXPECT_NEAR(lobe.share(0.0, 0.0), 1.0, 1e-12);
    for (const double flow : {0.0, 0.3, largest_flow})
      for (const double decay : {0.0, 0.3, largest_lobe_decay}) {
        double flux = 0.0;
        constexpr int azimuths = 24;
        for (const QuadratureNode& node : gauss_legendre(32)) {
          const double mu = refracted_cosine(node.x, eta);
          const double transmittance = eta == 1.0 ? 1.0 : fresnel_transmittance(node.x, mu, eta);
          for (int k = 0; k < azimuths; ++k) {
            const double along = sine_of_cosine(mu) * std::cos(2.0 * PI * (k + 0.5) / azimuths);
            flux += 2.0 * PI / azimuths * node.weight * node.x * transmittance * plain.factor *
                    along_ray(flow, decay, plain.slope, mu, along);
          }
        }
        EXPECT_NEAR(flux * lobe.share(flow, decay), 1.0, 2e-3) << eta << ' ' << flow << ' ' << decay;
      }
  }
}

TEST(FarDecay, IsNearlyThatOfTheTransportEquation) {
  for (const double albedo : {0.5, 0.7, 0.9, 0.99, 0.9999}) {
    // albedo = k/artanh(k) (Case and Zweifel 1967, section 4.3).
    double low = 1e-6;
    double high = 1.0 - 1e-12;
    for (int i = 0; i < 100; ++i) {
      const double k = 0.5 * (low + high);
      (k / std::atanh(k) > albedo ? low : high) = k;
    }
    EXPECT_NEAR(far_decay({1.0 - albedo, albedo, 0.0}) / low, 1.0, 0.05) << albedo;
  }
}

}  // namespace
}  // namespace mesograin::physics
