// Directions drawn from a world against sums over its texels.
#include "lights/world_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <memory>
#include <random>
#include <vector>

#include "base/error.h"

namespace mesograin::lights {
namespace {

using glm::dvec3;

constexpr int width = 32;
constexpr int height = 16;

/// Dim noise, one texel as bright as all others together, and a black row.
scene::World noisy_world() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> even(0.0F, 1.0F);
  std::vector<glm::vec3> texels;
  texels.reserve(width * height);
  for (int i = 0; i < width * height; ++i) texels.emplace_back(even(random), even(random), even(random));
  texels[3 * width + 20] = {400.0F, 300.0F, 100.0F};
  for (int column = 0; column < width; ++column) texels[5 * width + column] = glm::vec3(0.0F);
  scene::World world;
  world.radiance = {1.0, 0.5, 2.0};
  world.image = std::make_shared<const scene::Surroundings>(width, height, texels);
  // A quarter turn about x, then a third of a turn about z.
  world.world_to_image = glm::dmat3(-0.5, 0.75, 0.0, 0.0, 0.0, 1.0, 0.75, 0.5, 0.0);
  world.world_to_image[0] = glm::normalize(dvec3(-0.5, std::sqrt(0.75), 0.0));
  world.world_to_image[2] = glm::normalize(dvec3(std::sqrt(0.75), 0.5, 0.0));
  return world;
}

/// Irradiance on a surface, by the radiance in many directions, evenly over the sphere.
dvec3 by_directions(const scene::World& world, const dvec3& normal) {
  dvec3 sum(0.0);
  const int rows = 1024;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < 2 * rows; ++column) {
      const double up = 1.0 - 2.0 * (row + 0.5) / rows;
      const double azimuth = PI * (column + 0.5) / rows;
      const double across = std::sqrt(1.0 - up * up);
      const dvec3 direction(across * std::cos(azimuth), across * std::sin(azimuth), up);
      sum += radiance(world, direction) * std::max(glm::dot(direction, normal), 0.0);
    }
  return sum * (4.0 * PI / (2.0 * rows * rows));
}

dvec3 by_draws(const scene::World& world, const dvec3& normal) {
  const WorldLight light(world);
  dvec3 sum(0.0);
  const int side = 1000;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const LightDraw drawn = light.draw({(i + 0.5) / side, (j + 0.5) / side});
      sum += drawn.irradiance * std::max(glm::dot(drawn.to_light, normal), 0.0);
    }
  return sum / static_cast<double>(side * side);
}

TEST(WorldLight, DrawsGiveTheIrradianceOfTheImage) {
  const scene::World world = noisy_world();
  validate(world);
  for (const dvec3 normal : {dvec3(0, 0, 1), dvec3(0, 0, -1), glm::normalize(dvec3(1, -2, 0.5))}) {
    const dvec3 expected = by_directions(world, normal);
    const dvec3 found = by_draws(world, normal);
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(found[channel] / expected[channel], 1.0, 1e-2) << channel;
  }
}

TEST(WorldLight, AWorldOfOneColourGivesPiTimesItsRadiance) {
  scene::World world;
  world.radiance = {1.0, 2.0, 3.0};
  for (const dvec3 normal : {dvec3(0, 0, 1), glm::normalize(dvec3(1, -2, 0.5))})
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(by_draws(world, normal)[channel], PI * (channel + 1.0), 1e-3);
}

// Where Blender's documentation of equirectangular images puts them: x in the middle, y a quarter of the way from the
// left.
TEST(WorldLight, DirectionsLieWhereBlenderHasThem) {
  EXPECT_EQ(equirectangular({1, 0, 0}), glm::dvec2(0.5, 0.5));
  EXPECT_EQ(equirectangular({0, 1, 0}), glm::dvec2(0.25, 0.5));
  EXPECT_EQ(equirectangular({0, -1, 0}), glm::dvec2(0.75, 0.5));
  EXPECT_EQ(equirectangular({0, 0, 1}).y, 0.0);
  EXPECT_EQ(equirectangular({0, 0, -1}).y, 1.0);
}

TEST(WorldLight, ABlackWorldIsBlackAndAWrongOneIsNamed) {
  scene::World world;
  world.radiance = dvec3(1.0);
  world.image = std::make_shared<const scene::Surroundings>(2, 1, std::vector<glm::vec3>(2, glm::vec3(0.0F)));
  EXPECT_EQ(WorldLight(world).draw({0.5, 0.5}).irradiance, dvec3(0.0));
  EXPECT_THROW(scene::Surroundings(2, 1, std::vector<glm::vec3>(1)), Error);
  EXPECT_THROW(scene::Surroundings(1, 1, {glm::vec3(-1.0F)}), Error);
  EXPECT_THROW(scene::Surroundings(1, 1, {glm::vec3(NAN)}), Error);
  world.world_to_image[0] *= 2.0;
  EXPECT_THROW(validate(world), Error);
  world.world_to_image = glm::dmat3(1.0);
  world.radiance.y = -1.0;
  EXPECT_THROW(validate(world), Error);
}

}  // namespace
}  // namespace mesograin::lights
