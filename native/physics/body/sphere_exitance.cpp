// Beams enter by rings of equal azimuth; each is sampled along its way, and every sample adds to all Legendre orders.
#include "physics/body/sphere_exitance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "physics/body/beam_depths.h"
#include "physics/body/exit_directions.h"
#include "physics/body/half_space_exitance.h"
#include "physics/body/sphere_diffusion.h"
#include "physics/body/sphere_refraction.h"
#include "physics/forward_peak.h"
#include "physics/legendre.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int largest_order = 48;
constexpr int entry_nodes = 16;
constexpr int depth_nodes = 16;

struct Beam {
  glm::dvec2 entry;      // (distance from the axis, height), the light comes down the axis
  glm::dvec2 direction;  // inside
  double chord;
  double flux;         // per irradiance and area 2 pi
  double reflectance;  // at either end
};

std::vector<Beam> entering_beams(double eta, int nodes) {
  std::vector<Beam> beams;
  // What is totally reflected at a rarer grain does not enter.
  const double critical = eta < 1.0 ? sine_of_cosine(eta) : 0.0;
  for (const QuadratureNode& node : gauss_legendre(nodes)) {
    const double mu = critical + (1.0 - critical) * node.x;
    const double mu_refracted = refracted_cosine(mu, eta);
    const double transmittance = eta == 1.0 ? 1.0 : fresnel_transmittance(mu, mu_refracted, eta);
    const glm::dvec2 normal(sine_of_cosine(mu), mu);
    const glm::dvec2 direction = glm::dvec2(0.0, -1.0) / eta + (mu / eta - mu_refracted) * normal;
    beams.push_back({normal, direction, 2.0 * mu_refracted, (1.0 - critical) * node.weight * mu * transmittance,
                     1.0 - transmittance});
  }
  return beams;
}

// An exponential filter (Gottlieb & Shu 1997, section 2.3): a thick grain's terminator is sharper than these orders can
// draw, and what they lack would ripple over the dark side.
const std::vector<double>& filter() {
  static const std::vector<double> shares = [] {
    std::vector<double> of_orders;
    for (int l = 0; l <= largest_order; ++l) {
      const double share = static_cast<double>(l) / largest_order;
      of_orders.push_back(std::exp(-14.0 * share * share * share * share));
    }
    return of_orders;
  }();
  return shares;
}

// Legendre moments of the source in the sphere, each sample already carried to the surface.
class Moments {
 public:
  Moments(const DiffusionPart& part)
      : source_(part.source),
        solution_(part.decay, part.boundary_length, largest_order),
        sums_(largest_order + 1),
        transfer_(largest_order + 1),
        legendre_(largest_order + 1) {}

  void add(double radius, double cosine, double weight) {
    radii_[waiting_] = radius;
    cosines_[waiting_] = cosine;
    weights_[waiting_] = weight;
    if (++waiting_ == side_by_side) add_waiting();
  }

  // When all are added.
  void end() {
    while (waiting_ > 0) add(0.0, 0.0, 0.0);
  }

  double exitance(double cosine) const {
    std::vector<double> legendre(largest_order + 1);
    legendre_polynomials(cosine, legendre);
    double sum = 0.0;
    for (int l = 0; l <= largest_order; ++l) sum += filter()[l] * (l + 0.5) * sums_[l] * legendre[l];
    return source_ * sum;
  }

  void scale_order(int order, double factor) { sums_[order] *= factor; }

 private:
  void add_waiting() {
    solution_.transfer(radii_, transfer_);
    legendre_polynomials(cosines_, legendre_);
    for (int l = 0; l <= largest_order; ++l)
      for (std::size_t i = 0; i < side_by_side; ++i) sums_[l] += weights_[i] * transfer_[l][i] * legendre_[l][i];
    waiting_ = 0;
  }

  double source_;
  SphereDiffusion solution_;
  std::vector<double> sums_;
  std::size_t waiting_ = 0;
  SideBySide radii_{}, cosines_{}, weights_{};
  std::vector<SideBySide> transfer_;
  std::vector<SideBySide> legendre_;
};

Moments collimated_moments(const DiffusionPart& part, double eta) {
  Moments moments(part);
  for (Beam beam : entering_beams(eta, entry_nodes)) {
    // Inside a sphere a ray meets the surface at the same angle each time.
    for (int bounce = 0; bounce < 4 && beam.flux > 1e-3; ++bounce) {
      for_depths(part, beam.chord, [&](double t, double weight) {
        const glm::dvec2 point = beam.entry + t * beam.direction;
        const double radius = std::min(1.0, glm::length(point));
        moments.add(radius, radius > 0.0 ? std::clamp(point.y / radius, -1.0, 1.0) : 0.0, beam.flux * weight);
      });
      beam.flux *= beam.reflectance * std::exp(-part.extinction * beam.chord);
      beam.entry += beam.chord * beam.direction;
      beam.direction -= 2.0 * glm::dot(beam.direction, beam.entry) * beam.entry;
    }
  }
  moments.end();
  return moments;
}

