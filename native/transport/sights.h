// What is seen of the light in a body: pictures of it from all sides, as sums over the nodes' sources.
#pragma once

#include <Eigen/SparseCore>

#include "transport/body.h"
#include "transport/effort.h"
#include "transport/grid.h"

namespace mesograin::transport {

/// A row for each block of each picture, a column for each node.
using Sights = Eigen::SparseMatrix<float, Eigen::RowMajor>;

/// Pictures of 12 x 12 blocks by parallel projection, each as large as the body is from there. A row times the sources
/// of the nodes is the mean radiance of a block, times eta^2.
Sights sights(const Body& body, const Grid& grid, double eta, double sigma_t, const Effort& effort = {});

}  // namespace mesograin::transport
