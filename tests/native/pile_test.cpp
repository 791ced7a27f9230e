// Balls that fell lie on the ground or on each other, within the walls, and not in each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <utility>
#include <vector>

#include "expect_error.h"
#include "pile/contacts.h"
#include "pile/field.h"
#include "pile/settle.h"
#include "pile/support.h"

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

Grains balls(std::vector<double> radii) { return {std::move(radii), {}, {}}; }

// Rectangles, each by four corners one after the other.
Mesh rectangles(const std::vector<std::array<glm::dvec3, 4>>& all) {
  Mesh mesh;
  for (const auto& corners : all) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

// Closed; each side twice as long as `half`.
Mesh block(const glm::dvec3& half) {
  std::vector<std::array<glm::dvec3, 4>> sides;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      std::array<glm::dvec3, 4> side;
      const double turns[4][2] = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};
      for (int i = 0; i < 4; ++i) {
        side[i][axis] = sign * half[axis];
        side[i][(axis + 1) % 3] = turns[i][0] * half[(axis + 1) % 3];
        side[i][(axis + 2) % 3] = sign * turns[i][1] * half[(axis + 2) % 3];
      }
      sides.push_back(side);
    }
  return rectangles(sides);
}

TEST(Pile, FillsABoxAsDenselyAsBallsLie) {
  const std::vector<double> radii = some_radii(600, 0.05);
  const Walls walls{glm::dvec2(0.4)};
  const Pile pile = settle(balls(radii), {}, walls, 0.5, 1, silent);
  EXPECT_LT(pile.largest_overlap, 0.02);
  double volume = 0.0;
  double height = 0.0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const glm::dvec3& middle = pile.middles[i];
    EXPECT_GE(middle.z, radii[i] * 0.98);
    EXPECT_LE(std::max(std::abs(middle.x), std::abs(middle.y)) + radii[i], 0.4 + 0.02 * 0.05);
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
  const Pile rough = settle(balls(radii), {}, {}, 0.6, 1, silent);
  const Pile smooth = settle(balls(radii), {}, {}, 0.0, 1, silent);
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
  // A trough along y, seen from either side.
  const glm::dvec3 far(0.0, 16.0, 0.0);
  const glm::dvec3 left(-8.0, -8.0, 4.0);
  const glm::dvec3 bottom(0.0, -8.0, 0.0);
  const glm::dvec3 right(8.0, -8.0, 4.0);
  const Ground ground{
      rectangles({{left, bottom, bottom + far, left + far}, {bottom, bottom + far, right + far, right}}), false, -10.0};
  const std::vector<double> radii = some_radii(60, 0.5);
  const Pile pile = settle(balls(radii), ground, {glm::dvec2(8.0)}, 0.2, 1, silent);
  double away = 0.0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    EXPECT_GE(pile.middles[i].z, 0.5 * std::abs(pile.middles[i].x));
    away += std::abs(pile.middles[i].x) / static_cast<double>(radii.size());
  }
  EXPECT_LT(away, 3.0) << "they rolled to its bottom";
}

TEST(Pile, StaysInAVesselThatIsOpenAbove) {
  Mesh vessel = block({4.0, 4.0, 6.0});
  // Its lid is the last side, two triangles.
  vessel.triangles.resize(10);
  const Pile pile = settle(balls(some_radii(150, 0.5)), {vessel, false, -6.0}, {}, 0.4, 1, silent);
  for (const glm::dvec3& middle : pile.middles) {
    EXPECT_LT(std::max(std::abs(middle.x), std::abs(middle.y)), 3.65);
    EXPECT_GT(middle.z, -5.65);
  }
}

// Of a block that is a grain.
std::vector<glm::dvec3> corners_of(const Pile& pile, std::size_t i, const glm::dvec3& half) {
  std::vector<glm::dvec3> corners;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 signs(corner % 2 * 2 - 1, corner / 2 % 2 * 2 - 1, corner / 4 * 2 - 1);
    corners.push_back(pile.middles[i] + pile.turns[i] * (signs * half));
  }
  return corners;
}

