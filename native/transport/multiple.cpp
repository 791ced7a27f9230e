// A Krylov method, for at albedo 1 light in a thick body is scattered hundreds of times.
#include "transport/multiple.h"

#include <algorithm>

namespace mesograin::transport {
namespace {

constexpr int most_steps = 200;
constexpr float tolerance = 1e-4F;

// (1 - albedo * exchange * between) * light
Lights removed(const Exchange& exchange, const BetweenNodes& between, float albedo, const Lights& light,
               const Effort& effort) {
  const Lights sources = between * light;
  Lights result(light.rows(), light.cols());
  constexpr std::size_t rows_a_piece = 512;
  Effort quiet = effort;
  quiet.progress = {};
  run_pieces(quiet, (exchange.rows() + rows_a_piece - 1) / rows_a_piece, [&](std::size_t piece) {
    for (std::size_t row = piece * rows_a_piece; row < std::min(exchange.rows(), (piece + 1) * rows_a_piece); ++row) {
      const auto i = static_cast<Eigen::Index>(row);
      result.row(i).setZero();
      for (std::size_t entry = exchange.first[row]; entry < exchange.first[row + 1]; ++entry)
        result.row(i) += exchange.values[entry] * sources.row(exchange.columns[entry]);
      result.row(i) = light.row(i) - albedo * result.row(i);
    }
  });
  return result;
}

Eigen::RowVectorXf products(const Lights& a, const Lights& b) { return a.cwiseProduct(b).colwise().sum(); }

// A column that is solved already takes no further step.
Eigen::RowVectorXf ratios(const Eigen::RowVectorXf& above, const Eigen::RowVectorXf& below) {
  return (below.array().abs() > 1e-30F).select(above.array() / below.array(), 0.0F).matrix();
}

Lights scaled(const Lights& columns, const Eigen::RowVectorXf& factors) {
  return columns.array().rowwise() * factors.array();
}

}  // namespace

Lights solve_multiple(const Exchange& exchange, const BetweenNodes& between, double albedo, const Lights& unscattered,
                      const Effort& effort) {
  const auto a = static_cast<float>(albedo);
  Lights light = unscattered;
  Lights residual = unscattered - removed(exchange, between, a, light, effort);
  const Lights shadow = residual;
  Lights direction = residual;
  Eigen::RowVectorXf rho = products(shadow, residual);
  const Eigen::RowVectorXf enough =
      tolerance * tolerance * products(unscattered, unscattered).array().max(1e-30F).matrix();
  for (int step = 0; step < most_steps; ++step) {
    if ((products(residual, residual).array() <= enough.array()).all()) break;
    if (effort.progress) effort.progress(step / (step + 8.0));
    const Lights moved = removed(exchange, between, a, direction, effort);
    const Eigen::RowVectorXf alpha = ratios(rho, products(shadow, moved));
    light += scaled(direction, alpha);
    residual -= scaled(moved, alpha);
    const Lights turned = removed(exchange, between, a, residual, effort);
    const Eigen::RowVectorXf omega = ratios(products(turned, residual), products(turned, turned));
    light += scaled(residual, omega);
    residual -= scaled(turned, omega);
    const Eigen::RowVectorXf next = products(shadow, residual);
    const Eigen::RowVectorXf beta = ratios(next.cwiseProduct(alpha), rho.cwiseProduct(omega));
    direction = residual + scaled(direction - scaled(moved, omega), beta);
    rho = next;
  }
  return light;
}

}  // namespace mesograin::transport
