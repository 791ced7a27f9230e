// What one grain does to light against what is known of it in closed form.
#include "heap/grain_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <set>
#include <tuple>

#include "heap/exchange.h"
#include "heap/heap.h"

namespace mesograin::heap {
namespace {

Optics medium(Surface surface, const glm::dvec3& sigma_t, const glm::dvec3& albedo) {
  Optics optics;
  optics.surface = surface;
  optics.sigma_t = sigma_t;
  optics.albedo = albedo;
  optics.eta = surface == Surface::dielectric || surface == Surface::lambert_refracted ? 1.5 : 1.0;
  return optics;
}

TEST(GrainTable, LosesNoLightWithoutAbsorption) {
  for (const Surface surface : {Surface::index_matched, Surface::dielectric, Surface::lambert_lambert})
    for (const double radius : {1e-6, 1e-2, 1.0, 30.0}) {
      const GrainTable table(medium(surface, glm::dvec3(radius), glm::dvec3(1.0)), Sense::from_light, {});
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(table.albedo()[channel], table.met()[channel], 1e-4F * table.met()[channel])
            << static_cast<int>(surface) << " " << radius;
    }
}

TEST(GrainTable, IsKeptWhileSomebodyHasItElseAmongTheLast64) {
  const auto table_of = [](double radius, int walks = GrainTable::outcomes) {
    const Optics optics = medium(Surface::index_matched, glm::dvec3(radius), glm::dvec3(0.5));
    return grain_table(optics, Sense::from_light, {}, walks);
  };
  const std::shared_ptr<const GrainTable> held = table_of(1.0);
  const std::weak_ptr<const GrainTable> last = table_of(2.0);
  EXPECT_FALSE(last.expired());
  const std::weak_ptr<const GrainTable> quick = table_of(2.0, 64);
  table_of(2.5);
  EXPECT_TRUE(quick.expired()) << "few walks are soon walked again";
  for (int others = 0; others < 65; ++others) table_of(3.0 + others);
  EXPECT_TRUE(last.expired());
  EXPECT_EQ(table_of(1.0), held);
}

TEST(GrainTable, MeetsLightAsGeometricExtinctionHasIt) {
  for (const double radius : {1e-6, 1e-3, 0.03, 1.0, 10.0, 1e6}) {
    const GrainTable table(medium(Surface::index_matched, glm::dvec3(radius), glm::dvec3(0.0)), Sense::from_light, {});
    double sum = 0.0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const double mu = (i + 0.5) / steps;
      sum -= std::expm1(-2.0 * radius * mu) * 2.0 * mu / steps;
    }
    EXPECT_NEAR(table.met().r, sum, 1e-4 * sum) << radius;
    EXPECT_EQ(table.albedo(), glm::vec3(0.0F));
  }
}

TEST(GrainTable, ChannelsDoNotKnowOfEachOther) {
  const GrainTable mixed(medium(Surface::index_matched, {0.5, 3.0, 8.0}, {0.9, 0.5, 0.99}), Sense::from_light, {});
  for (int channel = 0; channel < 3; ++channel) {
    const glm::dvec3 sigma_t{0.5, 3.0, 8.0};
    const glm::dvec3 albedo{0.9, 0.5, 0.99};
    const GrainTable grey(medium(Surface::index_matched, glm::dvec3(sigma_t[channel]), glm::dvec3(albedo[channel])),
                          Sense::from_light, {});
    EXPECT_NEAR(mixed.albedo()[channel], grey.albedo()[channel], 0.01F * grey.albedo()[channel]) << channel;
    for (std::size_t node = 2; node < GrainTable::lobe_nodes; ++node)
      EXPECT_NEAR(mixed.leaving().lobe[node][channel], grey.leaving().lobe[node][channel], 0.12F)
          << channel << " " << node;
  }
}

TEST(OfOthers, LightScatteredForwardsCrossesAndWhatIsAbsorbedStays) {
  Optics optics = medium(Surface::index_matched, {1.0, 2.0, 0.0}, {0.9, 1.0, 0.0});
  optics.g = 0.8;
  const Optics others = of_others(optics);
  EXPECT_EQ(others.g, 0.0);
  const glm::dvec3 sigma_t{0.1 + 0.2 * 0.9, 0.2 * 2.0, 0.0};
  const glm::dvec3 albedo{0.18 / 0.28, 1.0, 0.0};
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(others.sigma_t[channel], sigma_t[channel], 1e-12) << channel;
    EXPECT_NEAR(others.albedo[channel], albedo[channel], 1e-12) << channel;
  }
}

TEST(OfOthers, WhatScattersEvenlyOrBackwardsOrRefractsIsAsItIs) {
  Optics optics = medium(Surface::index_matched, glm::dvec3(2.0), glm::dvec3(0.9));
  EXPECT_EQ(of_others(optics), optics);
  optics.g = -0.5;
  EXPECT_EQ(of_others(optics), optics);
  optics = medium(Surface::dielectric, glm::dvec3(2.0), glm::dvec3(0.9));
  optics.g = 0.5;
  EXPECT_EQ(of_others(optics), optics);
}

