// Isotropic media by the H function, anisotropic ones by discrete ordinates and structured doubling.
#include "physics/half_space/half_space_interior.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "physics/physics.h"
#include "physics/quadrature.h"

namespace mesograin::physics {
namespace {

constexpr int ordinates = 40;
constexpr double smallest_coefficient = 1e-4;  // Legendre terms below this are dropped
constexpr int largest_degree = 2 * ordinates;

int degree_for(const Medium& medium) {
  if (medium.g == 0.0 || medium.albedo == 0.0) return 0;
  const double degree = std::ceil(std::log(smallest_coefficient) / std::log(std::abs(medium.g)));
  return static_cast<int>(std::clamp(degree, 1.0, static_cast<double>(largest_degree)));
}

double sign_of_order(Eigen::Index order) { return order % 2 == 0 ? 1.0 : -1.0; }

}  // namespace

HalfSpaceInterior::HalfSpaceInterior(const Medium& medium) : medium_(medium) {
  const int degree = degree_for(medium);
  coefficients_.resize(degree + 1);
  for (int l = 0; l <= degree; ++l)
    coefficients_[l] = medium.albedo / (4.0 * PI) * (2 * l + 1) * std::pow(-medium.g, l);
  if (degree == 0)
    solve_isotropic();
  else
    solve_anisotropic();
}

Eigen::MatrixXd HalfSpaceInterior::legendre(const std::vector<double>& mu) const {
  Eigen::MatrixXd values(coefficients_.size(), mu.size());
  for (std::size_t column = 0; column < mu.size(); ++column) {
    values(0, column) = 1.0;
    if (values.rows() > 1) values(1, column) = mu[column];
    for (Eigen::Index l = 2; l < values.rows(); ++l)
      values(l, column) = ((2 * l - 1) * mu[column] * values(l - 1, column) - (l - 1) * values(l - 2, column)) / l;
  }
  return values;
}

// 1/H(mu) = sqrt(1 - albedo) + albedo/2 int mu' H(mu')/(mu + mu') dmu' (Chandrasekhar 1960, section 38), iterated as
// Bosma & de Rooij 1983 recommend: unlike the direct form it converges for a conservative medium, to the physical one
// of two solutions.
void HalfSpaceInterior::solve_isotropic() {
  // H is smooth but for mu log(mu): in x with mu = x^2 that is gentle enough for Gauss-Legendre.
  for (const QuadratureNode& node : gauss_legendre(ordinates)) {
    mu_.push_back(node.x * node.x);
    weight_.push_back(2.0 * node.x * node.weight);
  }
  h_ = Eigen::VectorXd::Ones(ordinates);
  for (int iteration = 0; iteration < 200; ++iteration) {
    Eigen::VectorXd next(ordinates);
    for (int i = 0; i < ordinates; ++i) {
      double sum = std::sqrt(medium_.one_minus_albedo);
      for (int j = 0; j < ordinates; ++j) sum += 0.5 * medium_.albedo * weight_[j] * mu_[j] * h_[j] / (mu_[i] + mu_[j]);
      next[i] = 1.0 / sum;
    }
    const double change = (next - h_).cwiseAbs().maxCoeff();
    h_ = 0.5 * (h_ + next);
    if (change < 1e-13) break;
  }
}

// With upward radiance U = K D, downward radiance D and M = diag(mu), the transfer equation on both sides of the
// azimuthal average gives
//   K C K - K A - A K + C = 0,  A = M^-1 (I - a P+ W),  C = M^-1 a P- W,  a = albedo/2,
// whose least non-negative solution is the reflection of the half-space. Structured doubling (Guo, Lin & Xu 2006),
// which is adding-doubling that starts from a thick layer; the two Riccati equations of the general case are one here,
// since up and down are alike.
void HalfSpaceInterior::solve_anisotropic() {
  // Plain Gauss-Legendre, on which Legendre polynomials stay orthogonal: what a conservative medium scatters is kept to
  // the last digit.
  for (const QuadratureNode& node : gauss_legendre(ordinates)) {
    mu_.push_back(node.x);
    weight_.push_back(node.weight);
  }
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(ordinates, ordinates);
  legendre_ = legendre(mu_);
  const Eigen::Map<const Eigen::VectorXd> mu(mu_.data(), ordinates);
  const Eigen::Map<const Eigen::VectorXd> weight(weight_.data(), ordinates);
  // 2 pi coefficients are a (2l+1) (-g)^l: P- as it stands, P+ with the alternating sign taken off.
  const Eigen::VectorXd backward = 2.0 * PI * coefficients_;
  Eigen::VectorXd forward = backward;
  for (Eigen::Index l = 1; l < forward.size(); l += 2) forward[l] = -forward[l];
  Eigen::MatrixXd scatter_forward = legendre_.transpose() * forward.asDiagonal() * legendre_ * weight.asDiagonal();
  const Eigen::MatrixXd scatter_backward =
      legendre_.transpose() * backward.asDiagonal() * legendre_ * weight.asDiagonal();
  // What the quadrature makes of a phase function does not integrate to 1 exactly; the forward direction takes the rest
  // (Grant & Hunt 1969).
  const Eigen::VectorXd scattered = (scatter_forward + scatter_backward).rowwise().sum();
  scatter_forward.diagonal() += Eigen::VectorXd::Constant(ordinates, medium_.albedo) - scattered;

  const Eigen::MatrixXd a = mu.cwiseInverse().asDiagonal() * (identity - scatter_forward);
  const Eigen::MatrixXd c = mu.cwiseInverse().asDiagonal() * scatter_backward;
  const double gamma = a.diagonal().maxCoeff();
  const Eigen::PartialPivLU<Eigen::MatrixXd> shifted(a + gamma * identity);
  const Eigen::PartialPivLU<Eigen::MatrixXd> schur(a + gamma * identity - c * shifted.solve(c));
  Eigen::MatrixXd transmission = identity - 2.0 * gamma * schur.inverse();
  reflection_ = 2.0 * gamma * schur.solve(c * shifted.inverse());
  for (int doubling = 0; doubling < 60; ++doubling) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> between(identity - reflection_ * reflection_);
    const Eigen::MatrixXd change = transmission * between.solve(reflection_ * transmission);
    transmission = transmission * between.solve(transmission);
    reflection_ += change;
    if (change.cwiseAbs().maxCoeff() < 1e-13) break;
  }
  decay_ = -a + c * reflection_;
}

