// Light is told as soon as it is known, once for all who ask for the same heap.
#include "heap/solving.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "heaps.h"

namespace mesograin::heap {
namespace {

using namespace std::chrono_literals;

Heap lit(int side, double albedo) {
  Heap heap = lattice(side, medium(3.0, albedo));
  heap.lights.emplace_back(scene::DirectionalLight{{0.0, 0.6, 0.8}, glm::dvec3(3.0)});
  return heap;
}

/// Whose grains answer nothing that others send.
Heap alone(int side, double albedo) {
  Heap heap = lit(side, albedo);
  heap.exchanges = false;
  return heap;
}

double albedo(const News& news) { return news.heap->grains.kinds[0].albedo.r; }

TEST(Solvers, TellACoarseAnswerFirst) {
  Solvers solvers;
  const std::shared_ptr<const Solving> solving = solvers.ask(lit(14, 0.99), nullptr);
  int coarse_answers = 0;
  int number = 0;
  while (!solving->wait(1ms)) {
    const News news = solving->news();
    if (news.light && !news.final && news.number != number) ++coarse_answers;
    number = news.number;
  }
  EXPECT_EQ(coarse_answers, 1);
  ASSERT_TRUE(solving->news().light);
  EXPECT_LT(solving->news().light->residual, Quality().tolerance);
}

TEST(Solvers, GiveUpWhatNobodyWaitsForAnyMore) {
  Solvers solvers;
  std::shared_ptr<const Solving> solving = solvers.ask(lit(20, 0.99), nullptr);
  while (!solving->news().light) solving->wait(1ms);
  // By now many rays are being traced.
  const Parts before = solving->news().light->parts;
  solving = solvers.ask(lit(20, 0.98), solving);
  EXPECT_FALSE(solving->lit()) << "who asks waited for it";
  while (!solving->lit()) solving->wait(1ms);
  const Parts after = solving->news().light->parts;
  EXPECT_EQ(after.links, before.links) << "the finest rays were traced to their end";
  EXPECT_EQ(after.solutions, before.solutions + 1);
}

// A slider that moves on as soon as its heap is being solved is as one that stands still but for what is under way.
TEST(Solvers, ShowWhatChangesFasterThanItIsSolvedInTheLightOfAMomentAgo) {
  Solvers solvers;
  std::shared_ptr<const Solving> solving = solvers.ask(lit(16, 0.9), nullptr);
  const auto begun = [&] {
    while (solving->progress() == 0.0) solving->wait(1ms);
  };
  begun();
  News shown;
  // Steps that were asked for while the light before was shown still, and then had another that was not their own.
  // Where a machine is busy a step may come so late that its heap has light of its own: of many steps some do not.
  int handed_on = 0;
  for (int step = 1; handed_on < 5 && step <= 50; ++step) {
    solving = solvers.ask(lit(16, 0.9 + 1e-5 * step), solving);
    const bool waited_for_nothing = solving->news().number == shown.number;
    begun();
    const News news = solving->news();
    if (!news.light || news.number == shown.number) continue;
    EXPECT_TRUE(!shown.light || albedo(news) > albedo(shown)) << "older light than what was shown";
    shown = news;
    if (waited_for_nothing && news.heap.get() != &solving->heap()) ++handed_on;
  }
  EXPECT_EQ(handed_on, 5) << "the slider moved and the light stood still, or who asked waited for it";
  ASSERT_TRUE(solving->wait(60s));
  EXPECT_TRUE(solving->lit());
}

TEST(Solvers, ShowNoLightBetweenGrainsWhereThereIsToBeNone) {
  Solvers solvers;
  const std::shared_ptr<const Solving> first = solvers.ask(lit(4, 0.9), nullptr);
  ASSERT_TRUE(first->wait(60s));
  const std::shared_ptr<const Solving> second = solvers.ask(alone(4, 0.9), first);
  ASSERT_TRUE(second->wait(60s));
  ASSERT_TRUE(second->news().light);
  EXPECT_TRUE(second->lit());
  const HeapLight& light = *second->news().light;
  for (std::uint32_t grain = 0; grain < 64; ++grain)
    EXPECT_EQ(light.seats->light_at(light.sent, grain, {0.0F, 0.0F, 1.0F}, true), glm::vec3(0.0F));
  const std::shared_ptr<const Solving> third = solvers.ask(lit(4, 0.8), second);
  const News news = third->news();
  EXPECT_TRUE(!news.light || third->lit()) << "the light of grains that answer none";
  ASSERT_TRUE(third->wait(60s));
}

TEST(Solvers, HandALightOnThatNobodyHasTakenYet) {
  Solvers solvers;
  const std::shared_ptr<const Solving> first = solvers.ask(lit(4, 0.9), nullptr);
  ASSERT_TRUE(first->wait(60s));
  const std::shared_ptr<const Solving> second = solvers.ask(lit(4, 0.8), first);
  const News news = second->news();
  EXPECT_TRUE(news.light);
  if (news.heap.get() == &first->heap()) {
    EXPECT_EQ(news.number, first->news().number) << "who has taken it need not take it again";
    EXPECT_FALSE(news.final);
  }
  ASSERT_TRUE(second->wait(60s));
  EXPECT_TRUE(second->lit());
}

TEST(Solvers, KeepAHeapsOwnLightWhenAnEarlierOneIsSolvedAfterIt) {
  Solvers solvers;
  const std::shared_ptr<const Solving> busy = solvers.ask(lit(14, 0.99), nullptr);
  const std::shared_ptr<const Solving> first = solvers.ask(lit(4, 0.9), nullptr);
  const std::shared_ptr<const Solving> second = solvers.ask(lit(4, 0.8), first);
  for (const auto& one : {second, first}) {
    ASSERT_TRUE(one->wait(60s));
    EXPECT_TRUE(one->lit());
  }
  EXPECT_TRUE(second->news().final);
}

TEST(Solvers, GiveUpACoarseAnswerThatNoOtherHeapCanShow) {
  Solvers solvers;
  std::shared_ptr<const Solving> solving = solvers.ask(lit(20, 0.99), nullptr);
  while (solving->progress() == 0.0) solving->wait(1ms);
  solving = solvers.ask(lit(4, 0.98), solving);
  ASSERT_TRUE(solving->wait(60s));
  EXPECT_TRUE(solving->lit());
  EXPECT_EQ(solving->news().light->parts.solutions, 2) << "the large heap was solved to the end";
}

TEST(Solvers, KnowOneTreeOfWhatStandsInTheSamePlaces) {
  Solvers solvers;
  const std::shared_ptr<const Solving> one = solvers.ask(lit(4, 0.9), nullptr);
  ASSERT_TRUE(one->wait(60s));
  const std::shared_ptr<const Solving> other = solvers.ask(alone(4, 0.9), nullptr);
  ASSERT_TRUE(other->wait(60s));
  ASSERT_TRUE(other->news().light->neighbourhood);
  EXPECT_EQ(other->news().light->neighbourhood, one->news().light->neighbourhood);
  const std::shared_ptr<const Solving> changed = solvers.ask(alone(4, 0.8), other);
  ASSERT_TRUE(changed->wait(60s));
  EXPECT_EQ(changed->news().light->neighbourhood, one->news().light->neighbourhood);
  const std::shared_ptr<const Solving> elsewhere = solvers.ask(alone(5, 0.8), changed);
  ASSERT_TRUE(elsewhere->wait(60s));
  EXPECT_NE(elsewhere->news().light->neighbourhood, one->news().light->neighbourhood);
}

TEST(Solvers, SolveTheSameHeapOnce) {
  Solvers solvers;
  const std::shared_ptr<const Solving> one = solvers.ask(lit(4, 0.9), nullptr);
  EXPECT_EQ(solvers.ask(lit(4, 0.9), nullptr), one);
  EXPECT_NE(solvers.ask(lit(4, 0.8), nullptr), one);
  ASSERT_TRUE(one->wait(60s));
  EXPECT_EQ(one->news().light->parts.solutions, 2);
}

}  // namespace
}  // namespace mesograin::heap
