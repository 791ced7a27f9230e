// Jobs that a thread of its own works off, what came last first.
#pragma once

#include <unistd.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

namespace mesograin::transport {

template <typename Job>
class Backlog {
 public:
  /// Called on the thread, a job at a time. Asked to stop, it is waited for.
  using Work = std::function<void(const Job&, const std::stop_token&)>;

  explicit Backlog(Work work) : work_(std::move(work)) {}

  /// Returns at once. The thread starts with the first job.
  void add(Job job) {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
    if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
    wake_.notify_all();
  }

 private:
  // Drawing goes first where there are few cores.
  static constexpr int niceness = 5;

  void loop(const std::stop_token& stop) {
    // Of this thread and those that it starts.
    if (::nice(niceness) < 0) { /* then it competes with drawing */
    }
    while (true) {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return !jobs_.empty(); })) return;
      const Job job = std::move(jobs_.back());
      jobs_.pop_back();
      lock.unlock();
      work_(job, stop);
    }
  }

  const Work work_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<Job> jobs_;
  std::jthread thread_;
};

}  // namespace mesograin::transport