TEST(Pile, InsideAClosedMeshAllThatFitStay) {
  const Ground ground{block({5.0, 4.0, 6.0}), true, -6.0};
  const glm::dvec3 half(0.8, 0.6, 0.5);
  const auto filled = [&](std::size_t count) {
    return settle({std::vector<double>(count, 1.0), std::vector<std::uint32_t>(count, 0), {block(half)}}, ground, {},
                  0.5, 1, silent);
  };
  const Pile some = filled(60);
  ASSERT_EQ(some.middles.size(), 60U);
  const Pile full = filled(1000);
  // Of the room, grains take half or more, but for what none falls into below the lid.
  const double share = static_cast<double>(full.middles.size()) * half.x * half.y * half.z / (5.0 * 4.0 * 6.0);
  EXPECT_GT(share, 0.4);
  EXPECT_LT(share, 0.8);
  EXPECT_EQ(full.numbers.size(), full.middles.size());
  EXPECT_TRUE(std::is_sorted(full.numbers.begin(), full.numbers.end()));
  double height = 0.0;
  for (const Pile& pile : {some, full})
    for (std::size_t i = 0; i < pile.middles.size(); ++i) {
      height = std::max(height, pile.middles[i].z);
      for (const glm::dvec3& corner : corners_of(pile, i, half)) {
        EXPECT_LT(std::abs(corner.x), 5.05);
        EXPECT_LT(std::abs(corner.y), 4.05);
        EXPECT_LT(std::abs(corner.z), 6.05);
      }
    }
  EXPECT_GT(height, 6.0 - 2.0 * glm::length(half)) << "full up to the lid";
}

TEST(Pile, InsideAMeshNoneIsLeftInTheAir) {
  // Few at a time have room in so high a shaft.
  const Ground ground{block({1.4, 1.4, 60.0}), true, -60.0};
  const Pile pile = settle(balls(some_radii(40, 1.0)), ground, {}, 0.2, 1, silent);
  ASSERT_EQ(pile.middles.size(), 40U);
  std::vector<double> heights;
  for (const glm::dvec3& middle : pile.middles) heights.push_back(middle.z);
  std::sort(heights.begin(), heights.end());
  EXPECT_LT(heights.front(), -58.0);
  for (std::size_t i = 1; i < heights.size(); ++i) EXPECT_LT(heights[i] - heights[i - 1], 2.4);
}

TEST(Pile, InsideABottleIsWithinItsGlass) {
  Mesh bottle = block({5.0, 5.0, 5.0});
  const Mesh within = block({4.4, 4.4, 4.4});
  const auto first = static_cast<std::uint32_t>(bottle.vertices.size());
  bottle.vertices.insert(bottle.vertices.end(), within.vertices.begin(), within.vertices.end());
  for (const auto& [a, b, c] : within.triangles) bottle.triangles.push_back({first + a, first + c, first + b});
  const Pile pile = settle(balls(some_radii(40, 0.5)), {bottle, true, -5.0}, {}, 0.4, 1, silent);
  EXPECT_EQ(pile.middles.size(), 40U);
  for (const glm::dvec3& middle : pile.middles)
    EXPECT_LT(std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)}), 4.05);
}

TEST(Pile, BlocksLieOnTheirSides) {
  const glm::dvec3 half(1.2, 0.8, 0.5);
  const Grains grains{std::vector<double>(40, 1.0), std::vector<std::uint32_t>(40, 0), {block(half)}};
  const Pile pile = settle(grains, {}, {}, 0.6, 2, silent);
  EXPECT_LT(pile.largest_overlap, 0.05);
  int flat = 0;
  for (std::size_t i = 0; i < pile.middles.size(); ++i) {
    double lowest = pile.middles[i].z;
    for (const glm::dvec3& corner : corners_of(pile, i, half)) lowest = std::min(lowest, corner.z);
    EXPECT_GT(lowest, -0.05);
    if (lowest < 0.1 && std::abs((pile.turns[i] * glm::dvec3(0.0, 0.0, 1.0)).z) > 0.95) ++flat;
  }
  EXPECT_GT(flat, 10);
}