// The reflection seen along any cosine: one more ordinate of weight zero. Its upward radiance k D obeys
// k (I - mu decay) = a (p- W + p+ W K), because the downward radiance changes with depth by `decay`.
Eigen::RowVectorXd HalfSpaceInterior::reflection_row(double mu) const {
  const Eigen::Map<const Eigen::VectorXd> weight(weight_.data(), ordinates);
  const Eigen::VectorXd own = legendre({mu}).col(0);
  Eigen::VectorXd backward = 2.0 * PI * coefficients_.cwiseProduct(own);
  Eigen::VectorXd forward = backward;
  for (Eigen::Index l = 1; l < forward.size(); l += 2) forward[l] = -forward[l];
  const Eigen::RowVectorXd scatter_backward = backward.transpose() * legendre_ * weight.asDiagonal();
  Eigen::RowVectorXd scatter_forward = forward.transpose() * legendre_ * weight.asDiagonal();
  scatter_forward *= (medium_.albedo - scatter_backward.sum()) / scatter_forward.sum();
  const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(ordinates, ordinates) - mu * decay_;
  return system.transpose()
      .partialPivLu()
      .solve((scatter_backward + scatter_forward * reflection_).transpose())
      .transpose();
}

Eigen::MatrixXd HalfSpaceInterior::functions(const std::vector<double>& mu) const {
  Eigen::MatrixXd values = legendre(mu);
  for (std::size_t column = 0; column < mu.size(); ++column) {
    if (coefficients_.size() == 1) {
      double sum = std::sqrt(medium_.one_minus_albedo);
      for (int j = 0; j < ordinates; ++j)
        sum += 0.5 * medium_.albedo * weight_[j] * mu_[j] * h_[j] / (mu[column] + mu_[j]);
      values(0, column) = 1.0 / sum;
      continue;
    }
    // phi_l(mu) = P_l(mu) + (-1)^l 2 mu int R(mu, mu') P_l(mu') dmu' (Sobolev 1975 eq. 2.60).
    Eigen::RowVectorXd row = reflection_row(mu[column]);
    for (int j = 0; j < ordinates; ++j) row[j] *= mu[column] / mu_[j];
    const Eigen::VectorXd reflected = legendre_ * row.transpose();
    for (Eigen::Index l = 0; l < values.rows(); ++l) values(l, column) += sign_of_order(l) * reflected[l];
  }
  return values;
}

double HalfSpaceInterior::plane_albedo(double mu) const {
  // For isotropic scattering: 1 - sqrt(1 - albedo) H(mu) (Chandrasekhar 1960, section 38).
  if (coefficients_.size() == 1) return 1.0 - std::sqrt(medium_.one_minus_albedo) * functions({mu})(0, 0);
  return reflection_row(mu).dot(Eigen::RowVectorXd::Ones(ordinates));
}

double HalfSpaceInterior::spherical_albedo() const {
  double sum = 0.0;
  for (int j = 0; j < ordinates; ++j) sum += 2.0 * weight_[j] * mu_[j] * plane_albedo(mu_[j]);
  return sum;
}

}  // namespace mesograin::physics
