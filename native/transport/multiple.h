// The light inside a body after any number of scatterings, for many lights at once.
#pragma once

#include <Eigen/Core>

#include "transport/between_nodes.h"
#include "transport/effort.h"
#include "transport/exchange.h"

namespace mesograin::transport {

/// A row for each node, a column for each light.
using Lights = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Solves mean radiance = unscattered + exchange * between * albedo * mean radiance, the equation of transfer for
/// isotropic scattering, by BiCGSTAB (van der Vorst 1992), every column by itself.
Lights solve_multiple(const Exchange& exchange, const BetweenNodes& between, double albedo, const Lights& unscattered,
                      const Effort& effort);

}  // namespace mesograin::transport
