// The sphere's mesh: closed, turned outwards, exact normals, and as large as the sphere it stands for.
#include "scene/sphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "expect_error.h"

namespace mesograin::scene {
namespace {

TEST(Sphere, NormalsAreUnitAndRadial) {
  const Mesh sphere = unit_sphere();
  EXPECT_EQ(sphere.triangles().size(), 256U * 127U * 2U);
  for (std::size_t i = 0; i < sphere.positions().size(); ++i) {
    EXPECT_NEAR(glm::length(sphere.normals()[i]), 1.0F, 2e-7F);
    EXPECT_NEAR(glm::length(glm::cross(sphere.positions()[i], sphere.normals()[i])), 0.0F, 2e-7F);
    EXPECT_NEAR(glm::length(sphere.positions()[i]), 1.0F, 1.1e-4F);
  }
}

TEST(Sphere, TrianglesFaceOutwardsAndFillTheSphere) {
  for (const auto& [segments, rings, tolerance] : {std::tuple{256, 128, 2e-6}, std::tuple{32, 16, 5e-4}}) {
    const Mesh sphere = unit_sphere(segments, rings);
    double volume = 0.0;
    double area = 0.0;
    for (const glm::uvec3& triangle : sphere.triangles()) {
      const glm::dvec3 a(sphere.positions()[triangle.x]);
      const glm::dvec3 b(sphere.positions()[triangle.y]);
      const glm::dvec3 c(sphere.positions()[triangle.z]);
      const glm::dvec3 twice_area = glm::cross(b - a, c - a);
      EXPECT_GT(glm::dot(twice_area, a + b + c), 0.0);
      volume += glm::dot(a, glm::cross(b, c)) / 6.0;
      area += glm::length(twice_area) / 2.0;
    }
    // The quads lie on the sphere on average, so its volume is the sphere's; without the lift it would be 3e-4 short.
    EXPECT_NEAR(volume / (4.0 / 3.0 * std::numbers::pi), 1.0, tolerance);
    EXPECT_NEAR(area / (4.0 * std::numbers::pi), 1.0, 200.0 * tolerance);
  }
}

TEST(Sphere, UvsFollowLongitudeAndLatitude) {
  const Mesh sphere = unit_sphere(64, 32);
  for (const glm::uvec3& triangle : sphere.triangles())
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 normal = sphere.normals()[triangle[corner]];
      const glm::vec2 uv = sphere.uvs()[triangle[corner]];
      EXPECT_NEAR(std::cos(uv.y * std::numbers::pi), -normal.z, 1e-6);
      const double distance = std::hypot(normal.x, normal.y);
      EXPECT_NEAR(distance * std::cos(uv.x * 2.0 * std::numbers::pi), normal.x, 1e-6);
      EXPECT_NEAR(distance * std::sin(uv.x * 2.0 * std::numbers::pi), normal.y, 1e-6);
      EXPECT_GE(uv.x, 0.0F);
      EXPECT_LE(uv.x, 1.0F);
    }
}

TEST(Sphere, TooCoarseIsRefused) {
  test::expect_error([] { unit_sphere(2, 2); }, "at least 3 segments and 2 rings; got 2 and 2");
}

}  // namespace
}  // namespace mesograin::scene
