// Sends rays from every node and asks where along their ways light would have been scattered towards it.
#include "transport/exchange.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/physics.h"
#include "transport/directions.h"
#include "transport/near_extinctions.h"
#include "transport/random.h"
#include "transport/surface.h"
#include "transport/way_back.h"

namespace mesograin::transport {
namespace {

// Beyond so many mean free paths nothing counts.
constexpr float deepest = 10.0F;
constexpr int samples_a_way = 2;

struct Entry {
  std::uint32_t column;
  float value;
  float distance;
  float share;  // below the surface
};

struct Row {
  std::vector<Entry> entries;
  std::array<double, near_extinctions> scattered{};
};

/// How likely a way is ended by a scattering.
float scattered_on(const WayBack& way, float sigma_t) {
  return way.ends_outside ? -std::expm1(-sigma_t * way.length()) : 1.0F;
}

/// `share_at` tells the share below of a place.
template <typename ShareAt>
void add_way(const Grid& grid, const WayBack& way, const std::array<float, near_extinctions>& sigma_t, float share,
             const ShareAt& share_at, Random& random, Row& row) {
  if (way.segments.empty()) return;
  for (std::size_t e = 0; e < near_extinctions; ++e) row.scattered[e] += share * scattered_on(way, sigma_t[e]);
  const float middle = sigma_t[near_middle];
  const float within = -std::expm1(-middle * way.length());
  const float scattered = scattered_on(way, middle);
  if (!(scattered > 0.0F)) return;
  for (int sample = 0; sample < samples_a_way; ++sample) {
    const float u = (static_cast<float>(sample) + random.uniform()) / samples_a_way;
    const float distance = middle * way.length() > 1e-4F ? -std::log1p(-u * within) / middle : u * way.length();
    const glm::vec3 choice(random.uniform(), random.uniform(), random.uniform());
    const glm::vec3 place = way.place_at(distance);
    row.entries.push_back({static_cast<std::uint32_t>(grid.corner(place, choice)), share * scattered / samples_a_way,
                           distance, share_at(place, middle)});
  }
}

/// Makes one of those of each column, the way and the share their mean.
void merge(std::vector<Entry>& entries) {
  if (entries.empty()) return;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
  std::size_t last = 0;
  for (std::size_t i = 1; i < entries.size(); ++i) {
    if (entries[i].column != entries[last].column) {
      entries[++last] = entries[i];
      continue;
    }
    const float sum = entries[last].value + entries[i].value;
    entries[last].distance += (entries[i].distance - entries[last].distance) * entries[i].value / sum;
    entries[last].share += (entries[i].share - entries[last].share) * entries[i].value / sum;
    entries[last].value = sum;
  }
  entries.resize(last + 1);
}

/// What shares at an extinction are at another, `change` times as large.
class ChangedShares {
 public:
  explicit ChangedShares(double change) {
    constexpr int halvings = 40;
    for (std::size_t i = 0; i < known; ++i) {
      const double share = static_cast<double>(i) / (known - 1);
      double above = 0.0, below = 40.0;  // depths
      for (int turn = 0; turn < halvings; ++turn) {
        const double middle = 0.5 * (above + below);
        (physics::scattered_share_below(middle) < share ? above : below) = middle;
      }
      changed_[i] = static_cast<float>(physics::scattered_share_below(change * above));
    }
  }

  float operator()(Share share) const {
    const float place = static_cast<float>(share) * (static_cast<float>(known - 1) / whole_share);
    const auto low = std::min(static_cast<std::size_t>(place), known - 2);
    return changed_[low] + (place - static_cast<float>(low)) * (changed_[low + 1] - changed_[low]);
  }

 private:
  static constexpr std::size_t known = 1024;