TEST(GrainTable, TheNoiseOfManyKindsIsNotThatOfTheirMean) {
  Grains grains;
  constexpr int kinds = 64;
  for (int i = 0; i < kinds; ++i)
    grains.kind(medium(Surface::index_matched, glm::dvec3(3.0 * (1.0 + 1e-9 * i)), glm::dvec3(0.9)));
  double sum = 0.0;
  double squares = 0.0;
  for (const Kind& kind : kinds_of(grains.kinds, GrainTable::most_walks, {})) {
    const auto albedo = static_cast<double>(kind.from_light->albedo().r);
    sum += albedo;
    squares += albedo * albedo;
  }
  const double mean = sum / kinds;
  const GrainTable one(grains.kinds[0], Sense::from_light, {});
  EXPECT_NEAR(mean, one.albedo().r, 0.003 * mean);
  EXPECT_GT(std::sqrt(std::max(squares / kinds - mean * mean, 0.0)), 0.0005 * mean) << "all have the same noise";
}

// For a first picture kinds share their walks: each has few, all together tell what they do to light.
TEST(GrainTable, ManyKindsShareTheWalksOfAQuickAnswer) {
  constexpr int kinds = 64;
  Grains grains;
  for (int i = 0; i < kinds; ++i)
    grains.kind(medium(Surface::dielectric, glm::dvec3(3.0 * (1.0 + 1e-9 * i)), glm::dvec3(0.9)));
  double sum = 0.0;
  for (const Kind& kind : kinds_of(grains.kinds, coarse.walks, {})) {
    sum += static_cast<double>(kind.from_light->albedo().r);
    std::set<float> outcomes;  // at one angle, as many as there were walks
    for (int i = 0; i < GrainTable::outcomes; ++i)
      outcomes.insert(kind.from_light->draw(0.9F, (static_cast<float>(i) + 0.5F) / GrainTable::outcomes).direction.x);
    EXPECT_LE(outcomes.size(), static_cast<std::size_t>(coarse.walks / 8));
  }
  const GrainTable one(grains.kinds[0], Sense::from_light, {});
  // What a walk sends back, between 0 and 1, deviates by half at most; `one` has as many as all kinds together.
  constexpr double walks = double{GrainTable::most_walks} * GrainTable::entries;
  EXPECT_NEAR(sum / kinds, one.albedo().r, 3.0 * 0.5 * std::sqrt(2.0 / walks));
}

// What a slider's step changes beyond a line through many steps would be seen to flicker; each table's own noise is
// ten times that.
TEST(GrainTable, ASlidersStepsChangeNoRandomNumbers) {
  for (const Surface surface : {Surface::index_matched, Surface::dielectric, Surface::lambert_lambert}) {
    constexpr int steps = 9;
    std::array<double, steps> albedo{};
    for (int step = 0; step < steps; ++step) {
      const Optics optics = medium(surface, glm::dvec3(10.0 + 0.01 * step), glm::dvec3(0.999));
      const std::shared_ptr<const GrainTable> table = grain_table(optics, Sense::from_light, {}, 1024);
      albedo[static_cast<std::size_t>(step)] = static_cast<double>(table->albedo().r);
    }
    for (std::size_t step = 1; step + 1 < steps; ++step)
      EXPECT_NEAR(albedo[step], 0.5 * (albedo[step - 1] + albedo[step + 1]), 2e-4 * albedo[step])
          << static_cast<int>(surface) << " " << step;
  }
}

TEST(GrainTable, OutcomesAreEquallyHeavyAndSumUp) {
  const GrainTable table(medium(Surface::dielectric, glm::dvec3(3.0), glm::dvec3(0.9)), Sense::from_light, {});
  glm::vec3 sum(0.0F);
  for (int entry = 0; entry < GrainTable::entries; ++entry) {
    const float mu = std::sqrt((static_cast<float>(entry) + 0.5F) / GrainTable::entries);
    const float first = table.draw(mu, 0.0F).weight.r;
    for (int i = 0; i < GrainTable::outcomes; ++i) {
      const Outcome outcome = table.draw(mu, (static_cast<float>(i) + 0.5F) / GrainTable::outcomes);
      EXPECT_NEAR(outcome.weight.r, first, 1e-5F);
      EXPECT_NEAR(glm::length(outcome.normal), 1.0F, 1e-4F);
      EXPECT_GE(glm::dot(outcome.normal, outcome.direction), -1e-4F);
      sum += outcome.weight;
    }
  }
  sum /= GrainTable::entries * GrainTable::outcomes;
  EXPECT_NEAR(sum.r, table.albedo().r, 1e-4F);
}

