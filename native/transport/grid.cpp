// Lays the nodes out, and finds which side of the surface each is on.
#include "transport/grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "transport/directions.h"
#include "transport/incidence.h"

namespace mesograin::transport {
namespace {

// Where a place counts as being on the surface.
constexpr float on_surface_below = 1e-4F;

// From the surface's nearest point into the body, at edges and corners too.
glm::vec3 inwards(const Nearest& surface, const glm::vec3& place, bool inside) {
  if (surface.distance > 0.1F * on_surface_below)
    return (inside ? place - surface.point : surface.point - place) / surface.distance;
  // Nodes on the surface lie on the box, whose middle is the origin.
  return glm::normalize(-surface.normal - 0.5F * place);
}

}  // namespace

Grid::Grid(const Body& body, int nodes, Spacing spacing, int most_nodes, const Effort& effort, float least_depth) {
  const glm::vec3 extent = glm::max(body.upper() - body.lower(), glm::vec3(1e-4F));
  const glm::vec3 shares = spacing == Spacing::even ? extent : glm::sqrt(extent);
  const glm::vec3 steps = shares * std::cbrt(static_cast<float>(nodes) / (shares.x * shares.y * shares.z));
  // Up to 12 blocks of them, of so many along z, are behind one another in one texture of at least 2048 texels.
  constexpr int most_along = 112;
  const glm::ivec3 most(most_along, most_along, spacing == Spacing::even ? most_along : most_along / 2);
  constexpr int fewest_along = 4;
  size_ = glm::clamp(glm::ivec3(glm::round(steps)) + 1, glm::ivec3(fewest_along), most);
  // Rounded, or for a body so flat that the fewest are many, they may be too many together.
  while (size_.x * size_.y * size_.z > most_nodes) {
    const int longest = size_.x >= std::max(size_.y, size_.z) ? 0 : size_.y >= size_.z ? 1 : 2;
    if (size_[longest] == fewest_along) break;
    --size_[longest];
  }
  spacing_ = extent / glm::vec3(size_ - 1);
  lower_ = body.lower();
  const std::size_t plane = static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y);
  const std::size_t count = plane * static_cast<std::size_t>(size_.z);
  std::vector<float> distances(count);  // from the surface, negative inside
  used_.assign(count, -1);
  std::vector<glm::vec3> nearest(count);
  const float below = std::max(least_depth * std::min({spacing_.x, spacing_.y, spacing_.z}), on_surface_below);
  run_pieces(effort, static_cast<std::size_t>(size_.z), [&](std::size_t z) {
    for (std::size_t i = z * plane; i < (z + 1) * plane; ++i) {
      const glm::ivec3 node(static_cast<int>(i % static_cast<std::size_t>(size_.x)),
                            static_cast<int>(i % plane) / size_.x, static_cast<int>(z));
      const glm::vec3 place = lower_ + glm::vec3(node) * spacing_;
      const Nearest surface = body.nearest(place);
      const bool inside = body.contains(place);
      distances[i] = inside ? -surface.distance : surface.distance;
      nearest[i] = inside && surface.distance > below ? place : surface.point + below * inwards(surface, place, inside);
    }
  });
  const float diagonal = glm::length(spacing_);
  for (std::size_t i = 0; i < count; ++i) {
    if (distances[i] >= diagonal) continue;
    used_[i] = static_cast<int>(places_.size());
    places_.push_back(nearest[i]);
    depths_.push_back(std::max(-distances[i], below));
  }
  list_cells();
  measure_volumes(body);
  choose_deputies();
}

void Grid::list_cells() {
  for (int z = 0; z + 1 < size_.z; ++z)
    for (int y = 0; y + 1 < size_.y; ++y)
      for (int x = 0; x + 1 < size_.x; ++x) {
        Cell cell{{}, true};
        for (unsigned corner = 0; corner < 8; ++corner) {
          const glm::ivec3 step(static_cast<int>(corner & 1U), static_cast<int>(corner >> 1U & 1U),
                                static_cast<int>(corner >> 2U));
          cell.used[corner] = used_[index(glm::ivec3(x, y, z) + step)];
          cell.whole = cell.whole && cell.used[corner] >= 0;
        }
        cells_.push_back(cell);
      }
}

const Grid::Cell& Grid::cell(const glm::vec3& place, glm::vec3& along) const {
  const glm::vec3 scaled = (place - lower_) / spacing_;
  const glm::ivec3 at = glm::clamp(glm::ivec3(scaled), glm::ivec3(0), size_ - 2);
  along = glm::clamp(scaled - glm::vec3(at), 0.0F, 1.0F);
  const int number = (at.z * (size_.y - 1) + at.y) * (size_.x - 1) + at.x;
  return cells_[static_cast<std::size_t>(number)];
}

