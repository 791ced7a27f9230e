// A stack of heaps and the thread that solves them.
#include "heap/solving.h"

#include <unistd.h>

#include <exception>
#include <utility>

namespace mesograin::heap {
namespace {

// Drawing goes first where there are few cores.
constexpr int background_niceness = 5;

// A quick answer takes about a tenth of the time.
constexpr double quick_share = 0.1;

}  // namespace

News Solving::news() const {
  const std::lock_guard lock(mutex_);
  return news_;
}

bool Solving::wait(std::chrono::milliseconds patience) const {
  std::unique_lock lock(mutex_);
  return told_.wait_for(lock, patience, [this] { return news_.final; });
}

void Solving::tell(std::shared_ptr<const HeapLight> light, bool final, std::string failure) {
  {
    const std::lock_guard lock(mutex_);
    news_ = {news_.number + 1, std::move(light), final, std::move(failure)};
  }
  told_.notify_all();
}

Solvers& Solvers::instance() {
  static Solvers solvers;
  return solvers;
}

Solvers::~Solvers() {
  thread_.request_stop();
  wake_.notify_all();
}

std::shared_ptr<const Solving> Solvers::ask(Heap heap, const std::shared_ptr<const Solving>& before) {
  const std::lock_guard lock(mutex_);
  std::erase_if(held_, [](const std::weak_ptr<Solving>& one) { return one.expired(); });
  for (const std::weak_ptr<Solving>& one : held_)
    if (std::shared_ptr<Solving> same = one.lock(); same && same->heap() == heap) return same;
  auto solving = std::make_shared<Solving>(std::move(heap), before ? before->solver_ : std::make_shared<Solver>());
  held_.push_back(solving);
  waiting_.push_back(solving);
  if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
  wake_.notify_all();
  return solving;
}

void Solvers::loop(const std::stop_token& stop) {
  // Of this thread and those that it starts.
  if (::nice(background_niceness) < 0) { /* then it competes with drawing */
  }
  while (true) {
    std::weak_ptr<Solving> next;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return !waiting_.empty(); })) return;
      next = std::move(waiting_.back());
      waiting_.pop_back();
    }
    work(next, stop);
  }
}

void Solvers::work(const std::weak_ptr<Solving>& of, const std::stop_token& stop) {
  std::atomic<bool> given_up{false};
  Heap heap;
  std::shared_ptr<Solver> solver;
  if (const std::shared_ptr<Solving> solving = of.lock()) {
    heap = solving->heap_;
    solver = solving->solver_;
  } else {
    return;
  }
  const auto tell = [&](const Quality& quality, const transport::Effort& effort, bool final) {
    auto light = std::make_shared<const HeapLight>(solver->solve(heap, quality, effort));
    if (const std::shared_ptr<Solving> solving = of.lock()) solving->tell(std::move(light), final);
  };
  transport::Effort effort;
  effort.stop = &given_up;
  effort.progress = [&](double share) {
    const std::shared_ptr<Solving> solving = of.lock();
    if (solving) solving->progress_ = share;
    if (!solving || stop.stop_requested()) given_up = true;
  };
  try {
    tell(coarse, transport::part_of(effort, 0.0, quick_share), false);
    tell(quality_for(heap.grains.grains.size()), transport::part_of(effort, quick_share, 1.0), true);
  } catch (const transport::Stopped&) {
    return;
  } catch (const std::exception& failure) {
    if (const std::shared_ptr<Solving> solving = of.lock()) solving->tell(nullptr, true, failure.what());
  }
}

}  // namespace mesograin::heap
