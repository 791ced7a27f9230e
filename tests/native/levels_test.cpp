// How large grains are seen decides how they are looked at; what a coarser look lacks is made good by few closer ones.
#include "render/levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace mesograin::render {
namespace {

TEST(Levels, PixelsAcrossAreThoseOfThePicture) {
  const glm::ivec2 size(200, 100);
  // 90 degrees high: at a depth of 5 the picture is 10 high.
  const glm::mat4 perspective = glm::perspective(glm::radians(90.0F), 2.0F, 0.1F, 100.0F);
  const glm::mat4 back = glm::translate(glm::mat4(1.0F), {0.0F, 0.0F, -4.0F});
  const PixelsAcross of(perspective * back, size);
  EXPECT_NEAR(of.of({0.0F, 0.0F, -1.0F, 0.5F}), 10.0F, 1e-4F);
  EXPECT_NEAR(of.of({3.0F, 1.0F, -1.0F, 0.25F}), 5.0F, 1e-4F);
  EXPECT_TRUE(std::isinf(of.of({0.0F, 0.0F, 5.0F, 0.5F}))) << "behind the camera";
  const PixelsAcross parallel(glm::ortho(-10.0F, 10.0F, -5.0F, 5.0F, -100.0F, 100.0F), size);
  EXPECT_NEAR(parallel.of({7.0F, 2.0F, 40.0F, 0.5F}), 10.0F, 1e-4F);
  EXPECT_EQ(parallel.of({0.0F, 0.0F, 0.0F, 0.0F}), 0.0F);
}

TEST(Levels, TheSmallerTheLessClosely) {
  EXPECT_EQ(level_of(false, 3.0, 100.0F), Level::own_shape);
  EXPECT_EQ(level_of(false, 3.0, 7.0F), Level::ball);
  EXPECT_EQ(level_of(true, 3.0, 7.0F), Level::own_shape);
  EXPECT_EQ(level_of(false, 3.0, 3.0F), Level::told);
  EXPECT_EQ(level_of(true, 3.0, 3.0F), Level::told);
  for (const Awaited one_sample : {Awaited::more_known, Awaited::changed}) {
    EXPECT_EQ(level_of(true, 3.0, 7.0F, one_sample), Level::told);
    EXPECT_EQ(level_of(true, 3.0, 9.0F, one_sample), Level::own_shape);
  }
  EXPECT_EQ(level_of(false, 3.0, 20.0F, Awaited::changed), Level::told);
  EXPECT_EQ(level_of(false, 10.0, 20.0F, Awaited::changed), Level::own_shape) << "a thick one";
  EXPECT_EQ(level_of(false, 3.0, 20.0F, Awaited::more_known), Level::own_shape);
  EXPECT_EQ(level_of(false, 3.0, 30.0F, Awaited::changed), Level::own_shape);
  EXPECT_EQ(level_of(false, 3.0, NAN), Level::ball) << "of nothing that is known";
}

Amends::Probe probe(std::size_t unit, Level level, const glm::vec3& closest, const glm::vec3& coarse) {
  Amends::Probe result{unit, level, {}, {}};
  result.closest.scattered = closest;
  result.coarse.scattered = coarse;
  result.closest.world = glm::vec3(0.5F);
  result.coarse.world = glm::vec3(1.0F);
  return result;
}

TEST(Levels, AmendsComeToTheRatioOfMeansChannelByChannel) {
  Amends amends;
  const auto near = [](const glm::vec3& a, const glm::vec3& b) { return glm::length(a - b) < 0.01F; };
  EXPECT_EQ(amends.factors(3, Level::told).scattered, glm::vec3(1.0F));
  amends.add(probe(1, Level::told, {2.0F, 1.0F, 0.5F}, glm::vec3(1.0F)));
  EXPECT_TRUE(near(amends.factors(1, Level::told).scattered, glm::vec3(1.0F))) << "one pixel tells next to nothing";
  // The mean's ratio, not the mean of ratios, which noise would raise.
  for (int i = 0; i < 50'000; ++i) {
    amends.add(probe(1, Level::told, {1.6F, 1.1F, 0.6F}, {2.0F, 0.5F, 1.0F}));
    amends.add(probe(1, Level::told, {0.8F, 1.1F, 0.6F}, {0.0F, 1.5F, 1.0F}));
  }
  EXPECT_TRUE(near(amends.factors(1, Level::told).scattered, {1.2F, 1.1F, 0.6F}));
  EXPECT_TRUE(near(amends.factors(1, Level::told).straight, glm::vec3(0.5F)));
  EXPECT_EQ(amends.factors(1, Level::ball).scattered, glm::vec3(1.0F)) << "another level";
  EXPECT_EQ(amends.factors(0, Level::told).scattered, glm::vec3(1.0F)) << "another unit";
  amends.forget();
  EXPECT_EQ(amends.factors(1, Level::told).scattered, glm::vec3(1.0F));
}

TEST(Levels, NoLightAndNoiseLeaveNoNumberThatIsNone) {
  Amends amends;
  for (int i = 0; i < 1000; ++i) amends.add(probe(0, Level::ball, {0.0F, 1.0F, 1e30F}, {0.0F, 0.0F, 1e-30F}));
  const glm::vec3 factors = amends.factors(0, Level::ball).scattered;
  EXPECT_EQ(factors.r, 1.0F);
  EXPECT_EQ(factors.g, 1.0F);
  EXPECT_LE(factors.b, 2.0F);
}

}  // namespace
}  // namespace mesograin::render
