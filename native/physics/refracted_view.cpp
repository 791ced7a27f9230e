// Heitz' hemisphere-projection sampling of visible normals, with quadrature nodes in place of random numbers.
#include "physics/refracted_view.h"

#include <algorithm>
#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int radial_nodes = 24;
constexpr int azimuthal_nodes = 48;
constexpr int table_intervals = 256;

// The visible normal for a point of the unit disk (Heitz 2018, listing 1), view = (sin, 0, cos).
glm::dvec3 visible_normal(const glm::dvec3& view, double alpha, double radius, double azimuth) {
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * view.x, 0.0, view.z));
  const glm::dvec3 tangent(0.0, 1.0, 0.0);
  const glm::dvec3 bitangent = glm::cross(stretched, tangent);
  const double t1 = radius * std::cos(azimuth);
  const double blend = 0.5 * (1.0 + stretched.z);
  const double t2 = (1.0 - blend) * sine_of_cosine(t1) + blend * radius * std::sin(azimuth);
  const glm::dvec3 normal =
      t1 * tangent + t2 * bitangent + std::sqrt(std::max(0.0, 1.0 - t1 * t1 - t2 * t2)) * stretched;
  return glm::normalize(glm::dvec3(alpha * normal.x, alpha * normal.y, std::max(1e-12, normal.z)));
}

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
