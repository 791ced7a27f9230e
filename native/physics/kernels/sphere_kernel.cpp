// The sphere's kernel by its Legendre series; beyond what that can resolve, the half-space's plus a curvature that goes
// on falling.
#include "physics/kernels/sphere_kernel.h"

#include <algorithm>
#include <cmath>

#include "physics/body/sphere_diffusion.h"
#include "physics/legendre.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int depth_nodes = 20;

// The largest optical radius whose series is summed, and how many orders a mean free path needs.
constexpr double largest_series_radius = 32.0;
constexpr double orders_per_mean_free_path = 10.0;
constexpr int least_orders = 60;

struct Depth {
  double t;
  double weight;
};

// A beam's light by its depth below the surface: exponential with mean mu/spread. The beam is as long as its chord in
// the sphere, 2 mu.
std::vector<Depth> deposit(const DiffusionPart& part, double mu) {
  constexpr double nothing_left = 50.0;
  const double fall = part.spread / std::max(mu, 1e-3);
  const double end = std::min(2.0, nothing_left / fall);
  const double total = std::expm1(-2.0 * mu * part.extinction) / std::expm1(-2.0 * fall);
  std::vector<Depth> depths;
  for (const QuadratureNode& node : gauss_legendre(depth_nodes)) {
    const double t = end * node.x * node.x * node.x;
    depths.push_back({t, total * 3.0 * node.x * node.x * node.weight * end * fall * std::exp(-fall * t)});
  }
  return depths;
}

// The cosines inside at which light enters, with weights.
std::vector<QuadratureNode> entry_cosines(const BodySurface& surface, double mu) {
  if (!surface.cosine_entry) return {{mu, 1.0}};
  std::vector<QuadratureNode> nodes;
  for (const QuadratureNode& node : gauss_legendre(8)) nodes.push_back({node.x, 2.0 * node.x * node.weight});
  return nodes;
}

// Adds factor * sum_l (2l+1)/(4 pi) transfer_l.
void add_series(const DiffusionPart& part, const BodySurface& surface, double mu, double factor,
                std::vector<double>& coefficients) {
  const int largest = static_cast<int>(coefficients.size()) - 1;
  const SphereDiffusion solution(part.decay, part.boundary_length, largest);
  std::vector<SideBySide> transfer(coefficients.size());
  for (const QuadratureNode& entry : entry_cosines(surface, mu)) {
    const std::vector<Depth> depths = deposit(part, entry.x);
    for (std::size_t first = 0; first < depths.size(); first += side_by_side) {
      SideBySide radii{};
      SideBySide even{};
      SideBySide odd{};
      for (std::size_t i = 0; i < std::min(side_by_side, depths.size() - first); ++i) {
        const double radius = 1.0 - depths[first + i].t;
        radii[i] = std::abs(radius);
        even[i] = factor * part.source * entry.weight * depths[first + i].weight;
        // Beyond the centre the point lies on the other side: P_l(-x) = (-1)^l P_l(x).
        odd[i] = radius < 0.0 ? -even[i] : even[i];
      }
      solution.transfer(radii, transfer);
      for (int l = 0; l <= largest; ++l) {
        double sum = 0.0;
        for (std::size_t i = 0; i < side_by_side; ++i) sum += (l % 2 == 0 ? even : odd)[i] * transfer[l][i];
        coefficients[l] += (2.0 * l + 1.0) / (4.0 * PI) * sum;
      }
    }
  }
}

std::vector<double> series_kernel(const BodyMedium& medium, const BodySurface& surface,
                                  const std::vector<double>& distances, double mu) {
  const int orders = std::max(least_orders, static_cast<int>(orders_per_mean_free_path * medium.reduced_sigma_t()));
  std::vector<double> coefficients(orders + 1);
  add_series(all_orders(medium, surface), surface, mu, 1.0, coefficients);
  if (!surface.cosine_entry) add_series(first_order(medium, surface), surface, mu, -1.0, coefficients);
  // An exponential filter (Gottlieb & Shu 1997, section 2.3) keeps the cusp at no distance from rippling over the far
  // side.
  for (int l = 0; l <= orders; ++l) coefficients[l] *= std::exp(-20.0 * std::pow(static_cast<double>(l) / orders, 6.0));
  std::vector<double> values;
  std::vector<double> legendre(coefficients.size());
  for (double distance : distances) {
    legendre_polynomials(std::max(-1.0, 1.0 - 0.5 * distance * distance), legendre);
    double sum = 0.0;
    for (int l = 0; l <= orders; ++l) sum += coefficients[l] * legendre[l];
    values.push_back(std::max(sum, 0.0));
  }
  return values;
}

