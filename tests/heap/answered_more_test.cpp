// What few walks tell of another material against the tables of both.
#include "heap/answered_more.h"

#include <gtest/gtest.h>

#include <tuple>

#include "heap/grain_table.h"
#include "heaps.h"

namespace mesograin::heap {
namespace {

Optics ball_of(Surface surface, double sigma_t, const glm::dvec3& albedo) {
  Optics optics = medium(sigma_t, 1.0);
  optics.surface = surface;
  optics.albedo = albedo;
  if (surface == Surface::dielectric) optics.eta = 1.5;
  return optics;
}

TEST(AnsweredMore, IsTheRatioOfTablesWhateverChanges) {
  const glm::dvec3 white(0.999, 0.99, 0.95);
  const glm::dvec3 brown(0.99, 0.95, 0.9);
  for (const Surface surface : {Surface::index_matched, Surface::dielectric})
    for (const auto& [thin, thick] : {std::tuple{1.0, 1.1}, {3.0, 3.0}, {3.0, 4.0}, {10.0, 9.0}}) {
      const Optics before = ball_of(surface, thin, white);
      const Optics now = ball_of(surface, thick, brown);
      const GrainTable was(before, Sense::from_light, {});
      const GrainTable is(now, Sense::from_light, {});
      const glm::vec3 more = answered_more(now, before).of_all;
      for (int channel = 0; channel < 3; ++channel) {
        const float right = is.albedo()[channel] / was.albedo()[channel];
        EXPECT_NEAR(more[channel], right, 0.06F * right) << static_cast<int>(surface) << " " << thin << " " << channel;
        const float of_met = right * was.met()[channel] / is.met()[channel];
        EXPECT_NEAR(answered_more(now, before).of_met[channel], of_met, 0.06F * of_met);
      }
    }
}

TEST(AnsweredMore, HasNoNoiseWhereLittleChanges) {
  const Optics before = medium(3.0, 0.9);
  Optics now = before;
  now.albedo = glm::dvec3(0.91);
  const GrainTable was(before, Sense::from_light, {});
  const GrainTable is(now, Sense::from_light, {});
  EXPECT_NEAR(answered_more(now, before).of_all.g, is.albedo().g / was.albedo().g, 0.004F);
  EXPECT_EQ(answered_more(before, before).of_all, glm::vec3(1.0F));
  for (const AnsweredMore& more : answered_more(std::vector<Optics>(64, now), std::vector<Optics>(64, before)))
    EXPECT_NEAR(more.of_all.g, is.albedo().g / was.albedo().g, 0.008F) << "of many kinds, by fewer walks";
}

TEST(AnsweredMore, TellsNothingOfWhatWasBlack) {
  const Optics black = medium(3.0, 0.0);
  const Optics white = medium(3.0, 0.99);
  EXPECT_EQ(answered_more(white, black).of_all, glm::vec3(1.0F));
  EXPECT_LT(answered_more(black, white).of_all.g, 1e-3F);
  EXPECT_EQ(answered_more(std::vector<Optics>{white, black}, {white}).size(), 2U);
}

}  // namespace
}  // namespace mesograin::heap
