// What a grid that is linear between its nodes has wrong of light that bends there, and beyond the surface.
#pragma once

#include <Eigen/SparseCore>

#include "transport/grid.h"

namespace mesograin::transport {

/// Amounts for the nodes in terms of what the light is there: taken to be linear between nodes, they are in the mean
/// over a cell what the light is. What is the same everywhere stays as it is.
using BetweenNodes = Eigen::SparseMatrix<float, Eigen::RowMajor>;

BetweenNodes between_nodes(const Grid& grid);

}  // namespace mesograin::transport
