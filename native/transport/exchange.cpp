// Sends rays from every node and asks where along their ways light would have been scattered towards it.
#include "transport/exchange.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "physics/physics.h"
#include "transport/directions.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

// What is reflected more often is trapped, and scattered somewhere on the way that is known by then.
constexpr int most_reflections = 12;
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

void find_way(const Body& body, double eta, glm::vec3 place, glm::vec3 direction, float longest, Random& random,
              Way& way) {
  way.segments.clear();
  way.ends_outside = true;
  float length = 0.0F;
  for (int reflection = 0; reflection <= most_reflections; ++reflection) {
    const std::optional<Hit> hit = body.first_hit(place, direction);
    if (!hit || glm::dot(hit->normal, direction) <= 0.0F) return;
    length += hit->distance;
    way.segments.push_back({place, direction, length});
    if (eta == 1.0) {
      const std::optional<glm::vec3> entry = body.next_entry(place + hit->distance * direction, direction);
      if (!entry) return;
      place = *entry;
      continue;
    }
    const float cosine = std::min(glm::dot(hit->normal, direction), 1.0F);
    if (random.uniform() >= physics::fresnel_reflectance(cosine, 1.0 / eta)) return;
    if (length > longest) break;
    place += hit->distance * direction;
    direction = glm::normalize(direction - 2.0F * cosine * hit->normal);
  }
  // What is reflected for ever stays until it is scattered.
  way.ends_outside = false;
}

struct Row {
  std::vector<std::pair<std::uint32_t, float>> entries;
  double scattered = 0.0;
};

void add_way(const Grid& grid, const Way& way, float sigma_t, float share, Random& random, Row& row) {
  if (way.segments.empty()) return;
  const float within = -std::expm1(-sigma_t * way.length());
  const float scattered = way.ends_outside ? within : 1.0F;
  row.scattered += share * scattered;
  if (!(scattered > 0.0F)) return;
  for (int sample = 0; sample < samples_a_way; ++sample) {
    const float u = (static_cast<float>(sample) + random.uniform()) / samples_a_way;
    const float distance = sigma_t * way.length() > 1e-4F ? -std::log1p(-u * within) / sigma_t : u * way.length();
    float choice = random.uniform();
    std::uint32_t node = 0;
    for (const Corner& corner : grid.corners(way.place_at(distance))) {
      if (corner.weight <= 0.0F) continue;
      node = static_cast<std::uint32_t>(corner.node);
      choice -= corner.weight;
      if (choice < 0.0F) break;
    }
    row.entries.emplace_back(node, share * scattered / samples_a_way);
  }
}

void merge(std::vector<std::pair<std::uint32_t, float>>& entries) {
  std::sort(entries.begin(), entries.end());
  std::size_t last = 0;
  for (std::size_t i = 1; i < entries.size(); ++i)
    if (entries[i].first == entries[last].first)
      entries[last].second += entries[i].second;
    else
      entries[++last] = entries[i];
  if (!entries.empty()) entries.resize(last + 1);
}

}  // namespace

std::vector<Exchange> trace_exchange(const Body& body, const Grid& grid, double eta,
                                     const std::vector<double>& extinctions, int across, const Effort& effort) {
  const std::size_t count = grid.places().size();
  const auto longest =
      static_cast<float>(deepest / std::max(*std::min_element(extinctions.begin(), extinctions.end()), 1e-6));
  const float share = 1.0F / static_cast<float>(across * across);
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
        find_way(body, eta, grid.places()[node], direction, longest, random, way);
        for (std::size_t e = 0; e < extinctions.size(); ++e)
          add_way(grid, way, static_cast<float>(extinctions[e]), share, random, rows[e][node]);
      }
      for (std::vector<Row>& each : rows) merge(each[node].entries);
    }
  });
  std::vector<Exchange> exchanges(extinctions.size());
  for (std::size_t e = 0; e < extinctions.size(); ++e) {
    Exchange& exchange = exchanges[e];
    exchange.first.push_back(0);
    for (Row& row : rows[e]) {
      for (const auto& [column, value] : row.entries) {
        exchange.columns.push_back(column);
        exchange.values.push_back(value);
      }
      exchange.first.push_back(exchange.columns.size());
      exchange.escape.push_back(static_cast<float>(1.0 - row.scattered));
      row.entries = {};
    }
  }
  return exchanges;
}

}  // namespace mesograin::transport
