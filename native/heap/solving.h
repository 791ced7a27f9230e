// A heap's light while it changes: solved on a thread of its own, coarsely first, and given up when the heap has
// changed again.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "heap/solver.h"

namespace mesograin::heap {

/// What is known so far of the heap that was asked for last.
struct News {
  int number = 0;                          ///< grows with everything new
  std::shared_ptr<const HeapLight> light;  ///< the best so far, or null
  bool final = true;
  std::string failure;  ///< one sentence, if there can be none
};

/// May be asked from any thread.
class Solving {
 public:
  Solving() = default;
  ~Solving();
  Solving(const Solving&) = delete;
  Solving& operator=(const Solving&) = delete;

  /// Returns at once.
  void begin(Heap heap);

  /// Nothing is asked for any more, and what was found is forgotten.
  void end();

  News news() const;

  /// The share that is done of what is under way.
  double progress() const { return progress_; }

  /// Whether all is known, after waiting this long at most.
  bool wait(std::chrono::milliseconds patience) const;

 private:
  void loop(const std::stop_token& stop);
  void work(const Heap& heap);
  void tell(HeapLight light, bool final);

  mutable std::mutex mutex_;
  mutable std::condition_variable told_;
  std::condition_variable_any wake_;
  std::optional<Heap> next_;
  bool forget_ = false;
  std::atomic<bool> given_up_{false};  ///< what is under way
  std::atomic<double> progress_{0.0};
  News news_;
  Solver solver_;  ///< the thread's
  std::jthread thread_;
};

}  // namespace mesograin::heap
