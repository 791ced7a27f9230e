// A lattice with room for each grain however it is turned; of a heap, a cone of it.
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

constexpr double loose = 1.05;      // how far grains are apart before they fall
constexpr double steep = 4.5;       // a heap's height over its radius before it falls together
constexpr double in_circle = 1.02;  // of its rim
constexpr double compact = 0.6;     // shortest over longest extent; such grains fall turned anyhow
constexpr double most_tilt = 0.3;   // radians, of others
constexpr double too_steep = 4.0;   // a rise over its run; nothing falls right beside such a wall
constexpr double well_away = 1.8;   // from an edge of what they fall on, in their reach
constexpr int around = 8;           // places around a spot where the ground is asked for

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

// Of a cone, the lowest first: each layer lies in the hollows of that below it, as balls do in the closest packing.
// What falls from a column is a table with steep edges; a cone stays one and sinks as its grains come nearer to each
// other.
std::vector<glm::dvec3> cone(std::size_t count, double spacing, double full_layer) {
  const double layer = full_layer / std::numbers::sqrt2;
  const double volume = static_cast<double>(count) * spacing * spacing * layer;
  const double radius = std::cbrt(3.0 * volume / (std::numbers::pi * steep));
  std::vector<glm::dvec3> spots;
  for (int number = 0; spots.size() < count; ++number) {
    const double height = layer * number;
    const double within = in_circle * radius - height / steep;
    const double shift = number % 2 == 0 ? 0.0 : 0.5 * spacing;
    const int half = static_cast<int>(std::max(within, 0.0) / spacing) + 1;
    const std::size_t before = spots.size();
    for (int row = -half; row <= half; ++row)
      for (int column = -half; column <= half; ++column) {
        const double x = spacing * column + shift;
        const double y = spacing * row + shift;
        if (x * x + y * y <= within * within) spots.emplace_back(x, y, height);
      }
    if (spots.size() == before) spots.emplace_back(0.0, 0.0, height);
  }
  return spots;
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
  double ground = floor;
  std::vector<glm::dvec3> places;
  if (surface.empty() && !walls.any()) {
    places = cone(grains.size(), spacing, layer);
  } else {
    glm::dvec2 room(0.0);
    if (!surface.empty()) room = 0.5 * glm::dvec2(surface.upper() - surface.lower());
    if (walls.any()) room = glm::max(walls.half - reach, glm::dvec2(0.0));
    std::vector<Spot> spots = lattice(room, spacing);
    if (!surface.empty()) ground = leave_those_above(spots, surface, reach);
    for (std::size_t i = 0; i < grains.size(); ++i) {
      const Spot& spot = spots[i % spots.size()];
      const std::size_t below = i / spots.size();
      places.emplace_back(spot.x, spot.y, layer * static_cast<double>(below));
    }
  }

  std::vector<std::size_t> order(grains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  std::uniform_real_distribution<double> jitter(-(loose - 1.0) * half_layer, (loose - 1.0) * half_layer);
  for (std::size_t i = 0; i < order.size(); ++i) {
    Grain& grain = grains[order[i]];
    const double x = places[i].x + jitter(random);
    const double y = places[i].y + jitter(random);
    grain.middle = {x, y, ground + half_layer + places[i].z};
    grain.turn = drawn_turn(*grain.shape, random);
  }
}

}  // namespace mesograin::pile
