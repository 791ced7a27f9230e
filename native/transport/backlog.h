// Jobs that a thread of its own works off, what came last first.
#pragma once

#include <unistd.h>

#include <chrono>
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

  /// Called on the thread once there was no job for so long; tells whether it shall be called again.
  using Rest = std::function<bool()>;

  explicit Backlog(Work work)
      : Backlog(
            std::move(work), [] { return false; }, std::chrono::milliseconds(0)) {}

  Backlog(Work work, Rest rest, std::chrono::milliseconds pause)
      : work_(std::move(work)), rest_(std::move(rest)), pause_(pause) {}

  /// Returns at once. The thread starts with the first job.
  void add(Job job) { add(std::move(job), false); }

  /// The same, but it is worked off after all that wait or will come as others do.
  void add_after_others(Job job) { add(std::move(job), true); }

 private:
  // Drawing goes first where there are few cores.
  static constexpr int niceness = 5;

  void add(Job job, bool after_others) {
    const std::lock_guard lock(mutex_);
    jobs_.insert(after_others ? jobs_.begin() : jobs_.end(), std::move(job));
    if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
    wake_.notify_all();
  }

  void loop(const std::stop_token& stop) {
    // Of this thread and those that it starts.
    if (::nice(niceness) < 0) { /* then it competes with drawing */
    }
    const auto any = [this] { return !jobs_.empty(); };
    bool rests = false;
    while (true) {
      std::unique_lock lock(mutex_);
      while (rests && !wake_.wait_for(lock, stop, pause_, any) && !stop.stop_requested()) {
        lock.unlock();
        rests = rest_();
        lock.lock();
      }
      if (!wake_.wait(lock, stop, any)) return;
      const Job job = std::move(jobs_.back());
      jobs_.pop_back();
      lock.unlock();
      work_(job, stop);
      rests = true;
    }
  }

  const Work work_;
  const Rest rest_;
  const std::chrono::milliseconds pause_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<Job> jobs_;
  std::jthread thread_;
};

}  // namespace mesograin::transport
