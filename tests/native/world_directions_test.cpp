// Few directions of a world do for surfaces that face any way, and many do as well as any others.
#include "render/world_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "render/sequence.h"

namespace mesograin::render {
namespace {

using Row = std::function<glm::dvec3(std::uint32_t)>;
using Rows = std::function<Row(std::uint32_t seed)>;

scene::World even_world() {
  scene::World world;
  world.radiance = glm::dvec3(1.0);
  return world;
}

/// Two lamps in the dark, one of them low.
scene::World studio() {
  constexpr int width = 64, height = 32;
  std::vector<glm::vec3> texels(static_cast<std::size_t>(width) * height, glm::vec3(0.05F));
  for (int row = 6; row < 10; ++row)
    for (int column = 8; column < 14; ++column) texels[row * width + column] = glm::vec3(8.0F);
  for (int row = 14; row < 17; ++row)
    for (int column = 40; column < 44; ++column) texels[row * width + column] = glm::vec3(5.0F);
  scene::World world = even_world();
  world.image = std::make_shared<scene::Surroundings>(width, height, texels);
  return world;
}

Rows spread_over(const lights::WorldLight& world) {
  return [&world](std::uint32_t seed) {
    return [row = WorldDirections(world), &world, seed](std::uint32_t index) mutable {
      return row.at(world, index, seed).to_light;
    };
  };
}

/// The (0,2)-sequence.
Rows by_plane(const lights::WorldLight& world) {
  return [&world](std::uint32_t seed) {
    return [&world, seed](std::uint32_t index) { return world.draw(scrambled_point(index, seed)).to_light; };
  };
}

std::vector<glm::dvec3> first(const Row& row, std::uint32_t count) {
  std::vector<glm::dvec3> directions;
  for (std::uint32_t i = 0; i < count; ++i) directions.push_back(row(i));
  return directions;
}

double irradiance(const std::vector<glm::dvec3>& directions, const glm::dvec3& normal) {
  double sum = 0.0;
  for (const glm::dvec3& direction : directions) sum += std::max(glm::dot(direction, normal), 0.0);
  return sum / static_cast<double>(directions.size());
}

/// The root of the mean square of what irradiance is off by, over seeds and normals, as a share of its mean.
double typically_off(const lights::WorldLight& world, const Rows& rows, std::uint32_t count,
                     const std::vector<glm::dvec3>& normals) {
  constexpr std::uint32_t seeds = 24;
  const std::vector<glm::dvec3> all = first(by_plane(world)(777), 1U << 14U);
  std::vector<double> right;
  right.reserve(normals.size());
  for (const glm::dvec3& normal : normals) right.push_back(irradiance(all, normal));
  double square = 0.0, mean = 0.0;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    const std::vector<glm::dvec3> directions = first(rows(seed), count);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const double error = irradiance(directions, normals[i]) - right[i];
      square += error * error;
      mean += right[i];
    }
  }
  const double terms = static_cast<double>(seeds) * static_cast<double>(normals.size());
  return std::sqrt(square / terms) / (mean / terms);
}

const std::vector<glm::dvec3> level = {{0.0, 0.0, 1.0}};

std::vector<glm::dvec3> any_normals() {
  const lights::WorldLight everywhere(even_world());
  std::vector<glm::dvec3> normals;
  for (std::uint32_t i = 0; i < 32; ++i) normals.push_back(everywhere.draw(scrambled_point(i, 1000)).to_light);
  return normals;
}

TEST(WorldDirections, EachFourOfAnEvenWorldAreTheCornersOfATetrahedron) {
  const lights::WorldLight world(even_world());
  const Row row = spread_over(world)(3);
  for (std::uint32_t i = 0; i < 600; i += 4)
    for (std::uint32_t j = i; j < i + 4; ++j)
      for (std::uint32_t k = i; k < i + 4; ++k)
        EXPECT_NEAR(glm::dot(row(j), row(k)), j == k ? 1.0 : -1.0 / 3.0, 1e-12) << j << ", " << k;
}

TEST(WorldDirections, AreTheSameInWhateverOrderTheyAreAskedFor) {
  for (const scene::World& scene : {even_world(), studio()}) {
    const lights::WorldLight world(scene);
    const Row forwards = spread_over(world)(5), any = spread_over(world)(5);
    std::vector<glm::dvec3> row;
    for (std::uint32_t i = 0; i < 600; ++i) row.push_back(forwards(i));
    for (const std::uint32_t i : {300U, 4U, 599U, 255U, 256U, 0U}) EXPECT_EQ(any(i), row[i]) << i;
    EXPECT_NE(spread_over(world)(6)(4), row[4]);
  }
}

TEST(WorldDirections, AllHaveTheSameLuminance) {
  const lights::WorldLight world(studio());
  WorldDirections row(world);
  for (std::uint32_t i = 0; i < 64; ++i)
    EXPECT_NEAR(row.at(world, i, 2).irradiance.g, row.at(world, 0, 2).irradiance.g, 1e-6);
}

TEST(WorldDirections, FewDoForWhatFacesAnyWay) {
  const lights::WorldLight even(even_world()), image(studio());
  EXPECT_LT(typically_off(even, spread_over(even), 4, any_normals()), 0.09);
  EXPECT_GT(typically_off(even, by_plane(even), 4, any_normals()), 0.25);
  EXPECT_LT(typically_off(image, spread_over(image), 4, any_normals()),
            0.75 * typically_off(image, by_plane(image), 4, any_normals()));
}

TEST(WorldDirections, FewDoForLevelGround) {
  const lights::WorldLight even(even_world()), image(studio());
  EXPECT_LT(typically_off(even, spread_over(even), 4, level), 0.01);
  EXPECT_GT(typically_off(even, by_plane(even), 4, level), 0.1);
  EXPECT_LT(typically_off(image, spread_over(image), 4, level), 0.75 * typically_off(image, by_plane(image), 4, level));
}

TEST(WorldDirections, ManyOfAnEvenWorldAreAsGoodAsTheSequence) {
  const lights::WorldLight even(even_world());
  for (const std::uint32_t count : {8U, 16U, 32U, 64U, 128U})
    EXPECT_LT(typically_off(even, spread_over(even), count, any_normals()),
              typically_off(even, by_plane(even), count, any_normals()))
        << count;
}

TEST(WorldDirections, GoOnGettingBetter) {
  const lights::WorldLight even(even_world()), image(studio());
  EXPECT_LT(typically_off(even, spread_over(even), 4096, any_normals()), 0.0025);
  EXPECT_LT(typically_off(image, spread_over(image), 4096, any_normals()), 0.0025);
}

}  // namespace
}  // namespace mesograin::render
