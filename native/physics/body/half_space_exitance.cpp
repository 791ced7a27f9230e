// The flat surface's integrals over depth are closed.
#include "physics/body/half_space_exitance.h"

#include <algorithm>

#include "physics/half_space/marched_light.h"
#include "physics/half_space/medium.h"
#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int entry_nodes = 16;

// int spread e^{-spread t} e^{-decay t mu} dt / (1 + b decay), over all depths.
double half_space_part(const DiffusionPart& part, double mu_refracted) {
  return part.source / ((1.0 + part.decay / part.spread * mu_refracted) * (1.0 + part.boundary_length * part.decay));
}

}  // namespace

std::vector<double> half_space_multiple_exitance(const BodyMedium& medium, const BodySurface& surface,
                                                 const std::vector<double>& cosines) {
  std::vector<double> exitance(cosines.size(), 0.0);
  if (medium.reduced_sigma_s() <= 0.0) return exitance;
  const DiffusionPart all = all_orders(medium, surface);
  const DiffusionPart first = first_order(medium, surface);
  for (std::size_t i = 0; i < cosines.size(); ++i) {
    const double mu = cosines[i];
    if (mu <= 0.0) continue;
    if (surface.cosine_entry) {
      for (const QuadratureNode& node : gauss_legendre(entry_nodes))
        exitance[i] += mu * 2.0 * node.x * node.weight * half_space_part(all, node.x);
    } else {
      const double mu_refracted = refracted_cosine(mu, surface.eta);
      const double transmittance = surface.eta == 1.0 ? 1.0 : fresnel_transmittance(mu, mu_refracted, surface.eta);
      exitance[i] =
          mu * transmittance * std::max(0.0, half_space_part(all, mu_refracted) - half_space_part(first, mu_refracted));
    }
  }
  return exitance;
}

std::vector<double> half_space_single_exitance(const BodyMedium& medium, double eta,
                                               const std::vector<double>& cosines) {
  std::vector<double> exitance(cosines.size(), 0.0);
  if (medium.sigma_s <= 0.0) return exitance;
  const double sigma_t = medium.sigma_t();
  const Medium unit{medium.sigma_s / sigma_t, medium.sigma_a / sigma_t, medium.g};
  std::vector<double> mu_in;
  mu_in.reserve(cosines.size());
  for (const double mu : cosines) mu_in.push_back(refracted_cosine(std::max(mu, 0.0), eta));
  // Over the cosine outside, where transmission has no kink: mu' dmu' = mu dmu/eta^2 inside.
  const std::vector<QuadratureNode>& nodes = gauss_legendre(48);
  std::vector<double> mu_out;
  mu_out.reserve(nodes.size());
  for (const QuadratureNode& node : nodes) mu_out.push_back(refracted_cosine(node.x, eta));
  const std::vector<double> scattered = marched_in_half_space(unit, tabulated_g(medium.g), mu_in, mu_out);
  for (std::size_t i = 0; i < cosines.size(); ++i) {
    const double mu = cosines[i];
    if (mu <= 0.0) continue;
    double sum = 0.0;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const double transmittance = eta == 1.0 ? 1.0 : fresnel_transmittance(nodes[j].x, mu_out[j], eta);
      sum += nodes[j].weight * nodes[j].x / (eta * eta) * transmittance * scattered[j * cosines.size() + i] /
             std::max(mu_out[j] + mu_in[i], 1e-12);
    }
    exitance[i] = 2.0 * PI * mu * (eta == 1.0 ? 1.0 : fresnel_transmittance(mu, mu_in[i], eta)) * sum;
  }
  return exitance;
}

}  // namespace mesograin::physics
