// A memo holds the last few, makes each once, and tells what kept it from being made.
#include "base/memo.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace mesograin {
namespace {

TEST(Memo, HoldsWhatWasAskedForLast) {
  Memo<int, int> memo(2);
  int made = 0;
  const auto ask = [&](int key) {
    return *memo.get(key, [&] {
      ++made;
      return 10 * key;
    });
  };
  for (const int key : {1, 2, 1, 3, 1}) EXPECT_EQ(ask(key), 10 * key);
  EXPECT_EQ(made, 3);
  EXPECT_EQ(ask(2), 20) << "it went when the third came";
  EXPECT_EQ(made, 4);
}

TEST(Memo, IsMadeOnceForAllThreads) {
  Memo<int, int> memo(4);
  std::atomic<int> made = 0;
  std::atomic<int> right = 0;
  constexpr int asking = 8;
  std::vector<std::jthread> threads;
  threads.reserve(asking);
  for (int thread = 0; thread < asking; ++thread)
    threads.emplace_back([&] {
      for (int key = 0; key < 4; ++key)
        right += *memo.get(key, [&] {
          ++made;
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
          return 1 + key;
        }) == 1 + key;
    });
  threads.clear();
  EXPECT_EQ(made, 4);
  EXPECT_EQ(right, 32);
}

TEST(Memo, AFailureIsToldAndTriedAgain) {
  Memo<int, int> memo(4);
  EXPECT_THROW(memo.get(1, []() -> int { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(*memo.get(1, [] { return 7; }), 7);
}

}  // namespace
}  // namespace mesograin