TEST(Pile, DistancesOfAMeshAreLessThanZeroInside) {
  const Field field(Triangles(block({1.0, 0.7, 0.5})), 0.5);
  EXPECT_NEAR(field.at({0.0, 0.0, 0.0}).distance, -0.5, 0.05);
  EXPECT_NEAR(field.at({1.2, 0.1, 0.1}).distance, 0.2, 0.01);
  EXPECT_NEAR(field.at({0.1, 0.95, 0.1}).outwards.y, 1.0, 0.01);
  EXPECT_NEAR(field.at({1.3, 1.1, 0.0}).distance, 0.5, 0.02);
}

TEST(Pile, TheSameSeedIsTheSamePile) {
  const std::vector<double> radii = some_radii(50, 1.0);
  EXPECT_EQ(settle(balls(radii), {}, {}, 0.5, 3, silent).middles, settle(balls(radii), {}, {}, 0.5, 3, silent).middles);
  EXPECT_NE(settle(balls(radii), {}, {}, 0.5, 3, silent).middles, settle(balls(radii), {}, {}, 0.5, 4, silent).middles);
}

TEST(Pile, EveryPairThatTouchesIsFoundOnce) {
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-4.0, 4.0);
  std::vector<glm::dvec3> middles(300);
  for (glm::dvec3& middle : middles) middle = {place(random), place(random), place(random)};
  std::vector<double> radii = some_radii(300, 0.65);
  radii[7] = 3.0;
  Pairs expected;
  for (std::uint32_t i = 0; i < 300; ++i)
    for (std::uint32_t j = 0; j < 300; ++j)
      if (i != j && glm::distance(middles[i], middles[j]) < radii[i] + radii[j]) expected.emplace_back(i, j);
  Pairs found;
  const Neighbours neighbours(middles, radii);
  for (std::uint32_t i = 0; i < 300; ++i) neighbours.visit(i, [&](std::uint32_t j) { found.emplace_back(i, j); });
  std::sort(found.begin(), found.end());
  EXPECT_GT(expected.size(), 1000U);
  EXPECT_EQ(found, expected);
}

TEST(Pile, AGrainReachesAsFarAsItsCornersDo) {
  const Mesh mesh = block({1.2, 0.8, 0.5});
  const Support support(mesh.vertices);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 300; ++i) {
    const double x = normal(random);
    const double y = normal(random);
    const double z = normal(random);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(x, y, z));
    const double farthest = glm::dot(glm::abs(direction), glm::dvec3(1.2, 0.8, 0.5));
    EXPECT_GT(support(glm::vec3(direction)), farthest - 1e-5);
    EXPECT_LT(support(glm::vec3(direction)), farthest + 0.1);
  }
  EXPECT_EQ(Support(2.0)(glm::vec3(0.0F, 0.6F, 0.8F)), 2.0F);
}

TEST(Pile, MistakesAreSaidInASentence) {
  expect_error([] { settle(balls({}), {}, {}, 0.5, 0, silent); }, "at least one grain");
  expect_error([] { settle(balls({1.0, -1.0}), {}, {}, 0.5, 0, silent); }, "must be greater than 0; got -1");
  expect_error([] { settle(balls({1.0}), {}, {glm::dvec2(0.5)}, 0.5, 0, silent); }, "leave no room");
  expect_error([] { settle(balls({1.0}), {}, {}, -0.5, 0, silent); }, "Friction must be at least 0");
  const auto inside = [](Mesh mesh) { return Ground{std::move(mesh), true, -2.0}; };
  Mesh open = block(glm::dvec3(2.0));
  open.triangles.resize(10);
  expect_error([&] { settle(balls({0.5}), inside(open), {}, 0.5, 0, silent); }, "encloses no room: it must be closed");
  expect_error([&] { settle(balls({3.0}), inside(block(glm::dvec3(2.0))), {}, 0.5, 0, silent); },
               "No grain fits inside the mesh");
  expect_error([&] { settle(balls({0.5}), inside({}), {}, 0.5, 0, silent); }, "needs at least one triangle");
  expect_error([] { settle(balls({1.0, 1.0}), {}, {}, 0.5, 0, [](double) { return false; }); }, "was cancelled");
}

}  // namespace
}  // namespace mesograin::pile
