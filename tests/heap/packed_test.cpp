// What is packed comes out as it was, or, of many, as their mean.
#include "heap/packed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "heap/packed_coefficients.h"
#include "transport/directions.h"
#include "transport/random.h"

namespace {

using mesograin::heap::Coefficients;
using mesograin::heap::PackedCoefficients;
using mesograin::heap::PackedPlace;
using mesograin::heap::PackedWeight;
using mesograin::transport::Random;

TEST(Packed, PlacesAreNearlyWhereTheyWere) {
  Random random(1, 0);
  for (int i = 0; i < 1000; ++i) {
    const float length = 1.5F * random.uniform();
    const float u = random.uniform();
    const glm::vec3 place = length * mesograin::transport::isotropic(u, random.uniform());
    EXPECT_LT(glm::distance(PackedPlace(place).whole(), place), 0.003F);
  }
}

TEST(Packed, NowhereStaysNowhere) { EXPECT_EQ(PackedPlace(glm::vec3(0.0F)).whole(), glm::vec3(0.0F)); }

TEST(Packed, PlacesThatAreTooFarAreAtTheEdge) {
  EXPECT_NEAR(PackedPlace({9.0F, 0.0F, -9.0F}).whole().x, 1.6F, 1e-5F);
  EXPECT_NEAR(PackedPlace({9.0F, 0.0F, -9.0F}).whole().z, -1.6F, 1e-5F);
}

TEST(Packed, WeightsAreNearlyWhatTheyWere) {
  Random random(2, 0);
  for (int i = 0; i < 2000; ++i) {
    const float size = std::exp2(160.0F * random.uniform() - 80.0F);
    const float r = random.uniform();
    const float g = random.uniform();
    const glm::vec3 weight = size * glm::vec3(r, g, 1.0F);
    const glm::vec3 off = PackedWeight(weight, random.bits()).whole() - weight;
    EXPECT_LE(std::max({std::abs(off.r), std::abs(off.g), std::abs(off.b)}), size / 128.0F) << size;
  }
}

// Of the power of two below 1, of what is just below the next, and of what a byte's steps cannot tell.
TEST(Packed, ManyWeightsAreRightTogether) {
  for (const float size : {0.5F, 0.999F, 0.7512F, 0.9961F, 0.50195F}) {
    const glm::vec3 weight(size, 0.3333F * size, 0.01234F * size);
    glm::dvec3 sum(0.0);
    constexpr int count = 200'000;
    for (int i = 0; i < count; ++i) {
      Random random(3, static_cast<std::uint64_t>(i));
      sum += glm::dvec3(PackedWeight(weight, random.bits()).whole());
    }
    const glm::dvec3 off = sum / static_cast<double>(count) - glm::dvec3(weight);
    EXPECT_LT(glm::length(off), 1e-4 * static_cast<double>(size)) << size;
  }
}

TEST(Packed, NoWeightStaysNone) {
  EXPECT_EQ(PackedWeight(glm::vec3(0.0F), ~0U).whole(), glm::vec3(0.0F));
  const glm::vec3 red = PackedWeight({1.0F, 0.0F, 0.0F}, 0xFFU).whole();
  EXPECT_EQ(red.g + red.b, 0.0F);
}

TEST(Packed, AFewBytes) { EXPECT_EQ(sizeof(PackedPlace) + sizeof(PackedWeight), 8U); }

TEST(Packed, CoefficientsAreNearlyWhatTheyWere) {
  Random random(4, 0);
  Coefficients of;
  for (int i = 0; i < 20; ++i) {
    const float u = random.uniform();
    const glm::vec3 place = mesograin::transport::isotropic(u, random.uniform());
    of.add(glm::vec3(1e-20F, 1.0F, 1e20F) * random.uniform(), place, true);
  }
  const Coefficients packed = PackedCoefficients(of).whole();
  const auto expect_near = [](float number, float right) { EXPECT_NEAR(number, right, 0.004F * std::abs(right)); };
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (int i = 0; i < 4; ++i) expect_near(packed.channels[channel][i], of.channels[channel][i]);
    for (std::size_t i = 0; i < 5; ++i) expect_near((*packed.second.get())[channel][i], (*of.second.get())[channel][i]);
  }
  EXPECT_EQ(PackedCoefficients(Coefficients()).whole().at(glm::vec3(0.0F, 0.6F, 0.8F)), glm::vec3(0.0F));
}

}  // namespace
