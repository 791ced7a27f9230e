// Light between grains against what must hold of it: nothing is won or lost, and two grains are two grains.
#include "heap/exchange.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "heap/links.h"
#include "heap/spread.h"
#include "heaps.h"

namespace mesograin::heap {
namespace {

TEST(Exchange, KeepsAWhiteFurnaceEven) {
  for (const double sigma_t : {0.01, 1.0, 10.0}) {
    Heap heap = lattice(6, medium(sigma_t, 1.0));
    heap.world.radiance = glm::dvec3(2.0);
    const HeapLight light = solve_exchange(heap, {}, {}, {});
    const float met = light.kinds[0].from_light->met().r;
    double sum = 0.0;
    for (const Coefficients& sent : light.sent) {
      sum += static_cast<double>(sent.channels[0].w) / static_cast<double>(light.sent.size());
      EXPECT_NEAR(sent.channels[0].w, 2.0F * met, 0.1F * met) << sigma_t;
      EXPECT_LT(glm::length(glm::vec3(sent.channels[0])), 0.25F * met) << sigma_t;
    }
    EXPECT_NEAR(sum, 2.0 * met, 0.01 * met) << sigma_t;
  }
}

/// A disk about a lattice that hides it from everywhere, and places of it seen along a direction.
class Disk {
 public:
  explicit Disk(int side)
      : middle_(2.05F * 0.5F * static_cast<float>(side - 1)), reach_(1.05F * (std::sqrt(3.0F) * middle_.x + 1.0F)) {}

  Ray ray_along(const glm::vec3& direction, const std::array<float, 5>& point) const {
    const glm::vec3 on_disk(std::sqrt(point[0]), 0.0F, -2.0F);
    return {middle_ + reach_ * (TurnedFrame(direction, point[1]) * on_disk), direction, glm::vec3(1.0F)};
  }

  float farthest() const { return 4.0F * reach_; }
  double area() const { return std::numbers::pi * static_cast<double>(reach_ * reach_); }

 private:
  glm::vec3 middle_;
  float reach_;
};

constexpr int rays_out = 1 << 18;

/// What all grains of a lattice send out of it, as power.
double power_out(const Space& space, const HeapLight& light, const Disk& disk) {
  transport::Random random(7, 0);
  const Spread spread(random);
  double sum = 0.0;
  for (int i = 0; i < rays_out; ++i) {
    const std::array<float, 5> point = spread.point(i);
    Ray ray = disk.ray_along(transport::isotropic(point[2], point[3]), point);
    sum += 4.0 * std::numbers::pi * static_cast<double>(space.seen_along(ray, light.sent, random).r);
  }
  return sum / rays_out * disk.area();
}

// Of grains that absorb nothing, under a sun alone: what comes out over what came in.
double let_out(int side, const Optics& optics, const Quality& quality, const transport::Effort& effort = {}) {
  Heap heap = lattice(side, optics);
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(1.0)});
  const HeapLight light = solve_exchange(heap, quality, {}, effort);
  const Space space(heap.grains, light.kinds, light.seats);
  const Disk disk(side);
  transport::Random random(7, 0);
  const Spread spread(random);
  double met = 0.0;
  for (int i = 0; i < rays_out; ++i) {
    Ray from_sun = disk.ray_along({0.0F, -0.6F, -0.8F}, spread.point(i));
    met += 1.0 - static_cast<double>(space.passed(from_sun, disk.farthest()).r);
  }
  EXPECT_GT(met, 0.05 * rays_out);
  return power_out(space, light, disk) / (met / rays_out * disk.area());
}

// The same under a lamp amid eight grains, .77 radii from their surfaces.
double let_out_of_a_lamp(const Optics& optics) {
  constexpr int side = 6;
  Heap heap = lattice(side, optics);
  const glm::vec3 place(2.05F * 2.5F);
  heap.lights.emplace_back(scene::PointLight{glm::dvec3(place), glm::dvec3(1.0)});
  Quality quality;
  quality.rays = quality.light_rays = 8192;
  const HeapLight light = solve_exchange(heap, quality, {}, {});
  const Space space(heap.grains, light.kinds, light.seats);
  const Disk disk(side);
  transport::Random random(7, 1);
  double met = 0.0;
  for (int i = 0; i < rays_out; ++i) {
    const float u = random.uniform();
    Ray ray{place, transport::isotropic(u, random.uniform()), glm::vec3(1.0F)};
    met += 1.0 - static_cast<double>(space.passed(ray, disk.farthest()).r);
  }
  EXPECT_GT(met, 0.5 * rays_out);
  return power_out(space, light, disk) / (4.0 * std::numbers::pi * met / rays_out);
}

