// What a clear grain scatters, seen through its own facets: of a plate, which is no ball.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "heap/gather.h"
#include "plate.h"

namespace mesograin::heap {
namespace {

struct Seen {
  double mean;
  double deviation;
};

/// What is scattered in the plate, looked at from this side.
Seen scattered(const Heap& heap, float side) {
  const Gather gather(heap, std::make_shared<const HeapLight>(solve_exchange(heap, {}, {}, {})));
  transport::Random random(5, 0);
  constexpr int looks = 1 << 18;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < looks; ++i) {
    const double found = gather
                             .look_into({0, side * half_thickness * up, side * up, side * up},
                                        Plate({.roughness = 0.0F, .shown = false, .correlated = false}),
                                        {Scatterings::followed, true}, random)
                             .scattered.g;
    sum += found / looks;
    squares += found * found / looks;
  }
  return {sum, std::sqrt(squares - sum * sum)};
}

/// A world of this picture, so bright where `shines(direction)`.
template <typename Shines>
scene::World world(double radiance, const Shines& shines) {
  constexpr int height = 360;
  std::vector<glm::vec3> texels;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < 2 * height; ++column) {
      const double polar = std::numbers::pi * (row + 0.5) / height;
      const double azimuth = std::numbers::pi * (1.0 - (column + 0.5) / height);
      const glm::dvec3 direction(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                 std::cos(polar));
      texels.emplace_back(shines(direction) ? 1.0F : 0.0F);
    }
  scene::World result;
  result.radiance = glm::dvec3(radiance);
  result.image = std::make_shared<const scene::Surroundings>(2 * height, height, std::move(texels));
  return result;
}

// Most light goes on to the other side of a ball, and half of it to each of a plate that is so thin.
TEST(ClearScattering, OfAPlateGoesToBothSidesAlike) {
  Heap heap = plate();
  heap.world = world(1.0, [](const glm::dvec3& direction) { return direction.z > 0.0; });
  const Seen above = scattered(heap, 1.0F);
  const Seen below = scattered(heap, -1.0F);
  // Once scattered: .04 of what goes through, half of it from the lit side.
  EXPECT_GT(above.mean, 0.015);
  EXPECT_NEAR(above.mean / below.mean, 1.0, 0.05);
}

// A sun in the world's picture is found as a sun is, no less and with no more noise.
TEST(ClearScattering, FindsASunInThePictureOfTheWorldAsALamp) {
  const double half = std::numbers::pi / 90.0;
  const glm::dvec3 to_sun(glm::normalize(glm::dvec3(0.3, 0.2, 1.0)));
  Heap lamp = plate();
  lamp.lights.emplace_back(scene::DirectionalLight{to_sun, glm::dvec3(3.0), 2.0 * half});
  Heap picture = plate();
  picture.world = world(3.0 / (std::numbers::pi * std::sin(half) * std::sin(half)),
                        [&](const glm::dvec3& direction) { return glm::dot(direction, to_sun) > std::cos(half); });
  const Seen right = scattered(lamp, 1.0F);
  const Seen found = scattered(picture, 1.0F);
  EXPECT_GT(right.mean, 0.005);
  EXPECT_NEAR(found.mean / right.mean, 1.0, 0.08);
  EXPECT_LT(found.deviation, 1.5 * right.deviation);
}

}  // namespace
}  // namespace mesograin::heap
