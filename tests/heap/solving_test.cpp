// Light is told as soon as it is known, once for all who ask for the same heap.
#include "heap/solving.h"

#include <gtest/gtest.h>

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
  while (!solving->news().light) solving->wait(1ms);
  const Parts after = solving->news().light->parts;
  EXPECT_EQ(after.links, before.links) << "the finest rays were traced to their end";
  EXPECT_EQ(after.solutions, before.solutions + 1);
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