TEST(Exchange, LetsAsMuchLightOutAsCameIn) {
  Quality quality;
  quality.rays = quality.light_rays = 1024;  // 216 grains' noise is none of this
  for (const Optics& optics : {medium(0.5, 1.0), medium(3.0, 1.0), medium(10.0, 1.0), lambert(1.0)})
    EXPECT_NEAR(let_out(6, optics, quality), 1.0, 0.01) << optics.sigma_t.r;
}

TEST(Exchange, LetsAsMuchLightOutAsALampAmidGrainsSends) {
  // As the grains' middles have it, .92 of it came out.
  Optics glass = medium(3.0, 1.0);
  glass.surface = Surface::dielectric;
  glass.eta = 1.3;
  for (const Optics& optics : {medium(0.5, 1.0), medium(3.0, 1.0), lambert(1.0), glass})
    EXPECT_NEAR(let_out_of_a_lamp(optics), 1.0, 0.01) << optics.sigma_t.r;
}

TEST(Exchange, LetsAsMuchLightOutAsCameInWhereDeepGrainsShareTheirNumbers) {
  Quality quality;
  quality.shared_from = 0;
  // With 128 of each, and none that share, white opaque grains send out .6 % too much.
  quality.rays = 512;
  for (const Optics& optics : {medium(3.0, 1.0), lambert(1.0)})
    EXPECT_NEAR(let_out(18, optics, quality), 1.0, 0.01) << optics.sigma_t.r;
  // By other random numbers of rays: with a third of those of grains that share it was .41 and 1.049.
  for (const std::uint64_t seed : {2U, 6U}) {
    transport::Effort effort;
    effort.seed = seed;
    EXPECT_NEAR(let_out(18, lambert(1.0), quality, effort), 1.0, 0.01) << seed;
  }
}

TEST(Exchange, DarkensAFurnaceOfGreyGrainsInside) {
  Heap heap = lattice(7, lambert(0.8));
  heap.world.radiance = glm::dvec3(1.0);
  const HeapLight light = solve_exchange(heap, {}, {}, {});
  const auto at = [&](std::size_t x, std::size_t y, std::size_t z) {
    return light.sent[(x * 7 + y) * 7 + z].channels[0].w;
  };
  EXPECT_LT(at(3, 3, 3), 0.5F * at(0, 0, 0));
  EXPECT_GT(at(3, 3, 3), 0.0F);
}

// Of a lone grain all, of one beside a large one what that does not stand before.
TEST(Exchange, TellsHowMuchOfTheWorldIsSeenThroughAGrain) {
  Optics glass = medium(0.2, 1.0);
  glass.surface = Surface::dielectric;
  glass.eta = 1.5;
  for (const Optics& optics : {medium(0.2, 1.0), glass}) {
    Heap heap;
    heap.grains.kinds = {optics, lambert(0.5)};
    heap.grains.grains = {
        {glm::vec3(0.0F), 1.0F, 0}, {glm::vec3(21.0F, 0.0F, 0.0F), 20.0F, 1}, {glm::vec3(0.0F, 0.0F, 1e3F), 1.0F, 0}};
    const HeapLight light = solve_exchange(heap, {}, {}, {});
    // What is seen through it along x from either side is behind it.
    const GrainTable& table = *light.kinds[0].from_light;
    const auto seen_from = [&](std::size_t grain, float side) {
      const glm::vec3 along(side, 0.0F, 0.0F);
      return light.open[grain].at(optics.transparent() ? look_through(along, along) : table.seen_place(along, along));
    };
    for (const float side : {-1.0F, 1.0F}) EXPECT_NEAR(seen_from(2, side), 1.0F, 1e-3F);
    EXPECT_LT(seen_from(0, -1.0F), 0.3F);
    EXPECT_GT(seen_from(0, 1.0F), 0.8F);
    EXPECT_EQ(light.open[1].first, glm::vec4(0.0F));
  }
}

