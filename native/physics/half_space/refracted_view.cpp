// The visible normals by quadrature nodes, in place of random numbers.
#include "physics/half_space/refracted_view.h"

#include <algorithm>
#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"
#include "physics/visible_normals.h"

namespace mesograin::physics {
namespace {

constexpr int radial_nodes = 24;
constexpr int azimuthal_nodes = 48;
constexpr int table_intervals = 256;

}  // namespace

RefractedView::RefractedView(const Medium& medium, double eta, double roughness) : eta_(eta), roughness_(roughness) {
  const HalfSpaceInterior interior(medium);
  for (int i = 0; i <= table_intervals; ++i) {
    const double root = static_cast<double>(i) / table_intervals;
    albedo_inside_.push_back(std::clamp(interior.plane_albedo(root * root), 0.0, 1.0));
  }
}

double RefractedView::albedo_inside(double mu) const {
  const double position = std::sqrt(std::clamp(mu, 0.0, 1.0)) * table_intervals;
  const int interval = std::min(static_cast<int>(position), table_intervals - 1);
  return std::lerp(albedo_inside_[interval], albedo_inside_[interval + 1], position - interval);
}

double RefractedView::albedo(double mu) const {
  if (roughness_ <= 0.0) return albedo_inside(refracted_cosine(mu, eta_));
  const glm::dvec3 view(sine_of_cosine(mu), 0.0, mu);
  double sum = 0.0;
  for (const QuadratureNode& node : gauss_legendre(radial_nodes)) {
    for (int step = 0; step < azimuthal_nodes; ++step) {
      const double azimuth = 2.0 * PI * (step + 0.5) / azimuthal_nodes;
      const glm::dvec3 normal = visible_normal(view, roughness_, std::sqrt(node.x), azimuth);
      const double mu_normal = std::clamp(glm::dot(view, normal), 0.0, 1.0);
      const double mu_inside = mu / eta_ - (mu_normal / eta_ - refracted_cosine(mu_normal, eta_)) * normal.z;
      if (mu_inside > 0.0) sum += node.weight / azimuthal_nodes * albedo_inside(mu_inside);
    }
  }
  return sum;
}

}  // namespace mesograin::physics
