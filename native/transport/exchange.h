// How much of the light at a node comes from scattering at every other one: rays from each node, reflected inside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "transport/body.h"
#include "transport/effort.h"
#include "transport/grid.h"
#include "transport/interface.h"
#include "transport/near_extinctions.h"

namespace mesograin::transport {

/// For one extinction, a sparse matrix by rows: mean radiance = entries * source function, and what else arrives at a
/// node comes from outside, unscattered.
struct Exchange {
  std::vector<std::size_t> first;  ///< of each row, and one past the last
  std::vector<std::uint32_t> columns;
  std::vector<float> values;
  std::vector<float> escape;  ///< of each row: the share of directions from which light comes in unscattered

  std::size_t rows() const { return escape.size(); }
};

/// physics::scattered_share_below, in parts of `whole_share`.
using Share = std::uint16_t;
inline constexpr float whole_share = 65535.0F;

/// The same, that knows how long the ways of its entries were, and so what it is at extinctions near its own.
struct TracedExchange {
  Exchange traced;
  double sigma_t = 1.0;            ///< that it was traced at
  std::vector<float> distances;    ///< of each entry: the mean way from the node
  std::vector<Share> shares;       ///< of each entry: the mean where its ways end, if nothing refracts
  std::vector<Logarithm> escapes;  ///< [row][extinction of `near_extinctions`]

  Exchange at(double other_sigma_t) const;

  /// If nothing refracts, of light that was scattered before: entries * source function over the share below of its
  /// node. So over it light is linear between nodes, as it is drawn.
  Exchange of_scattered(double other_sigma_t) const;
};

/// One for each of `extinctions` (sigma_t per unit of the body), all from the same rays, `across` squared a node.
/// `surface` is what surface_distances() told; where something refracts nothing is asked of it.
std::vector<TracedExchange> trace_exchange(const Body& body, const Grid& grid, const Interface& interface,
                                           const std::vector<double>& extinctions, int across,
                                           const std::vector<float>& surface, const Effort& effort);

}  // namespace mesograin::transport
