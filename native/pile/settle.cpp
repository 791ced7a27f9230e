// Position based dynamics with friction (Macklin, Mueller, Chentanez and Kim, "Unified particle physics for real-time
// applications", 2014, section 6.1): balls are moved apart along their contact, and what slides there is held back as
// far as Coulomb's cone lets it. Lengths are in mean radii, a step is the unit of time.
#include "pile/settle.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>

#include "base/error.h"
#include "pile/contacts.h"

namespace mesograin::pile {
namespace {

constexpr double gravity = 0.04;      // mean radii a step squared
constexpr double longest_step = 0.5;  // mean radii
constexpr double kept_of_speed = 0.98;
constexpr double at_rest = 4e-3;     // mean radii a step, on average
constexpr double near_enough = 0.5;  // mean radii; who may meet before neighbours are looked for again
constexpr double loose = 1.05;       // how far balls are apart before they fall
constexpr int most_steps = 400;      // beyond the fall
constexpr int iterations = 4;
constexpr int last_steps = 60;         // under a weight that fades
constexpr int last_iterations = 1000;  // under none

class Settling {
 public:
  Settling(const std::vector<double>& radii, const Ground& ground, const Walls& walls, double friction,
           std::uint64_t seed)
      : radii_(radii), ground_(ground), walls_(walls), friction_(friction) {
    unit_ = std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
    largest_ = *std::max_element(radii.begin(), radii.end());
    place(seed);
  }

  Pile run(const Progress& progress) {
    const int fall = static_cast<int>(top_ / unit_ / longest_step);
    const auto go_on = [&](double share) {
      if (!progress(share)) throw Error("The pile was cancelled.");
    };
    bool resting = false;
    for (int step = 0; step < fall + most_steps && !resting; ++step) {
      go_on(0.9 * step / (fall + most_steps));
      resting = advance(gravity) < at_rest * unit_ && step > fall;
    }
    // Weight presses balls into each other: it fades, and then they part.
    for (int step = 0; step < last_steps; ++step) advance(gravity * (1.0 - static_cast<double>(step) / last_steps));
    for (int i = 0; i < last_iterations; ++i) {
      go_on(0.95 + 0.05 * i / last_iterations);
      look_for_neighbours(0.02);
      before_ = middles_;
      if (relax(0.0) < 1e-3) break;
    }
    return {middles_, overlap()};
  }

 private:
  // In loose layers, one above the other.
  void place(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> jitter(-(loose - 1.0) * unit_, (loose - 1.0) * unit_);
    const double spacing = 2.0 * loose * largest_;
    // Without walls, a column as high as it is wide.
    const double half = 0.5 * spacing * std::cbrt(static_cast<double>(radii_.size()));
    const glm::dvec2 room = walls_.any() ? walls_.half - largest_ : glm::dvec2(half);
    const auto columns = std::max(1, static_cast<int>(2.0 * room.x / spacing) + 1);
    const auto rows = std::max(1, static_cast<int>(2.0 * room.y / spacing) + 1);
    const double highest =
        ground_.heights.empty() ? 0.0 : *std::max_element(ground_.heights.begin(), ground_.heights.end());
    const auto along = [&](int number, int count, double reach) {
      return count > 1 ? -reach + 2.0 * reach * number / (count - 1) : 0.0;
    };
    std::vector<std::size_t> order(radii_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), random);
    middles_.resize(radii_.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto of_layer = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
      const int in_layer = static_cast<int>(i % of_layer);
      const std::size_t layer = i / of_layer;
      middles_[order[i]] = {along(in_layer % columns, columns, room.x) + jitter(random),
                            along(in_layer / columns, rows, room.y) + jitter(random),
                            highest + largest_ + static_cast<double>(layer) * spacing};
      top_ = std::max(top_, middles_[order[i]].z - highest);
    }
    moved_.assign(radii_.size(), glm::dvec3(0.0));
  }

  // Before anything goes farther than this, in mean radii, what may meet is known.
  void look_for_neighbours(double farthest) {
    reserve_ -= 2.0 * farthest;
    if (reserve_ > 0.0) return;
    find_pairs(middles_, radii_, near_enough * unit_, pairs_);
    reserve_ = near_enough - 2.0 * farthest;
  }

  // How far a ball goes on average.
  double advance(double weight) {
    before_ = middles_;
    double farthest = 0.0;
    for (std::size_t i = 0; i < middles_.size(); ++i) {
      glm::dvec3 step = kept_of_speed * moved_[i] - glm::dvec3(0.0, 0.0, weight * unit_);
      const double length = glm::length(step);
      if (length > longest_step * unit_) step *= longest_step * unit_ / length;
      farthest = std::max(farthest, glm::length(step) / unit_);
      middles_[i] += step;
    }
    look_for_neighbours(std::min(farthest, 0.5 * near_enough));
    for (int i = 0; i < iterations; ++i) relax(friction_);
    double sum = 0.0;
    for (std::size_t i = 0; i < middles_.size(); ++i) {
      moved_[i] = middles_[i] - before_[i];
      sum += glm::length(moved_[i]);
    }
    return sum / static_cast<double>(middles_.size());
  }

