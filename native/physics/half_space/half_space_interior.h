// How a half-space of scattering medium reflects when nothing refracts at its surface: the exact solution for the
// azimuthal average.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "physics/half_space/medium.h"

namespace mesograin::physics {

/// The azimuthally averaged BRDF of a half-space is, for a phase function of Legendre coefficients g^l,
///   f(mu, mu_0) = albedo / (4 pi (mu + mu_0)) * sum_l (2l+1) (-g)^l phi_l(mu) phi_l(mu_0)
/// (Chandrasekhar 1960, section 50; Sobolev 1975, chapter 2). For isotropic scattering one term is left, and phi_0 is
/// Chandrasekhar's H. With Legendre polynomials in place of phi_l the same sum is single scattering.
class HalfSpaceInterior {
 public:
  explicit HalfSpaceInterior(const Medium& medium);

  const Medium& medium() const { return medium_; }

  /// albedo/(4 pi) (2l+1) (-g)^l.
  const Eigen::VectorXd& coefficients() const { return coefficients_; }

  /// phi_l at each cosine: one column for each of `mu`.
  Eigen::MatrixXd functions(const std::vector<double>& mu) const;

  /// P_l at each cosine: one column for each of `mu`.
  Eigen::MatrixXd legendre(const std::vector<double>& mu) const;

  /// The fraction of a beam of cosine mu that comes out again.
  double plane_albedo(double mu) const;

  /// The same for light that arrives evenly from everywhere.
  double spherical_albedo() const;

 private:
  void solve_isotropic();
  void solve_anisotropic();
  Eigen::RowVectorXd reflection_row(double mu) const;

  Medium medium_;
  std::vector<double> mu_;
  std::vector<double> weight_;
  Eigen::VectorXd coefficients_;
  Eigen::VectorXd h_;           // isotropic: H at the nodes
  Eigen::MatrixXd legendre_;    // anisotropic: P_l at the nodes
  Eigen::MatrixXd reflection_;  // anisotropic: upward radiance from downward radiance, node to node
  Eigen::MatrixXd decay_;       // anisotropic: d(downward radiance)/d(optical depth)
};

}  // namespace mesograin::physics
