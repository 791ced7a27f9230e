// From cell to cell along a ray (Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing", 1987).
#include "ball_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace mesograin::referee {
namespace {

constexpr int most_cells_a_side = 128;

/// Where a line is inside a ball; nothing if it misses.
std::optional<std::pair<double, double>> inside(const Ball& ball, const glm::dvec3& origin,
                                                const glm::dvec3& direction) {
  const glm::dvec3 from_middle = origin - ball.middle;
  const double along = glm::dot(from_middle, direction);
  const glm::dvec3 nearest = from_middle - along * direction;
  const double square = ball.radius * ball.radius - glm::dot(nearest, nearest);
  if (square <= 0) return std::nullopt;
  const double half = std::sqrt(square);
  return std::pair(-along - half, -along + half);
}

}  // namespace

BallGrid::BallGrid(std::vector<Ball> balls) : balls_(std::move(balls)), lower_(1e300) {
  glm::dvec3 upper(-1e300);
  double mean = 0;
  for (const Ball& ball : balls_) {
    lower_ = glm::min(lower_, ball.middle - 1.001 * ball.radius);
    upper = glm::max(upper, ball.middle + 1.001 * ball.radius);
    mean += ball.radius / static_cast<double>(balls_.size());
  }
  const glm::dvec3 extent = upper - lower_;
  size_ = std::max(1.5 * mean, std::max({extent.x, extent.y, extent.z}) / most_cells_a_side);
  cells_ = glm::ivec3(extent / size_) + 1;
  const auto each_cell = [&](const Ball& ball, const auto& visit) {
    const glm::ivec3 first = glm::max(glm::ivec3((ball.middle - ball.radius - lower_) / size_), glm::ivec3(0));
    const glm::ivec3 last = glm::min(glm::ivec3((ball.middle + ball.radius - lower_) / size_), cells_ - 1);
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) visit(number_of({x, y, z}));
  };
  begins_.assign(number_of({0, 0, cells_.z}) + 1, 0);
  for (const Ball& ball : balls_) each_cell(ball, [&](std::size_t cell) { ++begins_[cell + 1]; });
  for (std::size_t cell = 1; cell < begins_.size(); ++cell) begins_[cell] += begins_[cell - 1];
  numbers_.resize(begins_.back());
  std::vector<std::uint32_t> next = begins_;
  for (std::uint32_t number = 0; number < balls_.size(); ++number)
    each_cell(balls_[number], [&](std::size_t cell) { numbers_[next[cell]++] = number; });
}

std::size_t BallGrid::number_of(const glm::ivec3& cell) const {
  const int number = (cell.z * cells_.y + cell.y) * cells_.x + cell.x;
  return static_cast<std::size_t>(number);
}

template <class Visit>
void BallGrid::visit(const glm::dvec3& origin, const glm::dvec3& direction, const Visit& visit) const {
  double enter = 0;
  double leave = std::numeric_limits<double>::infinity();
  glm::dvec3 inverse;
  for (int axis = 0; axis < 3; ++axis) {
    inverse[axis] = 1 / (direction[axis] == 0 ? 1e-300 : direction[axis]);
    const double a = (lower_[axis] - origin[axis]) * inverse[axis];
    const double b = (lower_[axis] + size_ * cells_[axis] - origin[axis]) * inverse[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter >= leave) return;
  const glm::dvec3 at = (origin + enter * direction - lower_) / size_;
  glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(at)), glm::ivec3(0), cells_ - 1);
  glm::ivec3 step;
  glm::dvec3 next;
  for (int axis = 0; axis < 3; ++axis) {
    step[axis] = direction[axis] < 0 ? -1 : 1;
    next[axis] = (lower_[axis] + size_ * (cell[axis] + (step[axis] > 0 ? 1 : 0)) - origin[axis]) * inverse[axis];
  }
  while (true) {
    const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const double until = next[axis];
    const std::size_t number = number_of(cell);
    for (std::uint32_t i = begins_[number]; i < begins_[number + 1]; ++i) visit(numbers_[i], enter, until);
    if (visit.done(until)) return;
    enter = until;
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] >= cells_[axis]) return;
    next[axis] += size_ * std::abs(inverse[axis]);
  }
}

std::optional<BallGrid::Hit> BallGrid::first(const glm::dvec3& origin, const glm::dvec3& direction) const {
  struct Nearest {
    const BallGrid& grid;
    const glm::dvec3& origin;
    const glm::dvec3& direction;
    std::optional<Hit>& nearest;

    void operator()(std::uint32_t number, double /*enter*/, double /*until*/) const {
      const auto way = inside(grid.balls_[number], origin, direction);
      // What the ray leaves just now is not entered.
      if (way && way->first > -1e-9 * grid.balls_[number].radius && way->first + way->second > 1e-6 &&
          (!nearest || way->first < nearest->distance))
        nearest = Hit{number, std::max(way->first, 0.0)};
    }
    bool done(double until) const { return nearest && nearest->distance <= until; }
  };
  std::optional<Hit> nearest;
  visit(origin, direction, Nearest{*this, origin, direction, nearest});
  return nearest;
}

double BallGrid::way_in_balls(const glm::dvec3& origin, const glm::dvec3& direction, std::uint32_t without) const {
  struct Sum {
    const BallGrid& grid;
    const glm::dvec3& origin;
    const glm::dvec3& direction;
    std::uint32_t without;
    double& sum;

    void operator()(std::uint32_t number, double enter, double until) const {
      if (number == without) return;
      const auto way = inside(grid.balls_[number], origin, direction);
      if (!way || way->second <= 0) return;
      const double begin = std::max(way->first, 0.0);
      // A ball is in several cells, the middle of its way in one.
      const double middle = 0.5 * (begin + way->second);
      if (middle >= enter && middle < until) sum += way->second - begin;
    }
    bool done(double /*until*/) const { return false; }
  };
  double sum = 0;
  visit(origin, direction, Sum{*this, origin, direction, without, sum});
  return sum;
}

}  // namespace mesograin::referee
