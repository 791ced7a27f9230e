// Light gathered for one look against the four numbers of all looks, against paths, and against what is seen through a
// clear grain.
#include "heap/gather.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>
#include <variant>

#include "heap/links.h"
#include "heap/spread.h"

namespace mesograin::heap {
namespace {

Optics lambert(double reflectance) {
  Optics optics;
  optics.reflectance = glm::dvec3(reflectance);
  return optics;
}

Optics medium(double sigma_t, double albedo) {
  Optics optics;
  optics.surface = Surface::index_matched;
  optics.sigma_t = glm::dvec3(sigma_t);
  optics.albedo = glm::dvec3(albedo);
  return optics;
}

Heap lattice(const Optics& optics) {
  Heap heap;
  heap.grains.kinds = {optics};
  for (int x = 0; x < 5; ++x)
    for (int y = 0; y < 5; ++y)
      for (int z = 0; z < 5; ++z) heap.grains.grains.push_back({2.05F * glm::vec3(x, y, z), 1.0F, 0});
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(3.0)});
  heap.world.radiance = glm::dvec3(0.5);
  return heap;
}

std::shared_ptr<const HeapLight> solved(const Heap& heap) {
  Quality quality;
  quality.rays = 1 << 14;
  quality.seen_rays = 1 << 13;
  return std::make_shared<const HeapLight>(solve_exchange(heap, quality, {}, {}));
}

// A place of a ball and where it is seen from: a mean over points is one over normals and, weighed by the cosine, over
// directions.
struct Look {
  glm::vec3 normal;
  float mu;
  glm::vec3 towards;

  explicit Look(const std::array<float, 5>& point)
      : normal(transport::isotropic(point[0], point[1])),
        mu(std::sqrt(point[2])),
        towards(TurnedFrame(normal, point[3]) * glm::vec3(std::sqrt(1.0F - point[2]), 0.0F, mu)) {}
};

// Exitance over pi of a grain: the mean over normals and, weighed by the cosine, over directions.
TEST(Gather, IsInTheMeanWhatTheFourNumbersAre) {
  const Heap heap = lattice(medium(1.0, 0.9));
  const std::shared_ptr<const HeapLight> light = solved(heap);
  const Gather gather(heap, light);
  transport::Random random(1, 0);
  for (const std::uint32_t grain : {0U, 12U, 62U, 124U}) {
    const Spread spread(random);
    double found = 0.0;
    double expected = 0.0;
    constexpr int looks = 1 << 14;
    for (int i = 0; i < looks; ++i) {
      const auto [normal, mu, towards] = Look(spread.point(i));
      found += gather.look(grain, normal, towards, 4, random).r / looks;
      const GrainTable& table = *light->kinds[0].from_light;
      expected += (table.lobe_at(mu).r * light->answer[grain].at(normal).r +
                   table.crossing(mu).r * light->behind[grain].at(look_through(normal, towards)).r) /
                  looks;
    }
    EXPECT_NEAR(found, expected, 0.04 * expected) << grain;
  }
}

/// The sphere that a ray meets first, and how far off; `from`: one that it leaves.
struct Sphere {
  std::size_t number;
  float distance;
};

std::optional<Sphere> met(const Heap& heap, std::size_t from, const glm::vec3& origin, const glm::vec3& direction) {
  std::optional<Sphere> first;
  for (std::size_t i = 0; i < heap.grains.grains.size(); ++i) {
    const glm::vec3 to = heap.grains.grains[i].middle - origin;
    const float along = glm::dot(to, direction);
    const float beside = 1.0F - glm::dot(to, to) + along * along;
    if (i == from || along < 0.0F || beside < 0.0F) continue;
    const float distance = along - std::sqrt(beside);
    if (!first || distance < first->distance) first = Sphere{i, distance};
  }
  return first;
}

