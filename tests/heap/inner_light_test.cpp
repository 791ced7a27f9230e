// A grain's inner light is what was added of it.
#include "heap/inner_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "transport/directions.h"
#include "transport/random.h"

namespace {

using mesograin::heap::InnerLight;
using mesograin::transport::Random;

glm::vec3 in_ball(Random& random) {
  const float u = random.uniform();
  const glm::vec3 direction = mesograin::transport::isotropic(u, random.uniform());
  return std::cbrt(random.uniform()) * direction;
}

glm::vec3 cubic(const glm::vec3& p) {
  return {3.0F + p.x * p.y * p.z - p.y * p.y * p.y, 2.0F - p.z + 0.5F * p.x * p.x, 4.0F + p.x * p.x * p.y - p.z * p.z};
}

/// Of as many scatterings of weight 1, `found(place)` after each.
template <typename Found>
InnerLight learnt(int scatterings, Random& random, const Found& found) {
  InnerLight light;
  for (int i = 0; i < scatterings; ++i) {
    const glm::vec3 place = in_ball(random);
    light.add(place, glm::vec3(1.0F), found(place));
  }
  light.fit();
  return light;
}

TEST(InnerLight, IsThePolynomialThatItIs) {
  Random random(1, 0);
  const InnerLight light = learnt(20000, random, cubic);
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 place = in_ball(random);
    EXPECT_LT(glm::length(light.at(place) - cubic(place)), 0.02F);
  }
}

TEST(InnerLight, IsTheSameOnALine) {
  Random random(5, 0);
  const InnerLight light = learnt(2000, random, cubic);
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 from = in_ball(random);
    const glm::vec3 to = in_ball(random);
    const InnerLight::Line line = light.along(from, to);
    for (const float share : {0.0F, 0.2F, 0.55F, 0.9F, 1.0F}) {
      const glm::vec3 there = light.at(from + share * (to - from));
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(line.at(share, channel), there[channel], 2e-4F) << share;
    }
  }
}

TEST(InnerLight, IsTheMeanOfWhatIsNoise) {
  Random random(2, 0);
  const InnerLight light = learnt(20000, random, [&](const glm::vec3& place) {
    return random.uniform() < 0.1F ? 10.0F * cubic(place) : glm::vec3(0.0F);
  });
  glm::vec3 off(0.0F);
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 place = in_ball(random);
    off += glm::abs(light.at(place) - cubic(place)) / cubic(place);
  }
  off /= 1000.0F;
  EXPECT_LT(std::max({off.r, off.g, off.b}), 0.12F);
}

// Light of another channel weighs otherwise on the same walks, and tells nothing where it has no weight.
TEST(InnerLight, IsEachChannelsOwn) {
  Random random(3, 0);
  InnerLight light;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 place = in_ball(random);
    const glm::vec3 weight(0.1F + random.uniform(), 2.0F + place.x, 0.0F);
    light.add(place, weight, weight * cubic(place));
  }
  light.fit();
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 place = in_ball(random);
    const glm::vec3 found = light.at(place);
    EXPECT_NEAR(found.r, cubic(place).r, 0.03F);
    EXPECT_NEAR(found.g, cubic(place).g, 0.03F);
    EXPECT_EQ(found.b, 0.0F);
  }
}

TEST(InnerLight, IsEvenWhereLittleIsKnown) {
  InnerLight light;
  light.add({0.9F, 0.0F, 0.0F}, glm::vec3(1.0F), glm::vec3(2.0F));
  light.add({-0.9F, 0.0F, 0.0F}, glm::vec3(1.0F), glm::vec3(2.0F));
  light.fit();
  EXPECT_LT(glm::length(light.at({0.0F, 0.8F, 0.0F}) - glm::vec3(2.0F)), 0.8F);
  EXPECT_EQ(InnerLight().at({0.3F, 0.1F, 0.0F}), glm::vec3(0.0F));
}

TEST(InnerLight, IsNowhereLessThanNone) {
  Random random(4, 0);
  const InnerLight light =
      learnt(5000, random, [](const glm::vec3& place) { return glm::vec3(place.x > 0.7F ? 1.0F : 0.0F); });
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 found = light.at(in_ball(random));
    EXPECT_GE(std::min({found.r, found.g, found.b}), 0.0F);
  }
}

}  // namespace
