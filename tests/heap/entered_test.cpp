// What has entered grains that refract of lights' light and the world's, told apart from what their surface reflects.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>

#include "heap/changed_light.h"
#include "heap/exchange.h"
#include "heap/grain_table.h"
#include "heap/response.h"
#include "heap/scaled_light.h"
#include "heap/solver.h"
#include "heaps.h"
#include "physics/physics.h"
#include "transport/directions.h"
#include "transport/random.h"

namespace mesograin::heap {
namespace {

constexpr double eta = 1.5;

Optics turbid(double sigma_t, double albedo) {
  Optics optics = medium(sigma_t, albedo);
  optics.surface = Surface::dielectric;
  optics.eta = eta;
  return optics;
}

/// The share of light from everywhere, and of parallel light that meets a ball, that its surface lets in.
float lets_in() {
  constexpr int steps = 4096;
  double sum = 0.0;
  for (int step = 0; step < steps; ++step)
    sum += physics::fresnel_reflectance(std::sqrt((step + 0.5) / steps), eta) / steps;
  return static_cast<float>(1.0 - sum);
}

Heap ball_of(const Optics& optics) {
  Heap heap = lattice(1, optics);
  heap.grains.grains.front().radius = 1.0F;
  return heap;
}

HeapLight light_of(const Heap& heap) {
  Quality quality;
  quality.rays = quality.light_rays = 4096;
  return solve_exchange(heap, quality, {}, {});
}

glm::vec3 mean_of(const Coefficients& of) { return {of.channels[0].w, of.channels[1].w, of.channels[2].w}; }

/// Of the exitance over pi in a place, whose normal looks at the viewer.
float at_pole(const HeapLight& light, const GrainTable& table, const glm::vec3& normal) {
  return light.entered.front().whole().at(table.entered().place(normal, normal)).g;
}

TEST(Entered, ResponseIsWhatItsPlacesTogetherAddUpTo) {
  transport::Random random(7, 0);
  Response response;
  Coefficients right;
  const glm::vec3 light(1.0F, 2.0F, 0.5F);
  const TurnedFrame frame(glm::normalize(glm::vec3(0.3F, -0.5F, 0.8F)), 0.3F);
  for (int i = 0; i < 50; ++i) {
    const float u = random.uniform();
    const glm::vec3 place = 1.2F * transport::isotropic(u, random.uniform());
    const glm::vec3 share(random.uniform(), 0.1F, 1.0F);
    response.add(share, place);
    for (const float side : {1.0F, -1.0F})
      right.add(0.5F * share * light, frame * (place * glm::vec3(1.0F, side, 1.0F)), true);
  }
  Coefficients sum;
  response.add_to(sum, frame, light);
  for (int i = 0; i < 50; ++i) {
    const float u = random.uniform();
    const glm::vec3 place = transport::isotropic(u, random.uniform());
    EXPECT_LT(glm::distance(sum.at(place), right.at(place)), 1e-4F * glm::length(right.at(place)) + 1e-3F);
  }
}

TEST(Entered, OfAWhiteBallIsWhatItsSurfaceLetsIn) {
  Heap heap = ball_of(turbid(5.0, 1.0));
  heap.world.radiance = glm::dvec3(1.0, 0.5, 0.0);
  const HeapLight in_world = light_of(heap);
  ASSERT_EQ(in_world.entered.size(), 1U);
  const glm::vec3 of_world = mean_of(in_world.entered.front().whole());
  EXPECT_NEAR(of_world.r, lets_in(), 0.01F * lets_in());
  EXPECT_NEAR(of_world.g, 0.5F * lets_in(), 0.005F * lets_in());
  EXPECT_EQ(of_world.b, 0.0F);
  EXPECT_LT(glm::length(glm::vec3(in_world.entered.front().whole().channels[0])), 0.02F) << "as much everywhere";
  heap.world.radiance = glm::dvec3(0.0);
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(4.0 * std::numbers::pi)});
  const HeapLight in_sun = light_of(heap);
  // What passes a disc leaves through four times its area.
  EXPECT_NEAR(mean_of(in_sun.entered.front().whole()).g, lets_in(), 0.02F * lets_in());
  EXPECT_NEAR(mean_of(in_sun.sent[0]).g, 1.0F, 0.01F) << "and all that the ball sends is what came";
}