/// Of a sphere because of the others, exitance over pi: paths, each from a place and in a direction by its cosine.
double traced(const Heap& heap, std::size_t of, int paths, transport::Random& random) {
  const auto& sun = std::get<scene::DirectionalLight>(heap.lights[0]);
  const glm::vec3 to_sun = glm::normalize(glm::vec3(sun.direction_to_light));
  const double reflectance = heap.grains.kinds[0].reflectance.r;
  double sum = 0.0;
  for (int path = 0; path < paths; ++path) {
    std::size_t from = of;
    glm::vec3 normal = transport::isotropic(random.uniform(), random.uniform());
    double left = reflectance;
    for (int length = 0; left > 1e-3; ++length) {
      const glm::vec3 origin = heap.grains.grains[from].middle + normal;
      const float height = random.uniform();
      const glm::vec3 direction =
          TurnedFrame(normal, random.uniform()) * glm::vec3(std::sqrt(height), 0.0F, std::sqrt(1.0F - height));
      const std::optional<Sphere> next = met(heap, from, origin, direction);
      if (!next) {
        if (length > 0) sum += left * heap.world.radiance.r;
        break;
      }
      from = next->number;
      normal = origin + next->distance * direction - heap.grains.grains[from].middle;
      const float cosine = glm::dot(normal, to_sun);
      left *= reflectance;
      if (cosine > 0.0F && !met(heap, from, heap.grains.grains[from].middle + normal, to_sun))
        sum += left * cosine * sun.irradiance.r / std::numbers::pi;
    }
  }
  return sum / paths;
}

// By the numbers alone the corner that is turned to the sun (124) has 9 % too much: they do not tell how dark its
// neighbours are in its own shadow. Those of the corner opposite (0) have 6 %, of which most comes from farther off.
TEST(Gather, OfLambertGrainsIsWhatPathsFind) {
  const Heap heap = lattice(lambert(0.8));
  const Gather gather(heap, solved(heap));
  transport::Random random(1, 0);
  for (const auto& [grain, off] : {std::pair{0U, 0.055}, {12U, 0.02}, {124U, 0.02}}) {
    const Spread spread(random);
    double found = 0.0;
    constexpr int looks = 1 << 14;
    for (int i = 0; i < looks; ++i) {
      const auto [normal, mu, towards] = Look(spread.point(i));
      found += gather.look(grain, normal, towards, 4, random).r / looks;
    }
    const double expected = traced(heap, grain, 1 << 17, random);
    EXPECT_NEAR(found, expected, off * expected) << grain;
  }
}

TEST(Gather, ShowsThroughAClearGrainWhatIsBehindIt) {
  Heap heap;
  heap.grains.kinds = {medium(1e-6, 0.0), lambert(0.5)};
  heap.grains.grains = {{glm::vec3(0.0F), 1.0F, 0}, {glm::vec3(0.0F, 0.0F, -4.0F), 1.0F, 1}};
  heap.lights.emplace_back(scene::DirectionalLight{{1.0, 0.0, 0.0}, glm::dvec3(3.0)});
  const std::shared_ptr<const HeapLight> light = solved(heap);
  const Gather gather(heap, light);
  transport::Random random(1, 0);
  const glm::vec3 up(0.0F, 0.0F, 1.0F);
  const float behind = light->sent[1].at(up).r;
  ASSERT_GT(behind, 0.0F);
  EXPECT_NEAR(gather.look(0, up, up, 4, random).r, behind, 1e-3F * behind);
  EXPECT_NEAR(gather.look(0, glm::normalize(glm::vec3(0.99F, 0.0F, 0.2F)), glm::vec3(1.0F, 0.0F, 0.0F), 4, random).r,
              0.0F, 1e-4F);
}

// What stands behind a grain is behind its rim, too, from where it is looked at.
TEST(Gather, IsToldByTheLookWhatIsBehindAGrain) {
  Heap heap;
  heap.grains.kinds = {medium(1e-6, 0.0), lambert(0.5)};
  heap.grains.grains = {{glm::vec3(0.0F), 1.0F, 0}, {glm::vec3(0.0F, 0.0F, -5.0F), 3.0F, 1}};
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.0, 1.0}, glm::dvec3(3.0)});
  const Coefficients behind = solved(heap)->behind[0];
  const glm::vec3 up(0.0F, 0.0F, 1.0F);
  const auto seen_at = [&](const glm::vec3& normal) { return behind.at(look_through(normal, up)).r; };
  EXPECT_GT(seen_at(glm::normalize(glm::vec3(1.0F, 0.0F, 0.2F))), 0.5F * seen_at(up));
  EXPECT_LT(behind.at(look_through(-up, -up)).r, 0.1F * seen_at(up));
}