  // The largest overlap that was met, in mean radii.
  double relax(double friction) {
    double largest = 0.0;
    for (const auto& [i, j] : pairs_) {
      const glm::dvec3 apart = middles_[i] - middles_[j];
      const double distance = glm::length(apart);
      const double overlap = radii_[i] + radii_[j] - distance;
      if (overlap <= 0.0) continue;
      largest = std::max(largest, overlap / unit_);
      const glm::dvec3 normal = distance > 0.0 ? apart / distance : glm::dvec3(0.0, 0.0, 1.0);
      const glm::dvec3 slid =
          held_back((middles_[i] - before_[i]) - (middles_[j] - before_[j]), normal, overlap, friction);
      middles_[i] += 0.5 * (overlap * normal - slid);
      middles_[j] -= 0.5 * (overlap * normal - slid);
    }
    for (std::size_t i = 0; i < middles_.size(); ++i) largest = std::max(largest, hold(i, friction) / unit_);
    return largest;
  }

  // Of a sliding, what friction takes back where balls press into each other by `depth`.
  static glm::dvec3 held_back(const glm::dvec3& moved, const glm::dvec3& normal, double depth, double friction) {
    const glm::dvec3 slid = moved - glm::dot(moved, normal) * normal;
    const double length = glm::length(slid);
    return length > friction * depth ? slid * (friction * depth / length) : slid;
  }

  // By the ground and the walls; how deep the ball was in them.
  double hold(std::size_t i, double friction) {
    glm::dvec3& middle = middles_[i];
    const double radius = radii_[i];
    if (walls_.any()) {
      middle.x = std::clamp(middle.x, -walls_.half.x + radius, walls_.half.x - radius);
      middle.y = std::clamp(middle.y, -walls_.half.y + radius, walls_.half.y - radius);
    }
    if (ground_.heights.empty() && middle.z >= radius) return 0.0;
    glm::dvec3 normal(0.0, 0.0, 1.0);
    if (!ground_.heights.empty()) {
      const double reach = 0.5 * radius;
      normal.x = ground_.height(middle.x - reach, middle.y) - ground_.height(middle.x + reach, middle.y);
      normal.y = ground_.height(middle.x, middle.y - reach) - ground_.height(middle.x, middle.y + reach);
      normal.z = 2.0 * reach;
      normal = glm::normalize(normal);
    }
    const double above = (middle.z - ground_.height(middle.x, middle.y)) * normal.z;
    const double depth = radius - above;
    if (depth <= 0.0) return 0.0;
    middle += depth * normal - held_back(middle - before_[i], normal, depth, friction);
    return depth;
  }

  double overlap() {
    find_pairs(middles_, radii_, 0.0, pairs_);
    double largest = 0.0;
    for (const auto& [i, j] : pairs_)
      largest = std::max(
          largest, (radii_[i] + radii_[j] - glm::distance(middles_[i], middles_[j])) / std::min(radii_[i], radii_[j]));
    return largest;
  }

  const std::vector<double>& radii_;
  const Ground& ground_;
  const Walls& walls_;
  double friction_;
  double unit_ = 1.0;
  double largest_ = 1.0;
  double top_ = 0.0;
  double reserve_ = 0.0;
  std::vector<glm::dvec3> middles_;
  std::vector<glm::dvec3> before_;
  std::vector<glm::dvec3> moved_;
  Pairs pairs_;
};

}  // namespace

Pile settle(const std::vector<double>& radii, const Ground& ground, const Walls& walls, double friction,
            std::uint64_t seed, const Progress& progress) {
  if (radii.empty()) throw Error("A pile needs at least one grain; got none.");
  for (const double radius : radii)
    if (!(radius > 0.0 && std::isfinite(radius)))
      throw Error("A grain's radius must be greater than 0; got {}.", radius);
  if (!(friction >= 0.0)) throw Error("Friction must be at least 0; got {}.", friction);
  const double largest = *std::max_element(radii.begin(), radii.end());
  if (walls.any() && !(std::min(walls.half.x, walls.half.y) >= largest))
    throw Error("The walls leave no room: they are {} and {} apart, and the largest grain is {} across.",
                2.0 * walls.half.x, 2.0 * walls.half.y, 2.0 * largest);
  if (!ground.heights.empty() && (ground.columns == 0 || ground.heights.size() % ground.columns != 0))
    throw Error("The ground's heights must fill whole rows; got {} in rows of {}.", ground.heights.size(),
                ground.columns);
  return Settling(radii, ground, walls, friction, seed).run(progress);
}

}  // namespace mesograin::pile