TEST(Entered, OfAThickBallIsBrightWhereLightCameIn) {
  Heap heap = ball_of(turbid(20.0, 0.99));
  const glm::vec3 to_light(0.0F, 0.6F, 0.8F);
  heap.lights.emplace_back(scene::DirectionalLight{glm::dvec3(to_light), glm::dvec3(4.0 * std::numbers::pi)});
  const HeapLight light = light_of(heap);
  const GrainTable table(heap.grains.kinds.front(), Sense::from_light, {});
  const float mean = mean_of(light.entered.front().whole()).g;
  // Of a Lambert ball order 2 has 4.25 and .25 of the mean there.
  EXPECT_GT(at_pole(light, table, to_light), 3.2F * mean);
  EXPECT_LT(std::abs(at_pole(light, table, -to_light)), 0.6F * mean);
}

float mean_green(const HeapLight& light) {
  float sum = 0.0F;
  for (const PackedCoefficients& one : light.entered) sum += mean_of(one.whole()).g;
  return sum / static_cast<float>(light.entered.size());
}

// Before it is found anew what entered grains of another colour is told by how much more they send out of it.
TEST(Entered, OfAnotherColourIsQuicklyTold) {
  Heap heap = lattice(4, turbid(5.0, 0.9));
  heap.world.radiance = glm::dvec3(0.5);
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(3.0)});
  Heap whiter = heap;
  whiter.grains.kinds.front() = turbid(5.0, 0.97);
  Solver solver;
  const HeapLight before = solver.solve(heap, {}, {});
  const HeapLight quick = solver.solve(whiter, coarse, {});
  const HeapLight right = solve_exchange(whiter, {}, {}, {});
  EXPECT_EQ(quick.parts.links, before.parts.links) << "by the ways that there are";
  EXPECT_GT(mean_green(right), 1.3F * mean_green(before));
  EXPECT_NEAR(mean_green(quick), mean_green(right), 0.08F * mean_green(right));
}

TEST(Entered, IsOfTurbidGrainsAlone) {
  Heap heap = ball_of(turbid(1.0, 0.9));
  heap.world.radiance = glm::dvec3(1.0);
  EXPECT_TRUE(light_of(heap).entered.empty()) << "a clear one";
  heap.grains.kinds.front() = medium(5.0, 0.9);
  EXPECT_TRUE(light_of(heap).entered.empty()) << "one that does not refract";
  heap.grains.kinds.front() = turbid(5.0, 0.9);
  EXPECT_FALSE(light_of(heap).entered.empty());
}

TEST(Entered, ChangesWithWhatGrainsAreMadeOfAndWithTheLights) {
  Heap before = lattice(4, turbid(5.0, 0.9));
  before.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(3.0)});
  before.world.radiance = glm::dvec3(0.3);
  Heap now = before;
  now.grains.kinds.front() = turbid(5.0, 0.97);
  HeapLight taken = light_of(before);
  const HeapLight right = light_of(now);
  const auto all = [](const HeapLight& light) {
    glm::vec3 sum(0.0F);
    for (const PackedCoefficients& one : light.entered) sum += mean_of(one.whole());
    return sum;
  };
  const glm::vec3 was = all(taken);
  change(taken, before.grains, now.grains);
  EXPECT_GT(all(right).g, 1.3F * was.g);
  EXPECT_NEAR(all(taken).g, all(right).g, 0.05F * all(right).g) << "more than what the surface reflects with it";
  scale(taken, glm::vec3(2.0F, 1.0F, 0.0F));
  EXPECT_NEAR(all(taken).r, 2.0F * all(taken).g, 0.02F * all(taken).r);
  EXPECT_EQ(all(taken).b, 0.0F);
}

}  // namespace
}  // namespace mesograin::heap
