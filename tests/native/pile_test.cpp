// Balls that fell lie on the ground or on each other, within the walls, and not in each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "expect_error.h"
#include "pile/contacts.h"
#include "pile/settle.h"

namespace mesograin::pile {
namespace {

using test::expect_error;

std::vector<double> some_radii(std::size_t count, double unit) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> of(0.8 * unit, 1.2 * unit);
  std::vector<double> radii(count);
  for (double& radius : radii) radius = of(random);
  return radii;
}

const Progress silent = [](double) { return true; };

TEST(Pile, FillsABoxAsDenselyAsBallsLie) {
  const std::vector<double> radii = some_radii(600, 0.05);
  const Walls walls{glm::dvec2(0.4)};
  const Pile pile = settle(radii, {}, walls, 0.5, 1, silent);
  EXPECT_LT(pile.largest_overlap, 0.02);
  double volume = 0.0;
  double height = 0.0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const glm::dvec3& middle = pile.middles[i];
    EXPECT_GE(middle.z, radii[i] * 0.98);
    EXPECT_LE(std::max(std::abs(middle.x), std::abs(middle.y)) + radii[i], 0.4 + 1e-9);
    const double ball = 4.0 / 3.0 * 3.14159265358979 * radii[i] * radii[i] * radii[i];
    volume += ball;
    height += 2.0 * middle.z * ball;
  }
  // Loose and dense random packings of balls hold 0.55 and 0.64; walls and the uneven top take some of it.
  const double fraction = volume / (0.8 * 0.8 * height / volume);
  EXPECT_GT(fraction, 0.5);
  EXPECT_LT(fraction, 0.64);
}

TEST(Pile, WithoutWallsItIsAHeapThatHolds) {
  const std::vector<double> radii = some_radii(600, 1.0);
  const Pile rough = settle(radii, {}, {}, 0.6, 1, silent);
  const Pile smooth = settle(radii, {}, {}, 0.0, 1, silent);
  EXPECT_LT(rough.largest_overlap, 0.02);
  const auto height = [](const Pile& pile) {
    double sum = 0.0;
    for (const glm::dvec3& middle : pile.middles) sum += middle.z;
    return sum / static_cast<double>(pile.middles.size());
  };
  EXPECT_GT(height(rough), 1.5 * height(smooth)) << "friction holds it";
  EXPECT_GT(height(rough), 2.0);
}

TEST(Pile, LiesOnTheGroundThatIsThere) {
  // A trough along y.
  Ground ground{{4.0, 0.0, 4.0, 4.0, 0.0, 4.0}, 3, {-8.0, -8.0}, {8.0, 16.0}};
  const std::vector<double> radii = some_radii(60, 0.5);
  const Pile pile = settle(radii, ground, {glm::dvec2(8.0)}, 0.2, 1, silent);
  double away = 0.0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    EXPECT_GE(pile.middles[i].z, ground.height(pile.middles[i].x, pile.middles[i].y));
    away += std::abs(pile.middles[i].x) / static_cast<double>(radii.size());
  }
  EXPECT_LT(away, 3.0) << "they rolled to its bottom";
}

TEST(Pile, TheSameSeedIsTheSamePile) {
  const std::vector<double> radii = some_radii(50, 1.0);
  EXPECT_EQ(settle(radii, {}, {}, 0.5, 3, silent).middles, settle(radii, {}, {}, 0.5, 3, silent).middles);
  EXPECT_NE(settle(radii, {}, {}, 0.5, 3, silent).middles, settle(radii, {}, {}, 0.5, 4, silent).middles);
}

TEST(Pile, EveryPairThatTouchesIsFoundOnce) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-4.0, 4.0);
  std::vector<glm::dvec3> middles(300);
  for (glm::dvec3& middle : middles) middle = {place(random), place(random), place(random)};
  const std::vector<double> radii = some_radii(300, 0.6);
  Pairs expected;
  for (std::uint32_t i = 0; i < 300; ++i)
    for (std::uint32_t j = i + 1; j < 300; ++j)
      if (glm::distance(middles[i], middles[j]) < radii[i] + radii[j] + 0.1) expected.emplace_back(i, j);
  Pairs found;
  find_pairs(middles, radii, 0.1, found);
  std::sort(found.begin(), found.end());
  EXPECT_GT(expected.size(), 500U);
  EXPECT_EQ(found, expected);
}

TEST(Pile, MistakesAreSaidInASentence) {
  expect_error([] { settle({}, {}, {}, 0.5, 0, silent); }, "at least one grain");
  expect_error([] { settle({1.0, -1.0}, {}, {}, 0.5, 0, silent); }, "must be greater than 0; got -1");
  expect_error([] { settle({1.0}, {}, {glm::dvec2(0.5)}, 0.5, 0, silent); }, "leave no room");
  expect_error([] { settle({1.0}, {}, {}, -0.5, 0, silent); }, "Friction must be at least 0");
  expect_error([] { settle({1.0, 1.0}, {}, {}, 0.5, 0, [](double) { return false; }); }, "was cancelled");
}

}  // namespace
}  // namespace mesograin::pile
