// One heap at a time, the last that was asked for.
#include "heap/solving.h"

#include <unistd.h>

#include <exception>
#include <utility>

namespace mesograin::heap {
namespace {

// Drawing goes first where there are few cores.
constexpr int background_niceness = 5;

}  // namespace

Solving::~Solving() {
  thread_.request_stop();
  const std::lock_guard lock(mutex_);
  given_up_ = true;
}

void Solving::begin(Heap heap) {
  const std::lock_guard lock(mutex_);
  next_ = std::move(heap);
  news_ = {news_.number, nullptr, false, {}};
  given_up_ = true;
  progress_ = 0.0;
  if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
  wake_.notify_all();
}

void Solving::end() {
  const std::lock_guard lock(mutex_);
  next_.reset();
  news_ = {news_.number, nullptr, true, {}};
  given_up_ = forget_ = true;
  wake_.notify_all();
}

News Solving::news() const {
  const std::lock_guard lock(mutex_);
  return news_;
}

bool Solving::wait(std::chrono::milliseconds patience) const {
  std::unique_lock lock(mutex_);
  return told_.wait_for(lock, patience, [this] { return news_.final; });
}

void Solving::loop(const std::stop_token& stop) {
  // Of this thread and those that it starts.
  if (::nice(background_niceness) < 0) { /* then it competes with drawing */
  }
  while (true) {
    Heap heap;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return next_ || forget_; })) return;
      if (std::exchange(forget_, false)) solver_ = Solver();
      if (!next_) continue;
      heap = *std::exchange(next_, std::nullopt);
      given_up_ = stop.stop_requested();
    }
    work(heap);
  }
}

void Solving::work(const Heap& heap) {
  transport::Effort effort;
  effort.stop = &given_up_;
  effort.progress = [this](double share) { progress_ = share; };
  // A quick answer takes about a tenth of the time.
  constexpr double first = 0.1;
  try {
    tell(solver_.solve(heap, coarse, transport::part_of(effort, 0.0, first)), false);
    tell(solver_.solve(heap, {}, transport::part_of(effort, first, 1.0)), true);
  } catch (const transport::Stopped&) {
    return;
  } catch (const std::exception& failure) {
    const std::lock_guard lock(mutex_);
    if (given_up_) return;
    news_ = {news_.number + 1, nullptr, true, failure.what()};
    told_.notify_all();
  }
}

void Solving::tell(HeapLight light, bool final) {
  auto known = std::make_shared<const HeapLight>(std::move(light));
  const std::lock_guard lock(mutex_);
  // It may have been asked for another in the meantime.
  if (given_up_) return;
  news_ = {news_.number + 1, std::move(known), final, {}};
  told_.notify_all();
}

}  // namespace mesograin::heap
