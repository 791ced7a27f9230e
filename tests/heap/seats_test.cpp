// Numbers that deep grains share tell what is linear in them as it is, and nobody shares where light comes near.
#include "heap/seats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>
#include <vector>

#include "heaps.h"

namespace mesograin::heap {
namespace {

constexpr int side = 20;

/// Of a lattice, whether a grain lies at its surface.
bool outermost(const Grain& grain, int across = side) {
  const glm::vec3 at = grain.middle / 2.05F;
  return std::min({at.x, at.y, at.z}) < 0.5F || std::max({at.x, at.y, at.z}) > static_cast<float>(across) - 1.5F;
}

Seats seats_of(const std::vector<Grain>& grains, int cells_below = 1, int across = side, bool eights = true) {
  return Seats(grains, cells_below, eights, [&](std::uint32_t grain) { return outermost(grains[grain], across); });
}

Coefficients linear_at(const glm::vec3& place) {
  Coefficients light;
  for (glm::vec4& channel : light.channels)
    channel = glm::vec4(0.1F * place.x, 0.2F, 0.0F, 3.0F + 0.3F * place.x - 0.2F * place.y + 0.1F * place.z);
  return light;
}

TEST(Seats, TellWhatIsLinearAsItIs) {
  const std::vector<Grain> grains = lattice(side, lambert(0.5)).grains.grains;
  const Seats seats = seats_of(grains);
  ASSERT_TRUE(seats.shared());
  EXPECT_LT(seats.told(), grains.size() * 3 / 4);
  Field answers;
  for (std::size_t i = 0; i < seats.answering(); ++i) answers.push_back(linear_at(grains[seats.number(i)].middle));
  answers.emplace_back(linear_at(glm::vec3(7.0F)));  // of a wall
  const Field told = seats.told(std::move(answers));
  ASSERT_EQ(told.size(), seats.told() + 1);
  for (std::uint32_t i = 0; i < grains.size(); ++i) {
    const Coefficients right = linear_at(grains[i].middle);
    const Coefficients light = seats.of(told, i);
    const float off = seats.shares(i) ? 0.1F : 0.0F;  // slopes are held back by a hundredth
    EXPECT_NEAR(light.channels[1].w, right.channels[1].w, off) << i;
    EXPECT_NEAR(light.channels[1].x, right.channels[1].x, off) << i;
    const glm::vec3 normal(0.6F, 0.0F, 0.8F);
    EXPECT_NEAR(seats.light_at(told, i, normal, false).g, light.first_at(normal).g, 1e-4F) << i;
  }
  EXPECT_EQ(seats.of(told, static_cast<std::uint32_t>(grains.size())).channels, linear_at(glm::vec3(7.0F)).channels);
}

// Eight cells are one there: of these 262 000 grains 183 000 answer.
TEST(Seats, AreFewerTheDeeperGrainsLie) {
  constexpr int across = 64;
  const std::vector<Grain> grains = lattice(across, lambert(0.5)).grains.grains;
  const Seats seats = seats_of(grains, 1, across);
  EXPECT_LT(seats.answering(), grains.size() * 3 / 4);
  EXPECT_GT(seats_of(grains, 1, across, false).answering(), seats.answering());
  Field answers;
  for (std::size_t i = 0; i < seats.answering(); ++i) answers.push_back(linear_at(grains[seats.number(i)].middle));
  const Field told = seats.told(std::move(answers));
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    EXPECT_NEAR(seats.of(told, i).channels[1].w, linear_at(grains[i].middle).channels[1].w, 0.2F) << i;
}

TEST(Seats, AreSharedAsFarBelowTheSurfaceAsIsAskedFor) {
  const std::vector<Grain> grains = lattice(side, lambert(0.5)).grains.grains;
  std::size_t before = 0;
  for (const int cells : {1, 2, 3, 9}) {
    const Seats seats = seats_of(grains, cells);
    EXPECT_GT(seats.own(), before);
    before = seats.own();
    std::vector<int> seated(grains.size(), 0);
    for (std::size_t seat = 0; seat < seats.own(); ++seat) {
      ++seated[seats.number(seat)];
      EXPECT_EQ(seats.seat(seats.number(seat)), seat);
    }
    for (std::uint32_t i = 0; i < grains.size(); ++i) {
      EXPECT_EQ(seated[i], seats.shares(i) ? 0 : 1) << i;
      EXPECT_FALSE(seats.shares(i) && outermost(grains[i])) << i;
    }
  }
  EXPECT_EQ(before, grains.size()) << "none lies nine cells deep";
}

TEST(Seats, AreTheGrainsOwnWhereNoneLiesDeep) {
  std::vector<Grain> scattered = lattice(12, lambert(0.5), 40.0).grains.grains;
  scattered.push_back({glm::vec3(1e18F, -1e30F, 0.0F), 1e-20F, 0});
  for (const std::vector<Grain>& grains : {scattered, std::vector<Grain>{}, std::vector<Grain>(100, scattered[0])}) {
    const Seats seats(grains, 1, true, [](std::uint32_t /*grain*/) { return true; });
    EXPECT_FALSE(seats.shared());
    EXPECT_EQ(seats.told(), grains.size());
    EXPECT_EQ(seats.answering(), grains.size());
  }
}

}  // namespace
}  // namespace mesograin::heap
