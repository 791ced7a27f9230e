// What is solved is what it says, and no worse than the guess, even where rays by chance make light of nothing.
#include "heap/solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "transport/random.h"

namespace mesograin::heap {
namespace {

constexpr std::size_t count = 4000;

/// Each receives from eight that are near in number, in all so much, give or take `noise`.
Links ring(float albedo, float noise) {
  constexpr int each = 8;
  Links links{std::vector<std::vector<Link>>(count), {}, {}, std::make_shared<const Seats>(count), {}};
  transport::Random random(1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const float sum = albedo * (1.0F + noise * (2.0F * random.uniform() - 1.0F));
    for (int j = 0; j < each; ++j) {
      const auto ahead = static_cast<std::size_t>(1.0F + 40.0F * random.uniform());
      const PackedPlace nowhere(glm::vec3(0.0F));
      links.of[i].push_back({static_cast<std::uint32_t>((i + count + ahead - 20) % count), nowhere, nowhere,
                             PackedWeight(glm::vec3(sum / each), random.bits())});
    }
  }
  return links;
}

float left_over_light(const Links& links, const Field& sent, const Field& light) {
  Field answer;
  links.gather(sent, answer, {});
  double left = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec4 off(light[i].channels[0] + answer[i].channels[0] - sent[i].channels[0]);
    left += glm::dot(off, off);
    all += glm::dot(glm::dvec4(light[i].channels[0]), glm::dvec4(light[i].channels[0]));
  }
  return static_cast<float>(std::sqrt(left / all));
}

Field ones() {
  Coefficients one;
  for (glm::vec4& channel : one.channels) channel = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
  return Field(count, one);
}

TEST(Solve, LeavesAsLittleAsItSays) {
  const Field light = ones();
  for (const float noise : {0.0F, 0.2F}) {
    const Links links = ring(0.9F, noise);
    const Solved solved = solve(links, nullptr, light, {}, {1e-4F}, {});
    EXPECT_LE(solved.residual, 1e-4F);
    EXPECT_NEAR(left_over_light(links, solved.sent, light), solved.residual, 1e-5F);
  }
}

TEST(Solve, GivesItsBestWhereThereIsNoSolutionToBeHad) {
  const Field light = ones();
  const Links links = ring(1.0F, 0.3F);
  const Solved from_light = solve(links, nullptr, light, {}, {1e-6F}, {});
  EXPECT_LT(from_light.steps, 400);
  EXPECT_LE(from_light.residual, 1.01F * left_over_light(links, light, light));
  EXPECT_NEAR(left_over_light(links, from_light.sent, light), from_light.residual, 0.01F * from_light.residual);
  // The best may be what it began from.
  const Solved again = solve(links, nullptr, light, from_light.sent, {1e-9F}, {});
  EXPECT_LE(again.residual, from_light.residual * 1.01F);
}

}  // namespace
}  // namespace mesograin::heap
