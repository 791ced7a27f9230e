// By quadrature over the visible normals, and over cosines for the mean.
#include "physics/half_space/facet_energy.h"

#include "physics/half_space/dielectric_surface.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int columns = 32;
constexpr int mean_nodes = 12;
constexpr double mirror_eta = 1e6;  // reflects all but 4e-6, straight on

}  // namespace

Table facet_energy(double eta, const std::vector<double>& roughnesses, scene::Masking masking) {
  Table table{columns, static_cast<int>(roughnesses.size()), {}};
  for (const double roughness : roughnesses) {
    const RoughDielectric mirrors(mirror_eta, roughness * roughness, masking);
    const RoughDielectric facets(eta, roughness * roughness, masking);
    double mean = 0.0;
    // mu = x^2, where a smooth surface changes fastest.
    for (const QuadratureNode& node : gauss_legendre(mean_nodes))
      mean += 4.0 * node.weight * node.x * node.x * node.x * mirrors.reflected(node.x * node.x);
    for (int column = 0; column < columns; ++column) {
      const double root = static_cast<double>(column) / (columns - 1);
      table.texels.emplace_back(mirrors.reflected(root * root), facets.reflected(root * root), mean, 0.0);
    }
  }
  return table;
}

}  // namespace mesograin::physics
