// A heap's light being solved: on a thread of its own, coarsely first, and given up when nobody waits for it any more.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "heap/solver.h"

namespace mesograin::heap {

/// What is known so far.
struct News {
  int number = 0;                          ///< grows with everything new
  std::shared_ptr<const HeapLight> light;  ///< the best so far, or null
  bool final = false;
  std::string failure;  ///< one sentence, if there can be none
};

/// One heap's, for as long as somebody holds it. May be asked from any thread.
class Solving {
 public:
  Solving(Heap heap, std::shared_ptr<Solver> solver) : heap_(std::move(heap)), solver_(std::move(solver)) {}

  const Heap& heap() const { return heap_; }

  News news() const;

  /// The share that is done.
  double progress() const { return progress_; }

  /// Whether all is known, after waiting this long at most.
  bool wait(std::chrono::milliseconds patience) const;

 private:
  friend class Solvers;

  void tell(std::shared_ptr<const HeapLight> light, bool final, std::string failure = {});

  const Heap heap_;
  const std::shared_ptr<Solver> solver_;  ///< the thread's
  mutable std::mutex mutex_;
  mutable std::condition_variable told_;
  News news_;
  std::atomic<double> progress_{0.0};
};

class Solvers {
 public:
  /// The one that all share; its thread starts with the first heap.
  static Solvers& instance();

  Solvers() = default;
  ~Solvers();
  Solvers(const Solvers&) = delete;
  Solvers& operator=(const Solvers&) = delete;

  /// Returns at once. The same heap is solved once for all who hold it, and what was asked for last is solved first.
  /// `before`: what was asked for in its place before, with which it may have much in common; or null.
  std::shared_ptr<const Solving> ask(Heap heap, const std::shared_ptr<const Solving>& before);

 private:
  void loop(const std::stop_token& stop);
  static void work(const std::weak_ptr<Solving>& of, const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<std::weak_ptr<Solving>> held_;
  std::vector<std::weak_ptr<Solving>> waiting_;
  std::jthread thread_;
};

}  // namespace mesograin::heap