// Exitance at `distance` on a plane from a line source below: a point source of depth z under the partial-current
// condition is a line of flux dipoles from z on, falling as exp(-w/b) (the solution of phi + b dphi/dz = 0 by images);
// each sends z (1 + k d) exp(-k d)/(2 pi d^3).
double plane_part(const DiffusionPart& part, double distance, double mu) {
  const double z = std::max(mu, 1e-3) / part.spread;
  const double b = part.boundary_length;
  constexpr double nothing_left = 40.0;
  const double end = nothing_left * std::max(z, b);
  double sum = 0.0;
  for (const QuadratureNode& node : gauss_legendre(40)) {
    const double depth = end * node.x * node.x * node.x;
    const double step = 3.0 * end * node.x * node.x * node.weight;
    // exp(-depth/z)/z and exp(-depth/b)/b, convolved.
    const double slope = 1.0 / b - 1.0 / z;
    const double density =
        std::exp(-depth / std::max(z, b)) * depth * mean_attenuation(std::abs(slope) * depth) / (z * b);
    const double square = distance * distance + depth * depth;
    const double d = std::sqrt(square);
    sum += step * density * depth * (1.0 + part.decay * d) * std::exp(-part.decay * d) / (2.0 * PI * square * d);
  }
  return part.source * sum;
}

double plane_kernel(const BodyMedium& medium, const BodySurface& surface, double distance, double mu) {
  double sum = 0.0;
  for (const QuadratureNode& entry : entry_cosines(surface, mu))
    sum += entry.weight * plane_part(all_orders(medium, surface), distance, entry.x);
  if (!surface.cosine_entry) sum -= plane_part(first_order(medium, surface), distance, mu);
  return std::max(sum, 0.0);
}

}  // namespace

SphereKernel::SphereKernel(const BodyMedium& medium, const BodySurface& surface) : medium_(medium), surface_(surface) {}

std::vector<double> SphereKernel::evaluate(const std::vector<double>& distances, double mu) const {
  std::vector<double> values = evaluate_within(distances, mu);
  const double decay = all_orders(medium_, surface_).decay;
  const double at_antipode = evaluate_within({2.0}, mu).front();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (distances[i] > 2.0)
      values[i] = at_antipode * 4.0 / (distances[i] * distances[i]) * std::exp(-decay * (distances[i] - 2.0));
  return values;
}

std::vector<double> SphereKernel::evaluate_within(const std::vector<double>& distances, double mu) const {
  if (medium_.reduced_sigma_s() <= 0.0) return std::vector<double>(distances.size(), 0.0);
  const double shrink = largest_series_radius / medium_.reduced_sigma_t();
  if (shrink >= 1.0) return series_kernel(medium_, surface_, distances, mu);

  const BodyMedium smaller{medium_.sigma_a * shrink, medium_.sigma_s * shrink, medium_.g};
  std::vector<double> in_smaller;
  in_smaller.reserve(distances.size());
  for (double distance : distances) in_smaller.push_back(std::min(2.0, distance / shrink));
  const std::vector<double> curved = series_kernel(smaller, surface_, in_smaller, mu);
  std::vector<double> values;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double flat = plane_kernel(medium_, surface_, distances[i], mu);
    const double difference = distances[i] / shrink < 2.0 ? curved[i] / (shrink * shrink) - flat : 0.0;
    values.push_back(std::max(0.0, flat + shrink * difference));
  }
  return values;
}

}  // namespace mesograin::physics
