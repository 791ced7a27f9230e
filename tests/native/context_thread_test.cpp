// In which order the context's thread takes what is posted to it.
#include "gl/context_thread.h"

#include <gtest/gtest.h>

#include <future>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

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
