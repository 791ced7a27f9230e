// Few directions of an even light do for surfaces that face any way, and many do better.
#include "render/spread_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "render/sequence.h"

namespace mesograin::render {
namespace {

using Row = std::function<glm::dvec3(std::uint32_t)>;

Row spread(std::uint32_t seed) {
  return [row = SpreadDirections(), seed](std::uint32_t index) mutable { return row.at(index, seed); };
}

/// The (0,2)-sequence by equal areas.
Row by_plane(std::uint32_t seed) {
  return [seed](std::uint32_t index) {
    const glm::dvec2 point = scrambled_point(index, seed);
    const double up = 1.0 - 2.0 * point.y, across = std::sqrt(1.0 - up * up);
    const double azimuth = 2.0 * std::numbers::pi * point.x;
    return glm::dvec3(across * std::cos(azimuth), across * std::sin(azimuth), up);
  };
}

/// How far the irradiance of some is off, as a share of what it should be.
double off(const std::vector<glm::dvec3>& directions, const glm::dvec3& normal) {
  double sum = 0.0;
  for (const glm::dvec3& direction : directions) sum += std::max(glm::dot(direction, normal), 0.0);
  return sum / (0.25 * static_cast<double>(directions.size())) - 1.0;
}

std::vector<glm::dvec3> first(const Row& row, std::uint32_t count) {
  std::vector<glm::dvec3> directions;
  for (std::uint32_t i = 0; i < count; ++i) directions.push_back(row(i));
  return directions;
}

/// The root of the mean square of off(), over seeds and normals; of level ground alone, or of all.
double typically_off(const std::function<Row(std::uint32_t)>& rows, std::uint32_t count, bool level) {
  double sum = 0.0;
  constexpr std::uint32_t seeds = 12, normals = 50;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    const std::vector<glm::dvec3> directions = first(rows(seed), count);
    for (std::uint32_t i = 0; i < normals; ++i) {
      const double error = off(directions, level ? glm::dvec3(0.0, 0.0, 1.0) : by_plane(1000)(i));
      sum += error * error;
    }
  }
  return std::sqrt(sum / (seeds * normals));
}

TEST(SpreadDirections, EachFourAreTheCornersOfATetrahedron) {
  const Row row = spread(3);
  for (std::uint32_t i = 0; i < 600; i += 4)
    for (std::uint32_t j = i; j < i + 4; ++j)
      for (std::uint32_t k = i; k < i + 4; ++k)
        EXPECT_NEAR(glm::dot(row(j), row(k)), j == k ? 1.0 : -1.0 / 3.0, 1e-12) << j << ", " << k;
}

TEST(SpreadDirections, AreTheSameInWhateverOrderTheyAreAskedFor) {
  SpreadDirections forwards, any;
  std::vector<glm::dvec3> row;
  for (std::uint32_t i = 0; i < 600; ++i) row.push_back(forwards.at(i, 5));
  for (const std::uint32_t i : {300U, 4U, 599U, 255U, 256U, 0U}) EXPECT_EQ(any.at(i, 5), row[i]) << i;
  EXPECT_NE(any.at(4, 6), row[4]);
}

TEST(SpreadDirections, FewDoForWhatFacesAnyWay) {
  EXPECT_LT(typically_off(spread, 4, false), 0.09);
  EXPECT_GT(typically_off(by_plane, 4, false), 0.25);
}

TEST(SpreadDirections, FewDoForLevelGround) {
  EXPECT_LT(typically_off(spread, 4, true), 0.01);
  EXPECT_GT(typically_off(by_plane, 4, true), 0.1);
}

TEST(SpreadDirections, ManyAreAsGoodAsAnyPlaneCanMakeThem) {
  for (const std::uint32_t count : {8U, 16U, 32U, 64U, 128U})
    EXPECT_LT(typically_off(spread, count, false), typically_off(by_plane, count, false)) << count;
  for (const std::uint32_t count : {8U, 16U, 32U, 64U})
    EXPECT_LT(typically_off(spread, count, true), typically_off(by_plane, count, true)) << count;
}

TEST(SpreadDirections, GoOnGettingBetter) { EXPECT_LT(typically_off(spread, 4096, false), 0.0025); }

}  // namespace
}  // namespace mesograin::render
