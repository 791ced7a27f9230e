// As for the sphere, order by order: cos(m phi) in the place of Legendre polynomials, I_m in that of i_l. Nothing
// depends on the place along the axis.
#include "physics/body/cylinder_exitance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "physics/body/beam_depths.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int largest_order = 48;
constexpr int entry_nodes = 24;

// Below this a decay is indistinguishable from none: the ratios are linear in it to 1e-12.
constexpr double least_decay = 1e-5;

// I_{m+1}(x)/I_m(x)/x for m = 0, 1, ..., by the continued fraction of the recurrence I_{m-1} = I_{m+1} + 2m/x I_m
// (Abramowitz & Stegun 9.6.26), run downwards from a value between the bounds of Amos 1974 (eqs. 9 and 11).
std::vector<double> neighbour_ratios(double x) {
  constexpr int run_up = 24;
  std::vector<double> ratios(largest_order + 1);
  const double start = largest_order + 1 + run_up;
  double ratio = 1.0 / (start + 0.5 + std::sqrt((start + 1.0) * (start + 1.0) + x * x));
  for (int m = largest_order + 1 + run_up; m > 0; --m) {
    ratio = 1.0 / (2.0 * m + x * x * ratio);
    if (m <= largest_order + 1) ratios[m - 1] = ratio;
  }
  return ratios;
}

// I_0(x) without its growth; beyond the limit by its asymptotic series (Abramowitz & Stegun 9.7.1).
double decayed_bessel(double x) {
  constexpr double limit = 40.0;
  if (x < limit) return std::exp(-x) * std::cyl_bessel_i(0.0, x);
  return (1.0 + (1.0 + 4.5 / (8.0 * x) * (1.0 + 25.0 / (24.0 * x))) / (8.0 * x)) / std::sqrt(2.0 * PI * x);
}

// Moments of the source about the cylinder's axis, each sample already carried to the surface: a line source of unit
// power at radius r and angle phi sends out sum_m (2 - delta_m0)/(2 pi) transfer_m cos(m (phi - place)), with
// transfer_m = I_m(decay r)/I_m(decay) / (1 + b decay I_m'(decay)/I_m(decay)).
class Moments {
 public:
  explicit Moments(const DiffusionPart& part)
      : part_(part),
        decay_(std::max(part.decay, least_decay)),
        at_surface_(neighbour_ratios(decay_)),
        sums_(largest_order + 1) {}

  void add(const glm::dvec2& point, double weight) {
    const double r = std::min(1.0, glm::length(point));
    const double angle = std::atan2(point.x, point.y);
    const std::vector<double> ratios = neighbour_ratios(decay_ * r);
    double inside = std::exp(-decay_ * (1.0 - r)) * decayed_bessel(decay_ * r) / decayed_bessel(decay_);
    for (int m = 0; m <= largest_order; ++m) {
      const double logarithmic_derivative = m + decay_ * decay_ * at_surface_[m];
      sums_[m] += weight * inside / (1.0 + part_.boundary_length * logarithmic_derivative) * std::cos(m * angle);
      inside *= r * ratios[m] / at_surface_[m];
    }
  }

  void scale_order(int order, double factor) { sums_[order] *= factor; }

  double exitance_facing_light() const {
    double sum = 0.0;
    for (int m = 0; m <= largest_order; ++m) {
      // The sphere's filter (sphere_exitance.cpp), so that what is compared lacks the same.
      const double share = static_cast<double>(m) / largest_order;
      sum += std::exp(-14.0 * share * share * share * share) * (m > 0 ? 2.0 : 1.0) / (2.0 * PI) * sums_[m];
    }
    return part_.source * sum;
  }

 private:
  DiffusionPart part_;
  double decay_;
  std::vector<double> at_surface_;
  std::vector<double> sums_;
};

double collimated(const DiffusionPart& part, double eta) {
  Moments moments(part);
  // What is totally reflected at a rarer grain does not enter.
  const double widest = std::asin(std::min(eta, 1.0));
  for (const QuadratureNode& node : gauss_legendre(entry_nodes)) {
    const glm::dvec2 normal(std::sin(widest * node.x), std::cos(widest * node.x));
    const double mu = normal.y;
    const double mu_refracted = refracted_cosine(mu, eta);
    const double transmittance = eta == 1.0 ? 1.0 : fresnel_transmittance(mu, mu_refracted, eta);
    // Both sides of the line that faces the light.
    double flux = 2.0 * widest * node.weight * mu * transmittance;
    glm::dvec2 entry = normal;
    glm::dvec2 direction = glm::dvec2(0.0, -1.0) / eta + (mu / eta - mu_refracted) * normal;
    const double chord = 2.0 * mu_refracted;
    for (int bounce = 0; bounce < 4 && flux > 1e-3; ++bounce) {
      for_depths(part, chord, [&](double t, double weight) { moments.add(entry + t * direction, flux * weight); });
      flux *= (1.0 - transmittance) * std::exp(-part.extinction * chord);
      entry += chord * direction;
      direction -= 2.0 * glm::dot(direction, entry) * entry;
    }
  }
  return moments.exitance_facing_light();
}

// A cosine lobe at every lit point: averaging over its two sides multiplies the moment of the irradiance by that of the
// lobe's own light about the point where it enters.
double from_cosine_lobe(const DiffusionPart& part) {
  constexpr int lobe_nodes = 8;
  Moments moments(part);
  for (const QuadratureNode& node : gauss_legendre(lobe_nodes))
    for (const QuadratureNode& turn : gauss_legendre(lobe_nodes)) {
      const glm::dvec2 across(sine_of_cosine(node.x) * std::cos(0.5 * PI * turn.x), -node.x);
      const double chord = 2.0 * node.x / glm::dot(across, across);
      for_depths(part, chord, [&](double t, double weight) {
        moments.add(glm::dvec2(0.0, 1.0) + t * across, 2.0 * node.x * node.weight * turn.weight * weight);
      });
    }
  for (int m = 0; m <= largest_order; ++m) {
    double irradiance = 0.0;
    for (const QuadratureNode& node : gauss_legendre(48)) {
      const double angle = 0.5 * PI * node.x;
      irradiance += PI * node.weight * std::cos(angle) * std::cos(m * angle);
    }
    moments.scale_order(m, irradiance);
  }
  return moments.exitance_facing_light();
}

}  // namespace

double cylinder_multiple_exitance(const BodyMedium& medium, const BodySurface& surface) {
  if (medium.reduced_sigma_s() <= 0.0) return 0.0;
  const DiffusionPart all = all_orders(medium, surface);
  if (surface.cosine_entry) return from_cosine_lobe(all);
  return std::max(collimated(all, surface.eta) - collimated(first_order(medium, surface), surface.eta), 0.0);
}

}  // namespace mesograin::physics
