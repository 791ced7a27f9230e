// Frames a map, and fits one of fewer texels to it, along one side after the other.
#include "models/lobe_maps.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>

namespace mesograin::models {
namespace {

using Map = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int whole_side = transport::octahedron_side;

/// Takes what is at the framed map's texels along a side to those of one with fewer, which tell them best.
Eigen::MatrixXf best_along(int side) {
  Eigen::MatrixXd told = Eigen::MatrixXd::Zero(framed(whole_side), framed(side));  // by each of the fewer
  for (int texel = 0; texel < framed(whole_side); ++texel) {
    const double place = (texel - 0.5) * side / whole_side + 0.5;
    const int before = static_cast<int>(place);
    told(texel, before) = 1.0 - (place - before);
    told(texel, before + 1) = place - before;
  }
  return (told.transpose() * told).llt().solve(told.transpose()).cast<float>();
}

}  // namespace

std::vector<float> framed_map(const std::vector<float>& lobe, int side) {
  Map map(framed(whole_side), framed(whole_side));
  for (int y = 0; y < framed(whole_side); ++y)
    for (int x = 0; x < framed(whole_side); ++x)
      map(y, x) = lobe[static_cast<std::size_t>(transport::octahedron_texel(x - 1, y - 1))];
  if (side < whole_side) {
    const Eigen::MatrixXf best = best_along(side);
    map = Map(best * map * best.transpose());
  }
  return {map.data(), map.data() + map.size()};
}

}  // namespace mesograin::models
