// Azimuths of half a circle stand for all: everything here is symmetric about the plane of incidence.
#include "physics/body/exit_directions.h"

#include <algorithm>
#include <cmath>

#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

double transmittance_outwards(double mu_inside, double eta) {
  if (eta == 1.0) return 1.0;
  const double square = 1.0 - eta * eta * (1.0 - mu_inside) * (1.0 + mu_inside);
  return square > 0.0 ? fresnel_transmittance(std::sqrt(square), mu_inside, eta) : 0.0;
}

// The cosine of the normal is evenly sampled outside, where transmission has no kink.
std::vector<ExitDirection> about_the_normal(double eta, const real3& normal, const real3& tangent) {
  constexpr int angles = 6;
  std::vector<ExitDirection> directions;
  for (const QuadratureNode& node : gauss_legendre(angles)) {
    const double mu = node.x;
    const double mu_inside = refracted_cosine(mu, eta);
    const double sine_inside = sine_of_cosine(mu_inside);
    const double transmittance = eta == 1.0 ? 1.0 : fresnel_transmittance(mu, mu_inside, eta);
    for (int k = 0; k < angles; ++k) {
      const double azimuth = PI * (k + 0.5) / angles;
      const real3 sideways = std::cos(azimuth) * tangent + std::sin(azimuth) * real3(0.0, 1.0, 0.0);
      // mu' dmu' inside is mu dmu/eta^2 outside.
      directions.push_back({-mu_inside * normal - sine_inside * sideways, mu_inside,
                            0.5 * node.weight * mu * transmittance / (eta * eta) / angles});
    }
  }
  return directions;
}

// By the inverse of the Henyey-Greenstein function's distribution (Witt 1977).
std::vector<ExitDirection> about_the_light(double eta, const real3& normal, double g) {
  constexpr int versines = 16;
  constexpr int azimuths = 12;
  std::vector<ExitDirection> directions;
  for (const QuadratureNode& node : gauss_legendre(versines)) {
    // Forwards first for g > 0, backwards first for g < 0: quadrature nodes are densest at their ends.
    const double a = std::abs(g);
    const double ratio = (1.0 - a) * (1.0 + a) / (1.0 + a - 2.0 * a * node.x);
    const double versine = std::clamp((ratio - (1.0 - a)) * (ratio + (1.0 - a)) / (2.0 * a), 0.0, 2.0);
    const double density = henyey_greenstein(versine, a, 1.0 - a);
    const double cosine = g > 0.0 ? 1.0 - versine : versine - 1.0;
    const double sine = std::sqrt(versine * (2.0 - versine));
    for (int k = 0; k < azimuths; ++k) {
      const double azimuth = PI * (k + 0.5) / azimuths;
      const real3 inwards(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
      const double mu = -dot(inwards, normal);
      if (mu <= 0.0) continue;
      directions.push_back(
          {inwards, mu, node.weight / azimuths / (4.0 * PI * density) * mu * transmittance_outwards(mu, eta)});
    }
  }
  return directions;
}

}  // namespace

std::vector<ExitDirection> exit_directions(double eta, double cosine, double g) {
  const double sine = sine_of_cosine(cosine);
  const real3 normal(sine, 0.0, cosine);
  // One passes into the other: each is good to half a percent only, and a jump in g would show that.
  constexpr double least_peaked = 1e-8, most_even = 0.03;
  const double peaked = std::abs(g) < least_peaked ? 0.0 : std::min(std::abs(g) / most_even, 1.0);
  std::vector<ExitDirection> directions;
  const auto add = [&](const std::vector<ExitDirection>& some, double share) {
    for (ExitDirection direction : some) {
      direction.weight *= share;
      directions.push_back(direction);
    }
  };
  if (peaked < 1.0) add(about_the_normal(eta, normal, real3(cosine, 0.0, -sine)), 1.0 - peaked);
  if (peaked > 0.0) add(about_the_light(eta, normal, g), peaked);
  return directions;
}

}  // namespace mesograin::physics
