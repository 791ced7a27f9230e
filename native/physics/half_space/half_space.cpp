// A smooth interface keeps the cosine of what it reflects, so that internal reflection closes as a small linear system.
#include "physics/half_space/half_space.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int nodes_per_interval = 40;

}  // namespace

HalfSpace::HalfSpace(const Medium& medium, double eta) : interior_(medium), eta_(eta) {
  if (eta == 1.0) return;
  std::vector<double> reflected;
  std::vector<double> escaping;
  const auto add_node = [&](double mu, double weight, double transmittance) {
    mu_.push_back(mu);
    reflected.push_back(2.0 * PI * mu * weight * (1.0 - transmittance));
    escaping.push_back(2.0 * PI * mu * weight * transmittance);
  };
  // Below the critical angle's cosine everything is reflected; above it the cosine outside is the smooth variable. At
  // an interface to a denser outside the cosine inside is. Squares of a variable again, for what happens at grazing.
  const double critical = eta > 1.0 ? std::sqrt((eta - 1.0) * (eta + 1.0)) / eta : 0.0;
  for (const QuadratureNode& node : gauss_legendre(nodes_per_interval)) {
    const double square = node.x * node.x;
    const double weight = 2.0 * node.x * node.weight;
    if (eta > 1.0) {
      add_node(critical * square, critical * weight, 0.0);
      const double mu = refracted_cosine(square, eta);
      add_node(mu, weight * square / (eta * eta * mu), fresnel_transmittance(square, mu, eta));
    } else {
      add_node(square, weight, fresnel_transmittance(square, refracted_cosine(square, 1.0 / eta), 1.0 / eta));
    }
  }
  reflected_measure_ = Eigen::Map<Eigen::VectorXd>(reflected.data(), reflected.size());
  escaping_measure_ = Eigen::Map<Eigen::VectorXd>(escaping.data(), escaping.size());
  functions_ = interior_.functions(mu_);
  const Eigen::MatrixXd between = kernel(functions_, mu_, functions_, mu_);
  const Eigen::MatrixXd reflect = between * reflected_measure_.asDiagonal();
  internal_paths_ = (Eigen::MatrixXd::Identity(reflect.rows(), reflect.cols()) - reflect).partialPivLu().solve(between);
  // A conservative medium returns everything, and many internal reflections amplify what rounding adds to that.
  double largest_albedo = 1.0;
  for (const double mu : mu_) largest_albedo = std::max(largest_albedo, albedo_inside(mu));
  conservation_ = 1.0 / largest_albedo;
}

Eigen::MatrixXd HalfSpace::kernel(const Eigen::MatrixXd& functions_a, const std::vector<double>& mu_a,
                                  const Eigen::MatrixXd& functions_b, const std::vector<double>& mu_b) const {
  Eigen::MatrixXd values = functions_a.transpose() * interior_.coefficients().asDiagonal() * functions_b;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index j = 0; j < values.cols(); ++j) values(i, j) /= std::max(mu_a[i] + mu_b[j], 1e-300);
  return values;
}

// In, by one reflection at the interface, any number of rounds below it, and out.
Eigen::MatrixXd HalfSpace::rounds_below(const Eigen::MatrixXd& functions, const std::vector<double>& mu) const {
  const Eigen::MatrixXd to_nodes = kernel(functions, mu, functions_, mu_);
  const Eigen::MatrixXd reflected_in = to_nodes * reflected_measure_.asDiagonal();
  return reflected_in * (to_nodes.transpose() + internal_paths_ * reflected_in.transpose());
}

std::vector<double> HalfSpace::interior_table(const std::vector<double>& mu, bool first_order) const {
  const Eigen::MatrixXd functions = interior_.functions(mu);
  Eigen::MatrixXd straight = functions.transpose() * interior_.coefficients().asDiagonal() * functions;
  if (!first_order) {
    const Eigen::MatrixXd legendre = interior_.legendre(mu);
    straight -= legendre.transpose() * interior_.coefficients().asDiagonal() * legendre;
  }
  Eigen::MatrixXd rounds = Eigen::MatrixXd::Zero(straight.rows(), straight.cols());
  if (eta_ != 1.0) rounds = rounds_below(functions, mu);
  std::vector<double> table;
  table.reserve(mu.size() * mu.size());
  for (std::size_t row = 0; row < mu.size(); ++row)
    for (std::size_t column = 0; column < mu.size(); ++column)
      table.push_back(conservation_ *
                      std::max(0.0, straight(row, column) +
                                        (mu[row] + mu[column]) * 0.5 * (rounds(row, column) + rounds(column, row))));
  return table;
}

double HalfSpace::albedo_inside(double mu) const {
  if (eta_ == 1.0) return std::min(interior_.plane_albedo(mu), 1.0);
  const Eigen::VectorXd to_nodes = kernel(functions_, mu_, interior_.functions({mu}), {mu});
  const Eigen::VectorXd arriving = to_nodes + internal_paths_ * reflected_measure_.cwiseProduct(to_nodes);
  return conservation_ * arriving.dot(escaping_measure_);
}

double HalfSpace::albedo(double mu) const {
  if (eta_ == 1.0) return albedo_inside(mu);
  const double mu_refracted = refracted_cosine(mu, eta_);
  return fresnel_transmittance(mu, mu_refracted, eta_) * albedo_inside(mu_refracted);
}

}  // namespace mesograin::physics
