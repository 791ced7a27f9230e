// Lights behind a clear grain and in the mirror of its surface: of a plate, through which light goes on as it came.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "heap/gather.h"
#include "plate.h"

namespace mesograin::heap {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr Finish smooth{.roughness = 0.0F, .shown = true, .correlated = true};

/// A clear plate under a sun so far from the way down, and so wide, edge to edge.
Heap under_sun(double aside, double width) {
  Heap heap = plate();
  heap.grains.kinds[0].sigma_t = glm::dvec3(0.0);
  heap.lights.emplace_back(
      scene::DirectionalLight{glm::dvec3(std::sin(aside), 0.0, -std::cos(aside)), glm::dvec3(3.0), width});
  return heap;
}

/// What is seen of that sun through the plate, from straight above, in one sample of a picture.
double seen_through(double aside, double width, bool flat, std::uint32_t sample = 0) {
  const Heap heap = under_sun(aside, width);
  const Gather gather(heap, std::make_shared<const HeapLight>(solve_exchange(heap, {}, {}, {})));
  transport::Random random(7, 0);
  constexpr int looks = 1 << 12;
  double sum = 0.0;
  for (int i = 0; i < looks; ++i)
    sum += gather
               .look_into({0, half_thickness * up, up, up}, Plate(smooth, flat),
                          {.scatterings = Scatterings::followed, .whole = true, .narrowed = Gather::narrowed(sample)},
                          random)
               .chance.g /
           looks;
  return sum;
}

double radiance_of(double width) { return 3.0 / (2.0 * std::numbers::pi * (1.0 - std::cos(0.5 * width))); }

// Two surfaces with all that is reflected between them: (1 - R) / (1 + R) goes on, R .04.
TEST(ClearLights, AreAsWideThroughFlatFacetsAsTheyAre) {
  const double passed = 0.96 / 1.04;
  const double width = 20.0 * degree;
  EXPECT_NEAR(seen_through(9.0 * degree, width, true) / radiance_of(width), passed, 0.02);
  EXPECT_EQ(seen_through(11.0 * degree, width, true), 0.0);
  // Where the surface bends, looks go here and there, and are spread for their noise.
  EXPECT_GT(seen_through(11.0 * degree, width, false), 0.0);
}

TEST(ClearLights, AreSpreadLessThroughFlatFacets) {
  EXPECT_GT(seen_through(4.0 * degree, degree, true), 0.0);
  EXPECT_EQ(seen_through(6.0 * degree, degree, true), 0.0);
  EXPECT_GT(seen_through(14.0 * degree, degree, false), 0.0);
}

// So that a picture ends as what is there, and not as what had little noise.
TEST(ClearLights, AreSpreadLessByEachSample) {
  EXPECT_GT(seen_through(11.0 * degree, degree, false, 0), 0.0);
  EXPECT_EQ(seen_through(11.0 * degree, degree, false, 63), 0.0);
  const double passed = 0.96 / 1.04;
  EXPECT_NEAR(seen_through(9.0 * degree, degree, false, 63) / radiance_of(20.0 * degree), passed, 0.02);
  // None is narrower than it is.
  EXPECT_NEAR(seen_through(9.0 * degree, 20.0 * degree, false, 1U << 20U) / radiance_of(20.0 * degree), passed, 0.02);
}

/// What a plate's surface mirrors of a sun so far from where it mirrors the viewer.
double mirrored(double aside, double width) {
  Heap heap = under_sun(0.0, width);
  heap.lights = {scene::DirectionalLight{glm::dvec3(std::sin(aside), 0.0, std::cos(aside)), glm::dvec3(3.0), width}};
  const Gather gather(heap, std::make_shared<const HeapLight>(solve_exchange(heap, {}, {}, {})));
  transport::Random random(7, 0);
  return gather.highlights({0, half_thickness * up, up, up}, Plate(smooth, true), random).g;
}

TEST(ClearLights, AreMirroredAsDiscs) {
  const double width = 20.0 * degree;
  for (const double aside : {0.0, 5.0, 9.5})
    EXPECT_NEAR(mirrored(aside * degree, width) / radiance_of(width), 0.04, 0.0005) << aside;
  EXPECT_EQ(mirrored(10.5 * degree, width), 0.0);
}

}  // namespace
}  // namespace mesograin::heap
