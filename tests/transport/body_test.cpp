// Which meshes are bodies, and where rays meet them.
#include "transport/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "base/error.h"
#include "scene/convexity.h"
#include "scene/sphere.h"
#include "shapes.h"

namespace mesograin::transport {
namespace {

void expect_refused(const scene::Mesh& mesh, const std::string& words) {
  try {
    Body body(mesh);
    FAIL() << "a mesh was taken that should be refused with: " << words;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(Body, HasTheVolumeAndAreaOfItsMesh) {
  const Body body(cube());
  EXPECT_NEAR(body.unit(), std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(body.volume() * std::pow(body.unit(), 3), 8.0, 1e-5);
  EXPECT_NEAR(body.area() * std::pow(body.unit(), 2), 24.0, 1e-5);
}

TEST(Body, IsMetFromOutsideAndFromInside) {
  const Body body(cube());
  const std::optional<Hit> outside = body.first_hit({0.1F, 0.2F, 5.0F}, {0.0F, 0.0F, -1.0F});
  ASSERT_TRUE(outside);
  EXPECT_NEAR(outside->distance, 5.0F - 1.0F / body.unit(), 1e-5);
  const std::optional<Hit> inside = body.first_hit({0.1F, 0.2F, 0.0F}, {0.0F, 0.0F, -1.0F});
  ASSERT_TRUE(inside);
  EXPECT_NEAR(inside->normal.z, -1.0F, 1e-6);
  EXPECT_FALSE(body.first_hit({0.1F, 2.0F, 5.0F}, {0.0F, 0.0F, -1.0F}));
}

TEST(Body, KnowsItsNearestPoint) {
  const Body body(cube());
  const auto half = static_cast<float>(1.0 / body.unit());
  const Nearest nearest = body.nearest({0.1F, 0.2F, 0.9F});
  EXPECT_NEAR(nearest.distance, 0.9F - half, 1e-6);
  EXPECT_NEAR(glm::distance(nearest.point, glm::vec3(0.1F, 0.2F, half)), 0.0F, 1e-6);
  EXPECT_NEAR(nearest.normal.z, 1.0F, 1e-6);
}

TEST(Body, MayBeWoundEitherWay) {
  std::vector<glm::uvec3> triangles = box_triangles();
  for (glm::uvec3& triangle : triangles) std::swap(triangle.x, triangle.y);
  const Body body(scene::Mesh(box_positions(), {}, triangles));
  EXPECT_GT(body.volume(), 0.0);
  EXPECT_NEAR(body.first_hit({0.0F, 0.1F, 5.0F}, {0.0F, 0.0F, -1.0F})->normal.z, 1.0F, 1e-6);
}

TEST(Body, WeldsVerticesThatDifferInNormalsAlone) { EXPECT_NO_THROW(Body(scene::unit_sphere(32, 16))); }

/// A ball of quads, each of which bends outwards along its other diagonal where it is cut the wrong way.
scene::Mesh ball_of_quads(int rows, float dent) {
  std::vector<glm::vec3> positions = {{0.0F, 0.0F, 1.0F}};
  std::vector<glm::uvec3> triangles;
  const int columns = 2 * rows;
  for (int row = 1; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double polar = std::numbers::pi * row / rows;
      const double azimuth = std::numbers::pi * (column + 0.5 * row) / rows;
      positions.emplace_back(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
    }
  positions.emplace_back(0.0F, 0.0F, -1.0F);
  positions[positions.size() / 2] *= 1.0F - dent;
  const auto number = [&](int row, int column) {
    return row == 0      ? 0U
           : row == rows ? static_cast<unsigned>(positions.size() - 1)
                         : static_cast<unsigned>(1 + (row - 1) * columns + column % columns);
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      if (row + 1 < rows)
        triangles.emplace_back(number(row, column), number(row + 1, column), number(row + 1, column + 1));
      if (row > 0) triangles.emplace_back(number(row, column), number(row + 1, column + 1), number(row, column + 1));
    }
  return {positions, {}, triangles};
}

TEST(Body, IsConvexWhereItsFacesStandHardlyAboveEachOther) {
  EXPECT_TRUE(Body(cube()).convex());
  const scene::Mesh ball = ball_of_quads(80, 0.0F);
  EXPECT_FALSE(scene::is_convex(ball)) << "else this tests nothing";
  EXPECT_TRUE(Body(ball).convex());
  EXPECT_TRUE(Body(ball, glm::dmat3(1.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.7)).convex());
  EXPECT_FALSE(Body(ball_of_quads(80, 0.02F)).convex()) << "it has a dent";
  EXPECT_FALSE(Body(plates(0.8F, 0.01F)).convex()) << "two beside each other";
}

TEST(Body, IsStretchedAsItsInstance) {
  const Body body(cube(), glm::dmat3(3.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 2.0));
  EXPECT_NEAR(body.volume() * std::pow(body.unit(), 3), 48.0, 1e-4);
}

TEST(Body, HasNoHole) {
  std::vector<glm::uvec3> triangles = box_triangles();
  triangles.pop_back();
  expect_refused(scene::Mesh(box_positions(), {}, triangles), "3 open edges");
}

TEST(Body, EnclosesAVolume) {
  expect_refused(scene::Mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 1}}), "encloses none");
  expect_refused(scene::Mesh({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {}, {{0, 1, 2}}), "encloses none");
}

TEST(Body, DoesNotCrossItself) {
  std::vector<glm::vec3> positions = box_positions();
  std::vector<glm::uvec3> triangles = box_triangles();
  for (unsigned i = 0; i < 8; ++i) positions.push_back(positions[i] + glm::vec3(0.7F, 0.5F, 0.6F));
  for (unsigned i = 0; i < 12; ++i) triangles.push_back(triangles[i] + 8U);
  expect_refused(scene::Mesh(positions, {}, triangles), "cross itself");
}

}  // namespace
}  // namespace mesograin::transport