// Two Lambert spheres, far apart: what one gets of the other is the other's light over the squared distance.
TEST(Exchange, OfTwoGrainsFarApartIsThatOfTwoPoints) {
  Heap heap;
  heap.grains.kinds = {lambert(0.5)};
  heap.grains.grains = {{glm::vec3(0.0F), 1.0F, 0}, {glm::vec3(8.0F, 0.0F, 0.0F), 1.0F, 0}};
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.0, 1.0}, glm::dvec3(1.0)});
  Quality quality;
  quality.rays = 1 << 20;
  quality.light_rays = 1 << 14;
  const HeapLight light = solve_exchange(heap, quality, {}, {});
  // If its light were even, the power pi E rho into 4 pi. Lit from above it sends less aside: over all pairs of places
  // of the two, by quadrature, .794 of that; to order 2 .789, to order 1 all of it.
  const double radiant_intensity = 0.794 * 0.25 * 0.5;
  const double irradiance = radiant_intensity / 64.0;
  const double sent = 0.5 * irradiance / (4.0 * std::numbers::pi);
  EXPECT_NEAR(light.answer[0].channels[0].w, sent, 0.06 * sent);
  EXPECT_NEAR(light.answer[0].channels[0].w, light.answer[1].channels[0].w, 0.05 * sent);
  EXPECT_GT(light.answer[0].channels[0].x, 0.0F);
  EXPECT_LT(light.answer[1].channels[0].x, 0.0F);
}

TEST(Exchange, IsTheSameWhateverItBeginsWithAndOnHoweverManyThreads) {
  Heap heap = lattice(4, medium(3.0, 0.99));
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(3.0)});
  transport::Effort one;
  one.threads = 1;
  transport::Effort three;
  three.threads = 3;
  const HeapLight light = solve_exchange(heap, {}, {}, one);
  const HeapLight again = solve_exchange(heap, {}, {}, three);
  const HeapLight warm = solve_exchange(heap, {}, light.sent, one);
  EXPECT_LE(warm.steps, 1);
  for (std::size_t i = 0; i < light.sent.size(); ++i) {
    EXPECT_EQ(light.sent[i].channels[1], again.sent[i].channels[1]);
    EXPECT_NEAR(light.sent[i].channels[1].w, warm.sent[i].channels[1].w, 2e-3F * light.sent[i].channels[1].w);
  }
}

TEST(Exchange, IsFiniteForTouchingOverlappingNestedAndTinyGrains) {
  for (const Optics& optics :
       {lambert(1.0), medium(1e-6, 1.0), medium(200.0, 1.0), medium(1.0, 0.0), medium(0.0, 0.0)}) {
    Heap heap = lattice(3, optics, 1.5);
    heap.grains.grains.push_back({glm::vec3(0.0F), 0.5F, 0});
    heap.grains.grains.push_back({glm::vec3(0.0F), 0.5F, 0});
    heap.grains.grains.push_back({glm::vec3(5.0F), 1e-20F, 0});
    heap.lights.emplace_back(scene::PointLight{{0.1, 0.0, 0.0}, glm::dvec3(1.0)});
    heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.0, 1.0}, glm::dvec3(1.0)});
    heap.world.radiance = glm::dvec3(0.3);
    const HeapLight light = solve_exchange(heap, {}, {}, {});
    const Field& sent = light.sent;
    for (const Field* field : {&light.answer, &light.behind, &sent})
      for (const Coefficients& numbers : *field)
        for (const glm::vec4& channel : numbers.channels)
          for (int i = 0; i < 4; ++i) ASSERT_TRUE(std::isfinite(channel[i]));
  }
}

TEST(Exchange, EndsWhereItIsStopped) {
  std::atomic<bool> stop{true};
  transport::Effort effort;
  effort.stop = &stop;
  EXPECT_THROW(solve_exchange(lattice(3, lambert(0.5)), {}, {}, effort), transport::Stopped);
}

}  // namespace
}  // namespace mesograin::heap
