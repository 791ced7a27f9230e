// Sends rays from every node and asks where along their ways light would have been scattered towards it.
#include "transport/exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "transport/directions.h"
#include "transport/near_extinctions.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

// What is reflected more often is trapped, and scattered somewhere on the way that is known by then.
constexpr int most_reflections = 12;
// Outside, from one part of the body to another.
constexpr int most_reflections_outside = 4;
// Beyond so many mean free paths nothing counts.
constexpr float deepest = 10.0F;
constexpr int samples_a_way = 2;

struct Segment {
  glm::vec3 place;
  glm::vec3 direction;
  float end;  // length of the way up to here
};

// A ray's way through the body.
struct Way {
  std::vector<Segment> segments;
  bool ends_outside = false;

  float length() const { return segments.empty() ? 0.0F : segments.back().end; }

  glm::vec3 place_at(float distance) const {
    float begin = 0.0F;
    for (const Segment& segment : segments) {
      if (distance <= segment.end) return segment.place + (distance - begin) * segment.direction;
      begin = segment.end;
    }
    return segments.back().place;
  }
};

/// Whether a ray that has left the body at `place` comes in again; it goes on from there, inside.
bool comes_in_again(const Body& body, const Interface& interface, glm::vec3& place, glm::vec3& direction,
                    Random& random) {
  if (body.convex()) return false;
  for (int reflections = 0; reflections <= most_reflections_outside; ++reflections) {
    const std::optional<Hit> hit = body.first_hit(place, direction);
    if (!hit || glm::dot(hit->normal, direction) >= 0.0F) return false;
    const Interface::Entry entry = interface.enter(direction, hit->normal, random);
    place += hit->distance * direction;
    direction = entry.inwards;
    if (random.uniform() < entry.passed) return true;
    direction = entry.mirrored;
  }
  return false;
}

void find_way(const Body& body, const Interface& interface, glm::vec3 place, glm::vec3 direction, float longest,
              Random& random, Way& way) {
  way.segments.clear();
  way.ends_outside = true;
  float length = 0.0F;
  for (int reflections = 0; reflections <= most_reflections; ++reflections) {
    const std::optional<Hit> hit = body.first_hit(place, direction);
    if (!hit || glm::dot(hit->normal, direction) <= 0.0F) return;
    length += hit->distance;
    way.segments.push_back({place, direction, length});
    if (interface.matched()) {
      const std::optional<glm::vec3> entry = body.next_entry(place + hit->distance * direction, direction);
      if (!entry) return;
      place = *entry;
      continue;
    }
    const Interface::Reflection reflection = interface.reflect(direction, hit->normal, random);
    place += hit->distance * direction;
    direction = reflection.inwards;
    if (random.uniform() >= reflection.reflected) {
      direction = reflection.beyond;
      if (!comes_in_again(body, interface, place, direction, random)) return;
    }
    if (length > longest) break;
  }
  // What is reflected for ever stays until it is scattered.
  way.ends_outside = false;
}

struct Entry {
  std::uint32_t column;
  float value;
  float distance;
};

struct Row {
  std::vector<Entry> entries;
  std::array<double, near_extinctions> scattered{};
};

/// How likely a way is ended by a scattering.
float scattered_on(const Way& way, float sigma_t) {
  return way.ends_outside ? -std::expm1(-sigma_t * way.length()) : 1.0F;
}

void add_way(const Grid& grid, const Way& way, const std::array<float, near_extinctions>& sigma_t, float share,
             Random& random, Row& row) {
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
    const int node = grid.corner(way.place_at(distance), choice);
    row.entries.push_back({static_cast<std::uint32_t>(node), share * scattered / samples_a_way, distance});
  }
}

/// Makes one of those of each column, the way their mean.
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
    entries[last].value = sum;
  }
  entries.resize(last + 1);
}

}  // namespace

std::vector<TracedExchange> trace_exchange(const Body& body, const Grid& grid, const Interface& interface,
                                           const std::vector<double>& extinctions, int across, const Effort& effort) {
  const std::size_t count = grid.places().size();
  const auto longest =
      static_cast<float>(deepest / std::max(*std::min_element(extinctions.begin(), extinctions.end()), 1e-6));
  const float share = 1.0F / static_cast<float>(across * across);
  std::vector<std::array<float, near_extinctions>> near;
  near.reserve(extinctions.size());
  for (const double sigma_t : extinctions) near.push_back(extinctions_near(sigma_t));
  std::vector<std::vector<Row>> rows(extinctions.size(), std::vector<Row>(count));
  constexpr std::size_t nodes_a_piece = 64;
  run_pieces(effort, (count + nodes_a_piece - 1) / nodes_a_piece, [&](std::size_t piece) {
    Way way;
    for (std::size_t node = piece * nodes_a_piece; node < std::min(count, (piece + 1) * nodes_a_piece); ++node) {
      Random random(effort.seed + 1, node);
      for (int i = 0; i < across * across; ++i) {
        const int row = i / across;
        const glm::vec3 direction = isotropic((static_cast<float>(i % across) + random.uniform()) / across,
                                              (static_cast<float>(row) + random.uniform()) / across);
        find_way(body, interface, grid.places()[node], direction, longest, random, way);
        for (std::size_t e = 0; e < extinctions.size(); ++e) add_way(grid, way, near[e], share, random, rows[e][node]);
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
    exchange.traced.escape.reserve(count);
    exchange.escapes.reserve(near_extinctions * count);
    exchange.traced.first.push_back(0);
    for (Row& row : rows[e]) {
      for (const Entry& entry : row.entries) {
        exchange.traced.columns.push_back(entry.column);
        exchange.traced.values.push_back(entry.value);
        exchange.distances.push_back(entry.distance);
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

}  // namespace mesograin::transport