// A cosine lobe at every lit point: by the addition theorem, averaging over its azimuth multiplies the moment of the
// irradiance by that of the lobe's own light about the point where it enters.
Moments cosine_entry_moments(const DiffusionPart& part) {
  Moments moments(part);
  for (const QuadratureNode& node : gauss_legendre(entry_nodes)) {
    const double mu = node.x;
    for_depths(part, 2.0 * mu, [&](double t, double weight) {
      const glm::dvec2 point(t * sine_of_cosine(mu), 1.0 - t * mu);
      const double radius = std::min(1.0, glm::length(point));
      moments.add(radius, radius > 0.0 ? std::clamp(point.y / radius, -1.0, 1.0) : 0.0,
                  2.0 * mu * node.weight * weight);
    });
  }
  moments.end();
  std::vector<double> irradiance(largest_order + 1);
  std::vector<double> legendre(largest_order + 1);
  for (const QuadratureNode& node : gauss_legendre(48)) {
    legendre_polynomials(node.x, legendre);
    for (int l = 0; l <= largest_order; ++l) irradiance[l] += node.weight * node.x * legendre[l];
  }
  for (int l = 0; l <= largest_order; ++l) moments.scale_order(l, irradiance[l]);
  return moments;
}

Moments scattered_moments(const DiffusionPart& part, const BodySurface& surface) {
  return surface.cosine_entry ? cosine_entry_moments(part) : collimated_moments(part, surface.eta);
}

}  // namespace

std::vector<double> sphere_multiple_exitance(const BodyMedium& medium, const BodySurface& surface,
                                             const std::vector<double>& cosines) {
  std::vector<double> exitance(cosines.size(), 0.0);
  if (medium.reduced_sigma_s() <= 0.0) return exitance;
  const auto add = [&](const Moments& moments, double sign) {
    for (std::size_t i = 0; i < cosines.size(); ++i) exitance[i] += sign * moments.exitance(cosines[i]);
  };
  const DiffusionPart all = all_orders(medium, surface);
  const Moments near = scattered_moments(all, surface);
  add(near, 1.0);
  if (!surface.cosine_entry) add(collimated_moments(first_order(medium, surface), surface.eta), -1.0);
  // P1 tells well how much light there is up to the terminator, but lets it fade too soon: beyond, the better decay
  // says what is left of it.
  DiffusionPart far = all;
  far.decay = far_decay(medium);
  const Moments faded = scattered_moments(far, surface);
  const double at_terminator = near.exitance(0.0) / faded.exitance(0.0);
  for (std::size_t i = 0; i < cosines.size(); ++i) {
    const double before = near.exitance(cosines[i]);
    if (cosines[i] < 0.0 && before > 0.0)
      exitance[i] *= std::max(at_terminator * faded.exitance(cosines[i]) / before, 0.0);
    // Orders that the sum leaves out ripple about zero where hardly any light arrives.
    exitance[i] = std::max(exitance[i], 0.0);
  }
  return exitance;
}

SphereSingleScattering::SphereSingleScattering(double eta, double g, const std::vector<double>& cosines)
    : eta_(eta), cosines_(cosines), points_(cosines.size()) {
  const SphereRefraction refraction(eta);
  const double phase_g = tabulated_g(g);
  const double rest_g = ForwardPeak(phase_g).rest_g;
  const double sign = g < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < cosines.size(); ++i) {
    const real3 exit(sine_of_cosine(cosines[i]), 0.0, cosines[i]);
    for (const ExitDirection& direction : exit_directions(eta, cosines[i], 0.5 * (phase_g + rest_g))) {
      for (const QuadratureNode& depth : gauss_legendre(depth_nodes)) {
        const double t = 2.0 * direction.mu * depth.x * depth.x * depth.x;
        const double step = 6.0 * direction.mu * depth.x * depth.x * depth.weight;
        const real3 point = exit + t * direction.inwards;
        const double x = std::hypot(point.x, point.y);
        const RefractedLight light = refraction.at(x, point.z);
        const double way_in = light.path_ratio * std::max(0.0, sine_of_cosine(x) - point.z);
        const double weight = direction.weight * step * light.irradiance;
        Way way{way_in, t, weight, 0.0};
        if (g != 0.0) {
          const double outwards = x > 0.0 ? light.sideways / x : 0.0;
          const real3 travels(outwards * point.x, outwards * point.y, -sine_of_cosine(light.sideways));
          const real3 turn = travels + sign * direction.inwards;
          const double versine = std::min(0.5 * dot(turn, turn), 2.0);
          way.first *= 4.0 * PI * henyey_greenstein(versine, std::abs(phase_g), 1.0 - std::abs(phase_g));
          way.later = weight * 4.0 * PI * henyey_greenstein(versine, std::abs(rest_g), 1.0 - std::abs(rest_g));
        }
        points_[i].push_back(way);
      }
    }
  }
}

std::vector<double> SphereSingleScattering::exitance(const BodyMedium& medium) const {
  return exitance(medium, half_space_single_exitance(medium, eta_, cosines_));
}

std::vector<double> SphereSingleScattering::exitance(const BodyMedium& medium,
                                                     const std::vector<double>& half_space) const {
  // Beyond what the depths resolve, the difference from the half-space goes on falling like the curvature.
  constexpr double largest = 40.0;
  const double curvature = std::min(largest / std::max(medium.sigma_t(), 1e-300), 1.0);
  const BodyMedium known{medium.sigma_a * curvature, medium.sigma_s * curvature, medium.g};
  const ForwardPeak peak(medium.g);
  const double past_peak = known.rest_sigma_t();
  const double in_peak = peak.share * known.sigma_s;
  std::vector<double> exitance;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    double sum = 0.0;
    for (const Way& way : points_[i]) {
      const double reached = std::exp(-past_peak * (way.in + way.out));
      const double met_nothing = in_peak > 0.0 ? std::exp(-in_peak * way.in) : 1.0;
      sum += reached * (way.first * met_nothing + peak.rest * way.later * (1.0 - met_nothing));
    }
    exitance.push_back(half_space[i] + curvature * (known.sigma_s * sum - half_space[i]));
  }
  return exitance;
}

}  // namespace mesograin::physics