glm::vec3 picture(const Gather::All& all) { return all.others + all.scattered + all.world; }

// White grains in even light look like the light, by the mean of each grain's looks to one percent.
TEST(Gather, OfAllLightLosesNone) {
  using Ways = Gather::Ways;
  for (const auto& [sigma_t, once_more, ways] : {std::tuple{0.1, false, Ways::short_ones},
                                                 {0.1, true, Ways::short_ones},
                                                 {20.0, false, Ways::short_ones},
                                                 {20.0, true, Ways::short_ones},
                                                 {0.1, true, Ways::whole},
                                                 {20.0, true, Ways::whole}}) {
    Heap heap = lattice(medium(sigma_t, 1.0));
    heap.lights.clear();
    heap.world.radiance = glm::dvec3(1.0);
    const Gather gather(heap, solved(heap), ways);
    transport::Random random(2, 0);
    const Spread spread(random);
    for (const std::uint32_t grain : {0U, 62U, 124U}) {
      double sum = 0.0;
      constexpr int looks = 1 << 12;
      for (int i = 0; i < looks; ++i) {
        const Look look(spread.point(i));
        const glm::vec3 place = heap.grains.grains[grain].radius * look.normal;
        ASSERT_TRUE(gather.sees_all(grain));
        sum +=
            picture(gather.look_at_all(grain, place, look.normal, look.towards, gather.walks(1, once_more), random)).g /
            looks;
      }
      EXPECT_NEAR(sum, 1.0, 0.01) << sigma_t << " " << once_more << " " << (ways == Ways::whole) << " " << grain;
    }
  }
}

// So far from the middle of all that no number is left to tell a grain's surface from its middle.
TEST(Gather, IsANumberWhereGrainsAreSmallAndFarOff) {
  for (const Optics& optics : {lambert(0.8), medium(3.0, 0.9)}) {
    Heap heap = lattice(optics);
    for (Grain& grain : heap.grains.grains) {
      grain.middle = glm::vec3(3e6F) + grain.middle;
      grain.radius = 0.1F;
    }
    const Gather gather(heap, solved(heap));
    transport::Random random(6, 0);
    const Spread spread(random);
    for (int i = 0; i < 1 << 10; ++i) {
      const Look look(spread.point(i));
      for (const glm::vec3& seen :
           {gather.look(62, look.normal, look.towards, 4, random),
            picture(gather.look_at_all(62, 0.1F * look.normal, look.normal, look.towards, {4, true}, random))})
        ASSERT_TRUE(std::isfinite(seen.r + seen.g + seen.b)) << i;
    }
  }
}

// A facet that lies in another grain's shadow is dark, though the point of the sphere that faces as it does is lit.
TEST(Gather, ShadowsAPlaceWhereItIs) {
  Heap heap;
  heap.grains.kinds = {medium(50.0, 0.9)};
  heap.grains.grains = {{glm::vec3(0.0F), 1.0F, 0}, {glm::vec3(0.8F, 0.0F, 3.0F), 0.4F, 0}};
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.0, 1.0}, glm::dvec3(3.0)});
  const Gather gather(heap, solved(heap));
  transport::Random random(3, 0);
  const glm::vec3 up(0.0F, 0.0F, 1.0F);
  const auto seen_at = [&](const glm::vec3& place) {
    return picture(gather.look_at_all(0, place, up, up, {256}, random)).r;
  };
  EXPECT_LT(seen_at({0.8F, 0.0F, 0.9F}), 0.1F * seen_at({-0.5F, 0.0F, 0.9F}));
}

TEST(Gather, LeavesToTheModelWhatRefracts) {
  Heap heap = lattice(medium(1.0, 0.9));
  for (const bool refracts : {false, true}) {
    if (refracts) heap.grains.kinds[0].surface = Surface::dielectric;
    const Gather gather(heap, std::make_shared<const HeapLight>(solve_exchange(heap, coarse, {}, {})));
    EXPECT_EQ(gather.sees_all(0), !refracts);
  }
}

}  // namespace
}  // namespace mesograin::heap