std::array<Corner, 8> Grid::corners(const glm::vec3& place) const {
  glm::vec3 along;
  const Cell& around = cell(place, along);
  const glm::vec3 rest = 1.0F - along;
  const float low[] = {rest.x * rest.y, along.x * rest.y, rest.x * along.y, along.x * along.y};
  std::array<Corner, 8> result{};
  for (unsigned corner = 0; corner < 8; ++corner)
    result[corner] = {around.used[corner], low[corner & 3U] * (corner < 4 ? rest.z : along.z)};
  if (around.whole) return result;
  // What rounding takes for outside has a corner that is not used.
  float sum = 0.0F;
  for (Corner& corner : result) {
    if (corner.node < 0) corner = {0, 0.0F};
    sum += corner.weight;
  }
  for (Corner& corner : result) corner.weight /= std::max(sum, 1e-6F);
  return result;
}

int Grid::corner(const glm::vec3& place, const glm::vec3& random) const {
  glm::vec3 along;
  const Cell& around = cell(place, along);
  if (around.whole)
    return around
        .used[(random.x < along.x ? 1U : 0U) + (random.y < along.y ? 2U : 0U) + (random.z < along.z ? 4U : 0U)];
  float choice = random.x;
  int node = 0;
  for (const Corner& corner : corners(place)) {
    if (corner.weight <= 0.0F) continue;
    node = corner.node;
    choice -= corner.weight;
    if (choice < 0.0F) break;
  }
  return node;
}

std::size_t Grid::index(const glm::ivec3& node) const {
  const int place = (node.z * size_.y + node.y) * size_.x + node.x;
  return static_cast<std::size_t>(place);
}

void Grid::measure_volumes(const Body& body) {
  // By straight lines from three sides, four through each cell's side.
  const int across = 4 * std::max({size_.x, size_.y, size_.z});
  std::vector<double> volumes(places_.size(), 0.0);
  const float step = 0.25F * std::min({spacing_.x, spacing_.y, spacing_.z});
  const glm::vec3 sides[] = {{1.0F, 0.02F, 0.03F}, {0.03F, 1.0F, 0.02F}, {0.02F, 0.03F, 1.0F}};
  for (const glm::vec3& side : sides) {
    const Incidence incidence(body, side);
    const glm::vec3 direction = -incidence.to_light();
    const double share = incidence.area() / (3.0 * across * across);
    for (int i = 0; i < across * across; ++i) {
      const int row = i / across;
      glm::vec3 place = incidence.start((static_cast<float>(i % across) + 0.5F) / static_cast<float>(across),
                                        (static_cast<float>(row) + 0.5F) / static_cast<float>(across));
      while (const std::optional<Hit> hit = body.first_hit(place, direction)) {
        if (glm::dot(hit->normal, direction) > 0.0F) {
          const int steps = std::max(1, static_cast<int>(std::ceil(hit->distance / step)));
          const float length = hit->distance / static_cast<float>(steps);
          for (int s = 0; s < steps; ++s)
            for (const Corner& corner : corners(place + (static_cast<float>(s) + 0.5F) * length * direction))
              volumes[static_cast<std::size_t>(corner.node)] += share * length * corner.weight;
        }
        place += (hit->distance + 2e-6F) * direction;
      }
    }
  }
  volumes_.assign(volumes.begin(), volumes.end());
}

void Grid::choose_deputies() {
  const float enough = 0.04F * spacing_.x * spacing_.y * spacing_.z;
  deputies_.resize(places_.size());
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (used_[i] < 0) continue;
    const auto self = static_cast<std::size_t>(used_[i]);
    deputies_[self] = used_[i];
    if (volumes_[self] >= enough) continue;
    const auto place = static_cast<int>(i);
    const glm::ivec3 node(place % size_.x, place / size_.x % size_.y, place / (size_.x * size_.y));
    constexpr int reach = 2;
    const glm::ivec3 first = glm::max(node - reach, glm::ivec3(0));
    const glm::ivec3 last = glm::min(node + reach, size_ - 1);
    float nearest = std::numeric_limits<float>::infinity();
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
          const int other = used_[index({x, y, z})];
          if (other < 0 || volumes_[static_cast<std::size_t>(other)] < enough) continue;
          const float apart = glm::distance(lower_ + glm::vec3(x, y, z) * spacing_, places_[self]);
          if (apart >= nearest) continue;
          nearest = apart;
          deputies_[self] = other;
        }
  }
}

}  // namespace mesograin::transport