TEST(GrainTable, FourNumbersOfWhatRefractsSendOnAsMuchForwardAsWalksDo) {
  const glm::vec3 normal(0.0F, 0.0F, 1.0F);
  for (const double radius : {0.2, 1.0, 3.0, 30.0}) {
    const GrainTable table(medium(Surface::dielectric, glm::dvec3(radius), glm::dvec3(0.999)), Sense::from_light, {});
    constexpr int steps = 256;
    double forward = 0.0;
    double told = 0.0;
    for (int i = 0; i < steps; ++i)
      for (int choice = 0; choice < GrainTable::outcomes; ++choice) {
        const float squared = (static_cast<float>(i) + 0.5F) / steps;
        const float mu = std::sqrt(squared);
        const glm::vec3 travelling(std::sqrt(1.0F - squared), 0.0F, -mu);
        const Outcome outcome = table.draw(mu, (static_cast<float>(choice) + 0.5F) / GrainTable::outcomes);
        constexpr double share = 1.0 / (steps * GrainTable::outcomes);
        forward += share * static_cast<double>(outcome.weight.g * glm::dot(outcome.direction, travelling));
        const glm::vec3 place = table.seen_place(outcome.normal, outcome.direction);
        told += share * static_cast<double>(outcome.weight.g * glm::dot(place, travelling));
      }
    // What is sent out in proportion to 1 + 3 told place . travelling, in directions of a cosine's lobe.
    double square = 0.0;
    double along = 0.0;
    for (int i = 0; i < steps; ++i) {
      const float cosine = std::sqrt((static_cast<float>(i) + 0.5F) / steps);
      const glm::vec3 direction(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
      const glm::vec3 place = table.seen_place(normal, direction);
      square += static_cast<double>(glm::dot(place, place)) / steps;
      along += static_cast<double>(glm::dot(place, direction)) / steps;
    }
    EXPECT_NEAR(square, 1.0, 1e-4) << radius;
    EXPECT_NEAR(told * along, forward, 0.02) << radius;
    EXPECT_GT(along, 0.0) << radius;
  }
}

TEST(GrainTable, CrystalsAreNoLenses) {
  Optics crystal = medium(Surface::dielectric, glm::dvec3(0.2), glm::dvec3(0.999));
  crystal.lens = false;
  const GrainTable table(crystal, Sense::from_light, {});
  const glm::vec3 normal(0.0F, 0.0F, 1.0F);
  EXPECT_EQ(table.seen_place(normal, glm::vec3(0.6F, 0.0F, 0.8F)), normal);
  EXPECT_FALSE(table.is_fine());
}

TEST(GrainTable, OrderTwoTellsOfThickGrainsAlone) {
  for (const Surface surface : {Surface::index_matched, Surface::dielectric})
    for (const auto& [radius, g, fine] : {std::tuple{3.0, 0.0, false}, {10.0, 0.0, true}, {40.0, 0.9, false}}) {
      Optics optics = medium(surface, glm::dvec3(0.1, radius, 0.1), glm::dvec3(0.999));
      optics.g = g;
      optics.lens = false;
      EXPECT_EQ(GrainTable(optics, Sense::from_light, {}, 64).is_fine(), fine) << radius << " " << g;
    }
}

TEST(GrainTable, ClearGrainsScatterAsMuchAsTheirWalksDo) {
  for (const double radius : {0.02, 0.2, 1.5}) {
    const Optics optics = medium(Surface::dielectric, glm::dvec3(radius), glm::dvec3(1.0));
    const GrainTable table(optics, Sense::from_light, {});
    ASSERT_TRUE(table.is_clear());
    transport::Random random(1, 0);
    constexpr int walks = 1 << 17;
    int scattered = 0;
    for (int i = 0; i < walks; ++i) {
      const std::optional<Outcome> outcome = walk(optics, Sense::from_light, std::sqrt(random.uniform()), random);
      if (outcome && outcome->scattered) ++scattered;
    }
    const double share = static_cast<double>(scattered) / walks;
    EXPECT_NEAR(table.scattered().g, share, 4.0 * std::sqrt(share / walks)) << radius;
  }
  const GrainTable thick(medium(Surface::dielectric, glm::dvec3(3.0), glm::dvec3(1.0)), Sense::from_light, {});
  EXPECT_FALSE(thick.is_clear());
  EXPECT_EQ(thick.scattered(), glm::vec3(0.0F));
}

TEST(GrainTable, IsFiniteAtExtremes) {
  for (const Surface surface : {Surface::lambert, Surface::mirror, Surface::index_matched, Surface::dielectric,
                                Surface::lambert_lambert, Surface::lambert_refracted})
    for (const double radius : {0.0, 1e-30, 1e-6, 3.0})
      for (const double albedo : {0.0, 1.0}) {
        const GrainTable table(medium(surface, {radius, 0.0, 2.0 * radius}, {albedo, 0.0, 1.0}), Sense::from_light, {});
        for (int channel = 0; channel < 3; ++channel) {
          EXPECT_TRUE(std::isfinite(table.albedo()[channel]));
          EXPECT_LE(table.albedo()[channel], surface == Surface::lambert_refracted ? 2.3F : 1.0001F);
          for (const glm::vec3& node : table.leaving().lobe) EXPECT_TRUE(std::isfinite(node[channel]));
        }
      }
}

}  // namespace
}  // namespace mesograin::heap
