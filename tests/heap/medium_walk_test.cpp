// Walks and looks through a grain's own facets where nothing refracts: of a plate, which is no ball.
#include "heap/medium_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "heap/gather.h"
#include "plate.h"

namespace mesograin::heap {
namespace {

constexpr int walks = 1 << 18;
constexpr float thickness = 2.0F * half_thickness;

Plate facets() { return Plate({.roughness = 0.0F, .shown = false, .correlated = false}); }

Optics medium(double depth, double albedo) {
  Optics optics;
  optics.surface = Surface::index_matched;
  optics.sigma_t = glm::dvec3(depth / thickness);
  optics.albedo = glm::dvec3(albedo);
  return optics;
}

/// From above, slanted.
SeenFacet seen_from(float cosine) {
  return {0, half_thickness * up, up, {std::sqrt((1.0F - cosine) * (1.0F + cosine)), 0.0F, cosine}};
}

struct Sums {
  double left = 0.0;         // of what was scattered
  double first_depth = 0.0;  // of its first scatterings, along the way
};

Sums walked(const Optics& optics, const SeenFacet& seen) {
  transport::Random random(11, 0);
  const Plate plate = facets();
  const std::optional<End> across = plate.end(0, seen.place, -seen.towards);
  Sums sums;
  for (int i = 0; i < walks; ++i) {
    bool first = true;
    const auto scattered = [&](const glm::vec3& place, const glm::vec3&, const glm::vec3&) {
      if (first) sums.first_depth += glm::distance(place, seen.place) / walks;
      first = false;
    };
    const std::optional<Passage> passage = walk_medium(optics, 1.0F, seen, across, plate, random, scattered);
    if (passage) sums.left += passage->weight.g / walks;
  }
  return sums;
}

TEST(MediumWalk, LosesNothingWhereNothingAbsorbs) {
  for (const double depth : {1e-3, 0.5, 3.0})
    for (const float cosine : {1.0F, 0.3F})
      EXPECT_NEAR(walked(medium(depth, 1.0), seen_from(cosine)).left, -std::expm1(-depth / cosine), 0.003)
          << depth << " " << cosine;
}

TEST(MediumWalk, IsFirstScatteredWhereLightIs) {
  const double depth = 1.5;
  const double sigma_t = depth / thickness;
  const double mean = 1.0 / sigma_t - thickness * std::exp(-depth) / -std::expm1(-depth);
  EXPECT_NEAR(walked(medium(depth, 0.5), seen_from(1.0F)).first_depth, mean, 0.004 * thickness);
}

/// What is seen of a plate of this medium alone, on average.
Gather::All looked(Heap heap, const Optics& optics, const SeenFacet& seen) {
  heap.grains.kinds = {optics};
  heap.grains.grains = {{glm::vec3(0.0F), 1.0F, 0}};
  const Gather gather(heap, std::make_shared<const HeapLight>(light_alone(heap, {})));
  transport::Random random(5, 0);
  const std::optional<Gather::All> all = gather.look_at_all(seen, facets(), {walks}, random);
  EXPECT_TRUE(all);
  return all.value_or(Gather::All{});
}

TEST(MediumLook, IsNotSeenInAnEvenWorldWhereNothingAbsorbs) {
  Heap heap;
  heap.world.radiance = glm::dvec3(1.0);
  for (const double depth : {0.1, 2.0}) {
    const Gather::All all = looked(heap, medium(depth, 1.0), seen_from(0.4F));
    EXPECT_NEAR(all.scattered.g + all.world.g, 1.0, 0.005) << depth;
    EXPECT_NEAR(all.world.g, std::exp(-depth / 0.4), 1e-4) << depth;
    EXPECT_EQ(all.others, glm::vec3(0.0F));
  }
}

// Chandrasekhar, "Radiative Transfer", 1960, section 27, of light that was scattered once.
TEST(MediumLook, IsLitAsAThinLayerIs) {
  constexpr double albedo = 0.01;
  constexpr double depth = 0.8;
  Heap heap;
  heap.lights = {scene::DirectionalLight{.direction_to_light = glm::dvec3(up), .irradiance = glm::dvec3(1.0)}};
  const double of_phase = albedo / (4.0 * std::numbers::pi);
  const double above = -of_phase * 0.5 * std::expm1(-2.0 * depth);
  const double below = of_phase * depth * std::exp(-depth);
  EXPECT_NEAR(looked(heap, medium(depth, albedo), seen_from(1.0F)).scattered.g, above, 0.015 * above);
  const SeenFacet from_below{0, -half_thickness * up, -up, -up};
  EXPECT_NEAR(looked(heap, medium(depth, albedo), from_below).scattered.g, below, 0.015 * below);
}

/// A shell of one side.
class Sheet : public Plate {
 public:
  Sheet() : Plate({.roughness = 0.0F, .shown = false, .correlated = false}) {}
  std::optional<Meeting> inside(std::uint32_t, const glm::vec3&, const glm::vec3&) const override {
    return std::nullopt;
  }
};

TEST(MediumLook, IsNoneWhereAGrainHasNoOtherSide) {
  Heap heap;
  heap.grains.kinds = {medium(1.0, 0.9)};
  heap.grains.grains = {{glm::vec3(0.0F), 1.0F, 0}};
  const Gather gather(heap, std::make_shared<const HeapLight>(light_alone(heap, {})));
  transport::Random random(5, 0);
  EXPECT_FALSE(gather.look_at_all(seen_from(1.0F), Sheet(), {1}, random));
}

}  // namespace
}  // namespace mesograin::heap
