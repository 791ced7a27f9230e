// Quadrature over what a beam meets.
#include "physics/half_space/dielectric_surface.h"

#include <algorithm>
#include <cmath>

#include "physics/half_space/half_space.h"
#include "physics/half_space/medium.h"
#include "physics/physics.h"
#include "physics/quadrature.h"
#include "physics/visible_normals.h"

namespace mesograin::physics {
namespace {

constexpr int radial_nodes = 16;
constexpr int azimuthal_nodes = 14;  // over half a turn: the other half is its mirror image
constexpr int balance_nodes = 20;
constexpr int balance_steps = 12;

}  // namespace

RoughDielectric::RoughDielectric(double eta, double alpha, scene::Masking masking)
    : eta_(eta), alpha_(std::max(alpha, GGX_SMALLEST_ALPHA)), correlated_(masking == scene::Masking::correlated) {}

double RoughDielectric::reflected(double mu) const {
  const double cosine = std::clamp(mu, 1e-6, 1.0);
  const glm::dvec3 view(sine_of_cosine(cosine), 0.0, cosine);
  const double view_root = ggx_smith_root(cosine, alpha_);
  double sum = 0.0;
  for (const QuadratureNode& node : gauss_legendre(radial_nodes)) {
    for (int step = 0; step < azimuthal_nodes; ++step) {
      const double azimuth = PI * ((step + 0.5) / azimuthal_nodes - 0.5);
      const glm::dvec3 normal = visible_normal(view, alpha_, std::sqrt(node.x), azimuth);
      const double on_facet = std::clamp(glm::dot(view, normal), 0.0, 1.0);
      const double leaves = 2.0 * on_facet * normal.z - cosine;
      if (leaves <= 0.0) continue;
      // G2/G1 of the view: what of the visible facets' light is not caught again (Heitz 2014 eqs. 43 and 99).
      const double root = ggx_smith_root(leaves, alpha_);
      const double unmasked = correlated_ ? leaves * (cosine + view_root) / (leaves * view_root + cosine * root)
                                          : 2.0 * leaves / (leaves + root);
      sum += node.weight / azimuthal_nodes * fresnel_reflectance(on_facet, eta_) * unmasked;
    }
  }
  return std::min(sum, 1.0);
}

double RoughDielectric::entering(double mu) const {
  const double rough = 1.0 - reflected(mu);
  return eta_ < 1.0 ? std::min(rough, fresnel_transmittance(mu, refracted_cosine(mu, eta_), eta_)) : rough;
}

bool has_dielectric_surface(const scene::Material& material) {
  return material.boundary == scene::Boundary::dielectric && material.eta != 1.0;
}

bool has_rough_surface(const scene::Material& material) {
  return has_dielectric_surface(material) && material.roughness > 0.0;
}

std::vector<double> coordinate_cosines(double eta, int count) {
  std::vector<double> cosines;
  for (int i = 0; i < count; ++i) {
    const double coordinate = static_cast<double>(i) / (count - 1);
    const double lesser = coordinate * coordinate;
    cosines.push_back(eta < 1.0 ? refracted_cosine(lesser, 1.0 / eta) : lesser);
  }
  return cosines;
}

Passage rough_passage(const scene::Material& material) {
  const double eta = material.eta;
  const RoughDielectric surface(eta, material.roughness, material.masking);
  std::vector<double> outside;  // quadrature nodes, then the table's
  std::vector<double> measure;  // projected solid angle of each node
  for (const QuadratureNode& node : gauss_legendre(balance_nodes)) {
    outside.push_back(node.x * node.x);
    measure.push_back(2.0 * PI * outside.back() * 2.0 * node.x * node.weight);
  }
  const std::size_t nodes = outside.size();
  for (const double mu : coordinate_cosines(eta, Passage::table_size)) outside.push_back(mu);
  const std::size_t count = outside.size();

  std::vector<double> inside, smooth, rough;
  for (const double mu : outside) {
    inside.push_back(refracted_cosine(mu, eta));
    smooth.push_back(fresnel_transmittance(mu, inside.back(), eta));
    rough.push_back(surface.entering(mu));
  }
  std::vector<double> factor(count, 1.0);
  if (eta > 1.0) {
    const std::vector<double> table =
        HalfSpace({1.0, 0.0, half_space_medium(material, 0).g}, eta).interior_table(inside, true);
    const auto sent_back = [&](std::size_t row, const auto& leaving) {
      double sum = 0.0;
      for (std::size_t j = 0; j < nodes; ++j)
        sum += measure[j] * table[row * count + j] / (inside[row] + inside[j]) * leaving(j);
      return sum;
    };
    const auto balanced = [&](std::size_t row) {
      return sent_back(row, [&](std::size_t j) { return smooth[j]; }) /
             sent_back(row, [&](std::size_t j) { return rough[j] * factor[j]; });
    };
    // The root keeps the iteration from swinging (Sinkhorn's, for a symmetric kernel).
    for (int step = 0; step < balance_steps; ++step) {
      std::vector<double> next;
      for (std::size_t i = 0; i < nodes; ++i) next.push_back(std::sqrt(factor[i] * balanced(i)));
      std::copy(next.begin(), next.end(), factor.begin());
    }
    for (std::size_t i = nodes; i < count; ++i) factor[i] = balanced(i);
  }

  Passage passage;
  for (std::size_t i = nodes; i < count; ++i) passage.transmittance.push_back(rough[i] * factor[i]);
  double through_smooth = 0.0, through_rough = 0.0;
  for (std::size_t i = 0; i < nodes; ++i) {
    through_smooth += measure[i] * smooth[i];
    through_rough += measure[i] * rough[i] * factor[i];
  }
  passage.entering_ratio = through_rough / through_smooth;
  return passage;
}

}  // namespace mesograin::physics
