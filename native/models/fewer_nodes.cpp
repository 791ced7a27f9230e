// Least squares, one side of the box after the other: the functions that are linear between nodes of a box are
// products of those that are along its sides.
#include "models/fewer_nodes.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <utility>

namespace mesograin::models {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Takes values at `many` nodes of a line to those at `few`, which tell them best.
Eigen::MatrixXf best_along(int many, int few) {
  Eigen::MatrixXd told = Eigen::MatrixXd::Zero(many, few);  // at many nodes, by each of the few
  for (int node = 0; node < many; ++node) {
    const double place = static_cast<double>(node) * (few - 1) / (many - 1);
    const int before = std::min(static_cast<int>(place), few - 2);
    told(node, before) = 1.0 - (place - before);
    told(node, before + 1) = place - before;
  }
  return (told.transpose() * told).llt().solve(told.transpose()).cast<float>();
}

}  // namespace

std::vector<float> at_fewer_nodes(const std::vector<float>& values, const glm::ivec3& size, const glm::ivec3& fewer) {
  std::vector<float> result = values;
  Eigen::Index inner = 1;  // how many values run faster than those along the side
  Eigen::Index outer = static_cast<Eigen::Index>(size.x) * size.y * size.z;
  for (int side = 0; side < 3; ++side) {
    const Eigen::MatrixXf best = best_along(size[side], fewer[side]);
    outer /= size[side];
    std::vector<float> next(static_cast<std::size_t>(inner * fewer[side] * outer));
    for (Eigen::Index i = 0; i < outer; ++i) {
      const Eigen::Map<const Rows> many(&result[static_cast<std::size_t>(i * inner * size[side])], size[side], inner);
      Eigen::Map<Rows>(&next[static_cast<std::size_t>(i * inner * fewer[side])], fewer[side], inner) = best * many;
    }
    inner *= fewer[side];
    result = std::move(next);
  }
  return result;
}

}  // namespace mesograin::models
