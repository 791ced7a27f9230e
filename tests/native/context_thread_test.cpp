// In which order the context's thread takes what is posted to it.
#include "gl/context_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <future>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/error.h"

namespace mesograin::gl {
namespace {

TEST(ContextThreadTest, WhatIsPostedGoesBeforeStepsAndUrgentStepsBeforeOthers) {
  ContextThread& thread = ContextThread::instance();
  std::promise<void> open;
  const auto held = thread.post([&] { open.get_future().wait(); });
  std::string order;
  const auto repeat = [&](char name, bool urgent) {
    return thread.repeat<bool>(
        [&order, name, first = true]() mutable -> std::optional<bool> {
          order += name;
          return std::exchange(first, false) ? std::nullopt : std::optional(true);
        },
        [urgent] { return urgent; });
  };
  std::future<bool> patient = repeat('a', false);
  std::future<bool> other = repeat('b', false);
  std::future<bool> urgent = repeat('u', true);
  std::future<void> posted = thread.post([&] { order += 'p'; });
  open.set_value();
  posted.get();
  EXPECT_TRUE(urgent.get() && patient.get() && other.get());
  EXPECT_EQ(order, "puuabab");
}

TEST(ContextThreadTest, AStepThatIsNotReadyHoldsUpNobodyAndIsTakenOnceItIs) {
  ContextThread& thread = ContextThread::instance();
  std::atomic<bool> ready = false;
  std::string order;
  const auto repeat = [&](char name, std::function<bool()> is_ready) {
    return thread.repeat<bool>(
        [&order, name] {
          order += name;
          return std::optional(true);
        },
        [] { return false; }, std::move(is_ready));
  };
  std::future<bool> waiting = repeat('w', [&] { return ready.load(); });
  EXPECT_TRUE(repeat('o', [] { return true; }).get());
  thread.run([&] { order += 'p'; });
  EXPECT_EQ(order, "op");
  ready = true;  // which nobody tells the thread
  EXPECT_TRUE(waiting.get());
  EXPECT_EQ(order, "opw");
}

TEST(ContextThreadTest, ShutDownEndsAStepThatNeverBecomesReady) {
  std::future<bool> endless = ContextThread::instance().repeat<bool>([] { return std::optional(true); },
                                                                     [] { return false; }, [] { return false; });
  ContextThread::shut_down();
  EXPECT_THROW(endless.get(), Error);
}

TEST(ContextThreadTest, WhatAStepThrowsEndsItAndIsHandedOn) {
  ContextThread& thread = ContextThread::instance();
  int steps = 0;
  std::future<bool> broken = thread.repeat<bool>(
      [&]() -> std::optional<bool> {
        if (++steps == 3) throw std::runtime_error("no more");
        return std::nullopt;
      },
      [] { return false; });
  EXPECT_THROW(broken.get(), std::runtime_error);
  thread.run([] {});
  EXPECT_EQ(steps, 3);
}

}  // namespace
}  // namespace mesograin::gl
