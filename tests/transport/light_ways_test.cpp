// Ways of parallel light: what lines through a body say themselves.
#include "transport/light_ways.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <vector>

#include "scene/sphere.h"
#include "shapes.h"
#include "transport/random.h"

namespace mesograin::transport {
namespace {

/// A ring about z: its middle line has radius 1, its tube 0.4.
scene::Mesh ring() {
  constexpr unsigned around = 96, about = 48;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (unsigned i = 0; i < around; ++i)
    for (unsigned j = 0; j < about; ++j) {
      const double large = 2.0 * std::numbers::pi * i / around;
      const double small = 2.0 * std::numbers::pi * j / about;
      const double away = 1.0 + 0.4 * std::cos(small);
      positions.emplace_back(away * std::cos(large), away * std::sin(large), 0.4 * std::sin(small));
      const unsigned next = (i + 1) % around * about, self = i * about, above = (j + 1) % about;
      triangles.emplace_back(self + j, next + j, next + above);
      triangles.emplace_back(self + j, next + above, self + above);
    }
  return {positions, {}, triangles};
}

/// By rays, from the place back to the light.
double traced_way(const Body& body, glm::vec3 place, const glm::vec3& to_light) {
  double way = 0.0;
  while (const std::optional<Hit> hit = body.first_hit(place, to_light)) {
    if (glm::dot(hit->normal, to_light) > 0.0F) way += hit->distance;
    place += (hit->distance + 2e-6F) * to_light;
  }
  return way;
}

/// The mean difference of exp(-rate way) from what rays tell, at places in the body.
double mean_error(const Body& body, const glm::vec3& to_light, double rate) {
  const LightWays ways(body, to_light);
  Random random(1, 0);
  double sum = 0.0;
  int asked = 0;
  while (asked < 4000) {
    const glm::vec3 place =
        glm::mix(body.lower(), body.upper(), glm::vec3(random.uniform(), random.uniform(), random.uniform()));
    if (!body.contains(place)) continue;
    const double right = traced_way(body, place, ways.to_light());
    sum += std::abs(std::exp(-rate * ways.way(place)) - std::exp(-rate * right));
    ++asked;
  }
  return sum / asked;
}

TEST(LightWays, AreThoseOfRays) {
  constexpr double thick = 10.0;  // mean free paths a unit
  for (const glm::vec3& to_light : {glm::vec3(0.3F, -0.5F, 0.8F), glm::vec3(1.0F, 0.0F, 0.0F),
                                    glm::vec3(0.0F, 0.0F, -1.0F), glm::vec3(0.9F, 0.4F, 0.01F)}) {
    EXPECT_LT(mean_error(Body(scene::unit_sphere(64, 32)), to_light, thick), 2e-3);
    EXPECT_LT(mean_error(Body(cube()), to_light, thick), 2e-3);
    EXPECT_LT(mean_error(Body(plates(0.1F, 0.3F)), to_light, thick), 3e-3);  // light grazes them
    EXPECT_LT(mean_error(Body(ring()), to_light, thick), 4e-3);
  }
}

TEST(LightWays, CrossARingTwice) {
  const Body body(ring());
  const auto unit = static_cast<float>(body.unit());
  const LightWays ways(body, glm::vec3(glm::dmat3(body.axes()) * glm::dvec3(1.0, 0.0, 0.0)));
  const auto at = [&](double x) { return glm::vec3(body.axes() * glm::dvec3(x, 0.0, 0.0)) / unit; };
  EXPECT_NEAR(ways.way(at(1.0)) * unit, 0.4, 5e-3);
  EXPECT_NEAR(ways.way(at(-1.0)) * unit, 1.2, 5e-3);
  EXPECT_NEAR(ways.way(at(-1.39)) * unit, 1.59, 5e-3);
}

TEST(LightWays, HoldTheWholeBody) {
  for (const scene::Mesh& mesh : {cube(), ring(), plates(0.4F, 0.4F), scene::unit_sphere(64, 32)}) {
    const Body body(mesh);
    const LightWays ways(body, {0.5F, 0.6F, -0.7F});
    double sum = 0.0;
    for (const glm::vec4& inside : ways.lines()) sum += inside.y - inside.x + inside.w - inside.z;
    EXPECT_NEAR(sum * ways.texel().x * ways.texel().y / body.volume(), 1.0, 2e-3);
  }
}

// A pile of plates: five pieces of a line become two, as long together, the last of which ends where it did.
TEST(LightWays, KeepTheLengthOfLinesThatEnterOften) {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (int plate = 0; plate < 5; ++plate) {
    const auto first = static_cast<unsigned>(positions.size());
    for (const glm::vec3& corner : box_positions())
      positions.emplace_back(corner.x, corner.y, 0.1F * corner.z + 0.5F * static_cast<float>(plate));
    for (const glm::uvec3& triangle : box_triangles()) triangles.push_back(triangle + first);
  }
  const Body body(scene::Mesh(positions, {}, triangles));
  const LightWays ways(body, glm::vec3(body.axes() * glm::dvec3(0.0, 0.0, 1.0)));
  const auto unit = static_cast<float>(body.unit());
  for (const glm::vec4& inside : ways.lines()) {
    EXPECT_NEAR((inside.y - inside.x + inside.w - inside.z) * unit, 1.0F, 1e-4F);
    EXPECT_NEAR(inside.w * unit, 1.1F, 1e-4F);
  }
}

}  // namespace
}  // namespace mesograin::transport
