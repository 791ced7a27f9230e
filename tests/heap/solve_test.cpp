// What is solved is what it says, and no worse than the guess, even where rays by chance make light of nothing.
#include "heap/solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
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

/// The processor's sums, taken as if by something else, which fails after so many.
class Failing : public Sums {
 public:
  Failing(const Links& links, int good) : links_(links), left_(good) {}

  void gather(const Field& sent, Field& answer, const transport::Effort& effort) override {
    answer = {};
    if (left_-- == 0) throw std::runtime_error("It is broken.");
    links_.gather(sent, answer, effort);
  }

 private:
  const Links& links_;
  int left_;
};

TEST(Solve, IsWhatItIsWhoeverSumsAndWheneverThatFails) {
  const Field light = ones();
  const Links links = ring(0.9F, 0.2F);
  const auto solved = [&](const MakeSums& make_sums) {
    return solve(links, nullptr, light, {}, {1e-4F}, {}, make_sums);
  };
  const auto fails_after = [](int good) {
    return [good](const Links& of, const Change* /*change*/, const transport::Effort& /*effort*/) {
      return std::make_unique<Failing>(of, good);
    };
  };
  const Solved right = solved({});
  EXPECT_FALSE(right.summed_on_device);
  const auto expect_right = [&](const MakeSums& make_sums, bool summed) {
    const Solved found = solved(make_sums);
    EXPECT_EQ(found.summed_on_device, summed);
    EXPECT_EQ(found.residual, right.residual);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(found.sent[i].channels, right.sent[i].channels);
  };
  expect_right(fails_after(-1), true);
  for (const int good : {0, 1, 3}) expect_right(fails_after(good), false);
  expect_right([](const Links&, const Change*, const transport::Effort&) { return nullptr; }, false);
  expect_right([](const Links&, const Change*,
                  const transport::Effort&) -> std::unique_ptr<Sums> { throw std::runtime_error("There is no room."); },
               false);
  const MakeSums stopped = [](const Links&, const Change*, const transport::Effort&) -> std::unique_ptr<Sums> {
    throw transport::Stopped{};
  };
  EXPECT_THROW(solved(stopped), transport::Stopped);
}

}  // namespace
}  // namespace mesograin::heap
