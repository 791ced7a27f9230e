// A half-space of scattering medium under a smooth interface, solved exactly: what model 1 looks up for its multiple
// scattering.
#pragma once

#include <vector>

#include "physics/half_space/half_space_interior.h"

namespace mesograin::physics {

/// Seen from outside, the BRDF is F_t(mu_i) F_t(mu_o)/eta^2 times the BRDF between the refracted directions, which
/// includes every path that the interface sends back in. eta = 1 is no interface.
class HalfSpace {
 public:
  HalfSpace(const Medium& medium, double eta);

  /// (mu_i' + mu_o') times the azimuthally averaged BRDF between refracted directions, for all pairs of `mu` (cosines
  /// inside): row-major, symmetric. `first_order` says whether scattering once without internal reflection is in it.
  std::vector<double> interior_table(const std::vector<double>& mu, bool first_order) const;

  /// The fraction of light refracted to cosine `mu` (inside) that leaves the medium again.
  double albedo_inside(double mu) const;

  /// The fraction of a beam that meets the interface at cosine `mu` (outside) and comes back from the medium.
  double albedo(double mu) const;

 private:
  Eigen::MatrixXd kernel(const Eigen::MatrixXd& functions_a, const std::vector<double>& mu_a,
                         const Eigen::MatrixXd& functions_b, const std::vector<double>& mu_b) const;

  Eigen::MatrixXd rounds_below(const Eigen::MatrixXd& functions, const std::vector<double>& mu) const;

  HalfSpaceInterior interior_;
  double eta_;
  double conservation_ = 1.0;
  std::vector<double> mu_;             // cosines inside
  Eigen::VectorXd reflected_measure_;  // 2 pi mu F dmu at each: projected solid angle times internal reflectance
  Eigen::VectorXd escaping_measure_;   // 2 pi mu (1 - F) dmu
  Eigen::MatrixXd functions_;          // phi_l at the nodes
  Eigen::MatrixXd internal_paths_;     // (I - K F)^-1 K, node to node, where K is the reflection without the interface
};

}  // namespace mesograin::physics
