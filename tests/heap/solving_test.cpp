// Light is told as soon as it is known, of the heap that was asked for last.
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

TEST(Solving, TellsACoarseAnswerFirst) {
  Solving solving;
  EXPECT_TRUE(solving.news().final);
  solving.begin(lit(14, 0.99));
  EXPECT_FALSE(solving.news().final);
  int coarse_answers = 0;
  int number = 0;
  while (!solving.wait(1ms)) {
    const News news = solving.news();
    if (news.light && !news.final && news.number != number) ++coarse_answers;
    number = news.number;
  }
  EXPECT_EQ(coarse_answers, 1);
  ASSERT_TRUE(solving.news().light);
  EXPECT_LT(solving.news().light->residual, Quality().tolerance);
}

TEST(Solving, GivesUpWhatIsAskedForNoMore) {
  Solving solving;
  solving.begin(lit(20, 0.99));
  while (!solving.news().light) solving.wait(1ms);
  // By now many rays are being traced.
  const auto asked = std::chrono::steady_clock::now();
  solving.begin(lit(4, 0.5));
  EXPECT_LT(std::chrono::steady_clock::now() - asked, 20ms);
  EXPECT_FALSE(solving.news().light);
  ASSERT_TRUE(solving.wait(60s));
  EXPECT_EQ(solving.news().light->sent.size(), 64U);
}

TEST(Solving, KnowsNothingAtItsEnd) {
  Solving solving;
  solving.begin(lit(10, 0.9));
  solving.end();
  EXPECT_TRUE(solving.wait(0ms));
  EXPECT_FALSE(solving.news().light);
  solving.begin(lit(3, 0.9));
  ASSERT_TRUE(solving.wait(60s));
  EXPECT_TRUE(solving.news().light);
}

}  // namespace
}  // namespace mesograin::heap