  std::array<float, known> changed_{};
};

}  // namespace

std::vector<TracedExchange> trace_exchange(const Body& body, const Grid& grid, const Interface& interface,
                                           const std::vector<double>& extinctions, int across,
                                           const std::vector<float>& surface, const Effort& effort) {
  const std::size_t count = grid.places().size();
  const auto longest =
      static_cast<float>(deepest / std::max(*std::min_element(extinctions.begin(), extinctions.end()), 1e-6));
  const float share = 1.0F / static_cast<float>(across * across);
  std::vector<std::array<float, near_extinctions>> near;
  near.reserve(extinctions.size());
  for (const double sigma_t : extinctions) near.push_back(extinctions_near(sigma_t));
  std::vector<std::vector<Row>> rows(extinctions.size(), std::vector<Row>(count));
  const auto share_at = [&](const glm::vec3& place, float sigma_t) {
    if (!interface.matched()) return 1.0F;
    const float depth = std::max(-distance_at(grid, surface, place), 0.0F);
    return static_cast<float>(physics::scattered_share_below(sigma_t * depth));
  };
  constexpr std::size_t nodes_a_piece = 64;
  run_pieces(effort, (count + nodes_a_piece - 1) / nodes_a_piece, [&](std::size_t piece) {
    WayBack way;
    for (std::size_t node = piece * nodes_a_piece; node < std::min(count, (piece + 1) * nodes_a_piece); ++node) {
      Random random(effort.seed + 1, node);
      for (int i = 0; i < across * across; ++i) {
        const int row = i / across;
        const glm::vec3 direction = isotropic((static_cast<float>(i % across) + random.uniform()) / across,
                                              (static_cast<float>(row) + random.uniform()) / across);
        find_way(body, interface, grid.places()[node], direction, longest, random, way);
        for (std::size_t e = 0; e < extinctions.size(); ++e)
          add_way(grid, way, near[e], share, share_at, random, rows[e][node]);
      }
      for (std::vector<Row>& each : rows) merge(each[node].entries);
    }
  });
  std::vector<TracedExchange> exchanges(extinctions.size());
  for (std::size_t e = 0; e < extinctions.size(); ++e) {
    TracedExchange& exchange = exchanges[e];
    exchange.sigma_t = extinctions[e];
    std::size_t entries = 0;
    for (const Row& row : rows[e]) entries += row.entries.size();
    exchange.traced.first.reserve(count + 1);
    exchange.traced.columns.reserve(entries);
    exchange.traced.values.reserve(entries);
    exchange.distances.reserve(entries);
    if (interface.matched()) exchange.shares.reserve(entries);
    exchange.traced.escape.reserve(count);
    exchange.escapes.reserve(near_extinctions * count);
    exchange.traced.first.push_back(0);
    for (Row& row : rows[e]) {
      for (const Entry& entry : row.entries) {
        exchange.traced.columns.push_back(entry.column);
        exchange.traced.values.push_back(entry.value);
        exchange.distances.push_back(entry.distance);
        if (interface.matched())
          exchange.shares.push_back(static_cast<Share>(std::lround(whole_share * std::min(entry.share, 1.0F))));
      }
      exchange.traced.first.push_back(exchange.traced.columns.size());
      exchange.traced.escape.push_back(static_cast<float>(1.0 - row.scattered[near_middle]));
      for (const double scattered : row.scattered)
        exchange.escapes.push_back(known_logarithm(static_cast<float>(1.0 - scattered)));
      row.entries = {};
    }
  }
  return exchanges;
}

// What came a way d was met with the density sigma_t exp(-sigma_t d).
Exchange TracedExchange::at(double other_sigma_t) const {
  Exchange exchange = traced;
  const auto change = static_cast<float>(other_sigma_t - sigma_t);
  if (change == 0.0F) return exchange;
  const NearWeights weights(sigma_t, other_sigma_t);
  for (std::size_t row = 0; row < exchange.rows(); ++row) {
    exchange.escape[row] = weights.decayed(&escapes[row * near_extinctions]);
    double sum = 0.0;
    for (std::size_t entry = exchange.first[row]; entry < exchange.first[row + 1]; ++entry)
      sum += exchange.values[entry] *= std::exp(-change * distances[entry]);
    const float right = (1.0F - exchange.escape[row]) / static_cast<float>(std::max(sum, 1e-30));
    for (std::size_t entry = exchange.first[row]; entry < exchange.first[row + 1]; ++entry)
      exchange.values[entry] *= right;
  }
  return exchange;
}

Exchange TracedExchange::of_scattered(double other_sigma_t) const {
  Exchange exchange = at(other_sigma_t);
  const ChangedShares changed(other_sigma_t / sigma_t);
  for (std::size_t entry = 0; entry < shares.size(); ++entry) exchange.values[entry] *= changed(shares[entry]);
  return exchange;
}

}  // namespace mesograin::transport
