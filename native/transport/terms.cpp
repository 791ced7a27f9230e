// Subspace iteration among the rows of light at the nodes.
#include "transport/terms.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "transport/octahedron.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

// Directions that are looked at beside those that are to be found.
constexpr int surplus = 8;

// Rows of a product that are computed at a time.
constexpr Eigen::Index rows_a_piece = 256;

/// Calls work(first, count) for all of `rows`.
template <typename Work>
void in_pieces(const Effort& effort, Eigen::Index rows, const Work& work) {
  Effort quiet = effort;
  quiet.progress = {};
  run_pieces(quiet, static_cast<std::size_t>((rows + rows_a_piece - 1) / rows_a_piece), [&](std::size_t piece) {
    const Eigen::Index first = static_cast<Eigen::Index>(piece) * rows_a_piece;
    work(first, std::min(rows_a_piece, rows - first));
  });
}

/// left^T * right
Eigen::MatrixXf transposed_product(const Lights& left, const Lights& right, const Effort& effort) {
  Eigen::MatrixXf result(left.cols(), right.cols());
  in_pieces(effort, left.cols(), [&](Eigen::Index first, Eigen::Index count) {
    result.middleRows(first, count).noalias() = left.middleCols(first, count).transpose() * right;
  });
  return result;
}

Eigen::MatrixXf orthonormal(const Eigen::MatrixXf& columns) {
  return Eigen::HouseholderQR<Eigen::MatrixXf>(columns).householderQ() *
         Eigen::MatrixXf::Identity(columns.rows(), columns.cols());
}

/// The root of what each direction counts: by its solid angle, and, so that light which hardly enters, for it grazes a
/// flat grain, is told well too, by the root of what it lets in. Where there is none at all they are numbers, too.
Eigen::ArrayXf direction_weights(const Lights& light) {
  const auto side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(light.cols()))));
  const std::vector<float> angles = octahedron_solid_angles(side);
  const Eigen::ArrayXf entered = light.colwise().norm().transpose().array();
  return (Eigen::Map<const Eigen::ArrayXf>(angles.data(), light.cols()) /
          entered.max(std::max(1e-3F * entered.mean(), std::numeric_limits<float>::min())))
      .sqrt();
}

}  // namespace

// Subspace iteration (Halko, Martinsson and Tropp, "Finding structure with randomness", 2011, algorithm 4.4) for the
// row space of sights * light * weights, from the guess's directions and random ones beside them.
Terms principal_terms(const Sights& sights, const Lights& light, const Lobes& guess, int count, const Effort& effort) {
  const Eigen::ArrayXf weights = direction_weights(light);
  const auto weighed = [&](const Eigen::MatrixXf& columns) -> Eigen::MatrixXf {
    return columns.array().colwise() * weights;
  };
  const Lights likely = guess.lobes.bottomRows(std::min<Eigen::Index>(guess.count(), count + surplus));
  Random random(1, 0);
  Eigen::MatrixXf basis(light.cols(), std::max<Eigen::Index>(likely.rows(), count) + surplus);
  for (Eigen::Index i = 0; i < basis.size(); ++i) basis.data()[i] = random.uniform() - 0.5F;
  basis.leftCols(likely.rows()) = weighed(likely.transpose());
  const int turns = likely.rows() > 0 ? 1 : 2;
  for (int turn = 0; turn < turns; ++turn) {
    const Lights seen = sights * product(light, weighed(basis), effort);
    basis = orthonormal(weighed(transposed_product(light, sights.transpose() * seen, effort)));
  }
  const Lights amounts = product(light, weighed(basis), effort);
  const Lights seen = sights * amounts;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(seen.transpose() * seen);
  const Eigen::MatrixXf leading = solver.eigenvectors().rightCols(count);
  const Eigen::MatrixXf directions = basis * leading;
  return {amounts * leading, {weighed(directions), (directions.array().colwise() / weights).matrix().transpose()}};
}

// Amounts of principal terms are coordinates along directions that are orthonormal as weighed there: what is left out
// of them is what is left out of the light. No more of them than are shared need be known.
SharedTerms shared_terms(const Sights& sights, const std::vector<Terms>& channels) {
  if (channels.size() == 1) return {channels.front().amounts, channels.front().told_by.lobes};
  const Eigen::Index count = channels.front().told_by.count();
  const auto all = static_cast<Eigen::Index>(channels.size()) * count;
  Lights amounts(channels.front().amounts.rows(), all);
  std::vector<float> seen_of;
  for (std::size_t channel = 0; channel < channels.size(); ++channel) {
    const Lights& own = channels[channel].amounts;
    seen_of.push_back(Lights(sights * own).norm());
    // What is not seen at all counts nothing.
    const float weight = seen_of.back() > 0.0F ? 1.0F / seen_of.back() : 0.0F;
    amounts.middleCols(static_cast<Eigen::Index>(channel) * count, count) = weight * own;
  }
  const Lights seen = sights * amounts;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(seen.transpose() * seen);
  const Eigen::MatrixXf leading = solver.eigenvectors().rightCols(count);
  const Eigen::Index texels = channels.front().told_by.lobes.cols();
  Lights lobes(count, static_cast<Eigen::Index>(channels.size()) * texels);
  for (std::size_t channel = 0; channel < channels.size(); ++channel) {
    const auto number = static_cast<Eigen::Index>(channel);
    lobes.middleCols(number * texels, texels).noalias() =
        seen_of[channel] * leading.middleRows(number * count, count).transpose() * channels[channel].told_by.lobes;
  }
  return {amounts * leading, lobes};
}

Lights product(const Lights& left, const Eigen::MatrixXf& right, const Effort& effort) {
  Lights result(left.rows(), right.cols());
  in_pieces(effort, left.rows(), [&](Eigen::Index first, Eigen::Index count) {
    result.middleRows(first, count).noalias() = left.middleRows(first, count) * right;
  });
  return result;
}

void add_product(Lights& sum, const Lights& left, const Lights& right, const Effort& effort) {
  in_pieces(effort, left.rows(), [&](Eigen::Index first, Eigen::Index count) {
    sum.middleRows(first, count).noalias() += left.middleRows(first, count) * right;
  });
}

}  // namespace mesograin::transport
