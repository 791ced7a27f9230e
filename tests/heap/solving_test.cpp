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
  const auto asked = std::chrono::steady_clock::now();
  const Parts before = solving->news().light->parts;
  solving = solvers.ask(lit(20, 0.98), solving);
  EXPECT_LT(std::chrono::steady_clock::now() - asked, 50ms);
  while (!solving->lit()) solving->wait(1ms);
  const Parts after = solving->news().light->parts;
  EXPECT_EQ(after.links, before.links) << "the finest rays were traced to their end";
  EXPECT_EQ(after.solutions, before.solutions + 1);
}

// A slider that moves on every few milliseconds is as one that stands still but for what is under way.
TEST(Solvers, ShowWhatChangesFasterThanItIsSolvedInTheLightOfAMomentAgo) {
  Solvers solvers;
  std::shared_ptr<const Solving> solving = solvers.ask(lit(16, 0.9), nullptr);
  solving->wait(1ms);
  const auto started = std::chrono::steady_clock::now();
  auto longest_asked = 0ns;
  News shown;
  int lights = 0;
  for (int step = 1; lights < 5 && std::chrono::steady_clock::now() - started < 60s; ++step) {
    Heap next = lit(16, 0.9 + 1e-5 * step);
    const auto asked = std::chrono::steady_clock::now();
    solving = solvers.ask(std::move(next), solving);
    longest_asked = std::max<std::chrono::nanoseconds>(longest_asked, std::chrono::steady_clock::now() - asked);
    EXPECT_FALSE(solving->wait(2ms)) << "solved within two milliseconds: a larger heap would tell more";
    const News news = solving->news();
    if (!news.light || news.number == shown.number) continue;
    EXPECT_TRUE(!shown.light || albedo(news) > albedo(shown)) << "older light than what was shown";
    shown = news;
    ++lights;
  }
  EXPECT_EQ(lights, 5) << "the slider moved and the light stood still";
  EXPECT_LT(longest_asked, 1s) << "who asks waits for nothing";
  ASSERT_TRUE(solving->wait(60s));
  EXPECT_TRUE(solving->lit());
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
