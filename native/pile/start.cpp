// A lattice with room for each grain however it is turned.
#include "pile/start.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace mesograin::pile {
namespace {

constexpr double loose = 1.05;   // how far grains are apart before they fall
constexpr double narrow = 0.32;  // half a free column's width, over the side of a cube as large; of few grains
constexpr double wide = 0.45;    // of so many that a higher column would take long to fall
constexpr double many = 5000.0;
constexpr double compact = 0.6;    // shortest over longest extent; such grains fall turned anyhow
constexpr double most_tilt = 0.3;  // radians, of others
constexpr double too_steep = 4.0;  // a rise over its run; nothing falls right beside such a wall
constexpr double well_away = 1.8;  // from an edge of what they fall on, in their reach
constexpr int around = 8;          // places around a spot where the ground is asked for

struct Spot {
  double x, y;
};

double half_height(const Shape& shape) {
  if (is_compact(shape)) return shape.reach;
  return std::min(shape.reach, shape.half[2] * std::cos(most_tilt) + shape.half[0] * std::sin(most_tilt));
}

std::vector<Spot> lattice(const glm::dvec2& room, double spacing) {
  const auto columns = std::max(1, static_cast<int>(2.0 * room.x / spacing) + 1);
  const auto rows = std::max(1, static_cast<int>(2.0 * room.y / spacing) + 1);
  const auto along = [](int number, int count, double reach) {
    return count > 1 ? -reach + 2.0 * reach * number / (count - 1) : 0.0;
  };
  std::vector<Spot> spots;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      spots.push_back({along(column, columns, room.x), along(row, rows, room.y)});
  return spots;
}

// The same within the circle of as much area: a heap is round.
std::vector<Spot> round_lattice(const glm::dvec2& half, double spacing) {
  const glm::dvec2 room = 2.0 * std::numbers::inv_sqrtpi * half;
  std::vector<Spot> spots = lattice(room, spacing);
  const auto outside = [&](const Spot& spot) {
    constexpr double within = 1.0 + 1e-9;
    return glm::length(glm::dvec2(spot.x, spot.y) / room) > within;
  };
  spots.erase(std::remove_if(spots.begin(), spots.end(), outside), spots.end());
  return spots.empty() ? std::vector<Spot>{{0.0, 0.0}} : spots;
}

// The height there if a grain that reaches so far falls on the surface and not beside it.
std::optional<double> height_under(const Triangles& surface, const Spot& spot, double reach) {
  const auto height = surface.height(spot.x, spot.y);
  if (!height) return height;
  for (int i = 0; i < around; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / around;
    const auto beside = surface.height(spot.x + reach * std::cos(angle), spot.y + reach * std::sin(angle));
    if (!beside || std::abs(*beside - *height) > too_steep * reach) return std::nullopt;
  }
  return height;
}

// Leaves the spots above the surface, those well away from its edges if there are any, and all if it is too narrow for
// any: nothing shall fall on a vessel's rim. Returns the highest place below them.
double leave_those_above(std::vector<Spot>& spots, const Triangles& surface, double reach) {
  for (const double from_edges : {well_away * reach, reach}) {
    std::vector<Spot> above;
    double highest = -std::numeric_limits<double>::infinity();
    for (const Spot& spot : spots) {
      const auto height = height_under(surface, spot, from_edges);
      if (!height) continue;
      highest = std::max(highest, *height);
      above.push_back(spot);
    }
    if (above.empty()) continue;
    spots = std::move(above);
    return highest;
  }
  return surface.upper().z;
}

}  // namespace

bool is_compact(const Shape& shape) { return shape.half[2] > compact * shape.half[0]; }

glm::dquat drawn_turn(const Shape& shape, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random);
  const double x = normal(random);
  const double y = normal(random);
  const double z = normal(random);
  const glm::dquat any = glm::normalize(glm::dquat(w, x, y, z));
  if (is_compact(shape)) return any;
  std::uniform_real_distribution<double> turn(-std::numbers::pi, std::numbers::pi);
  const double about_up = turn(random);
  const double towards = turn(random);
  const double tilt = std::uniform_real_distribution<double>(-most_tilt, most_tilt)(random);
  const glm::dquat level = glm::quat_cast(glm::transpose(shape.axes));
  return glm::angleAxis(tilt, glm::dvec3(std::cos(towards), std::sin(towards), 0.0)) *
         glm::angleAxis(about_up, glm::dvec3(0.0, 0.0, 1.0)) * level;
}

void place(std::vector<Grain>& grains, const Triangles& surface, double floor, const Walls& walls, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  double reach = 0.0;
  double half_layer = 0.0;
  for (const Grain& grain : grains) {
    const double room = is_compact(*grain.shape) ? compact_room : 1.0;
    reach = std::max(reach, room * grain.size * grain.shape->reach);
    half_layer = std::max(half_layer, room * grain.size * half_height(*grain.shape));
  }
  const double spacing = 2.0 * loose * reach;
  const double layer = 2.0 * loose * half_layer;
  // Without walls, a column higher than wide: what falls from a wide one is a flat heap.
  const auto count = static_cast<double>(grains.size());
  glm::dvec2 room(glm::mix(narrow, wide, std::min(count / many, 1.0)) * std::cbrt(count * spacing * spacing * layer));
  if (!surface.empty()) room = 0.5 * glm::dvec2(surface.upper() - surface.lower());
  if (walls.any()) room = glm::max(walls.half - reach, glm::dvec2(0.0));
  const bool heap = surface.empty() && !walls.any();
  std::vector<Spot> spots = heap ? round_lattice(room, spacing) : lattice(room, spacing);
  double ground = floor;
  if (!surface.empty()) ground = leave_those_above(spots, surface, reach);

  std::vector<std::size_t> order(grains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  std::uniform_real_distribution<double> jitter(-(loose - 1.0) * half_layer, (loose - 1.0) * half_layer);
  for (std::size_t i = 0; i < order.size(); ++i) {
    Grain& grain = grains[order[i]];
    const Spot& spot = spots[i % spots.size()];
    const double x = spot.x + jitter(random);
    const double y = spot.y + jitter(random);
    const std::size_t below = i / spots.size();
    grain.middle = {x, y, ground + half_layer + layer * static_cast<double>(below)};
    grain.turn = drawn_turn(*grain.shape, random);
  }
}

}  // namespace mesograin::pile
