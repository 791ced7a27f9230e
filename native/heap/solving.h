// A heap's light being solved: on a thread of its own, coarsely first, and given up when nobody waits for it any more.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "heap/solver.h"
#include "transport/backlog.h"

namespace mesograin::heap {

/// What is known so far.
struct News {
  int number = 0;                            ///< another for each light; 0 while there is none
  std::shared_ptr<const HeapLight> light{};  ///< the best so far, or null
  std::shared_ptr<const Heap> heap{};        ///< that the light is of: until its own is known, one that was before
  bool final = false;
  std::string failure{};  ///< one sentence, if there can be none
};

class Solving;

/// What is asked for in one place, one heap after the other.
struct Line {
  Solver solver;                  ///< the thread's
  std::weak_ptr<Solving> latest;  ///< guarded by the mutex of Solvers
};

/// One heap's, for as long as somebody holds it. May be asked from any thread.
class Solving {
 public:
  Solving(std::shared_ptr<const Heap> heap, std::shared_ptr<Line> line, News before, MakeSums make_sums)
      : heap_(std::move(heap)), line_(std::move(line)), make_sums_(std::move(make_sums)), news_(std::move(before)) {}

  const Heap& heap() const { return *heap_; }
  const std::shared_ptr<const Heap>& shared_heap() const { return heap_; }

  News news() const;

  /// Whether any light of its own is known.
  bool lit() const;

  /// The share that is done.
  double progress() const { return progress_; }

  /// Whether all is known, after waiting this long at most.
  bool wait(std::chrono::milliseconds patience) const;

 private:
  friend class Solvers;

  void tell(News news);

  const std::shared_ptr<const Heap> heap_;
  const std::shared_ptr<Line> line_;
  const MakeSums make_sums_;
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
  Solvers(const Solvers&) = delete;
  Solvers& operator=(const Solvers&) = delete;

  /// Returns at once. The same heap is solved once for all who hold it, and what was asked for last is solved first.
  /// `before`: what was asked for in its place before, with which it may have much in common; or null. What changes
  /// faster than it is solved, a slider that is dragged, a heap that falls, has the light of a moment ago: a coarse
  /// answer that is under way is finished for what was asked for since, if that has about as many grains; all else
  /// that nobody holds any more is given up. `make_sums`: as for heap::solve(), called on the thread; of a heap that
  /// somebody holds already, those asked for then are taken.
  std::shared_ptr<const Solving> ask(Heap heap, const std::shared_ptr<const Solving>& before, MakeSums make_sums = {});

 private:
  void work(const std::weak_ptr<Solving>& of, const std::stop_token& stop);

  /// As rays find them; that of another place, if that knows them.
  Neighbourhood neighbourhood_of(const Grains& grains);

  /// Whether what was asked for last in this place can be shown in the light of `heap`.
  bool has_heir(const Line& line, const Heap& heap);

  /// The one that it is of, and what has taken its place since.
  void tell(const std::weak_ptr<Solving>& of, const Line& line, News news);

  std::mutex mutex_;
  std::vector<std::weak_ptr<Solving>> held_;
  int told_ = 0;  // lights; the thread's
  transport::Backlog<std::weak_ptr<Solving>> waiting_{
      [this](const std::weak_ptr<Solving>& of, const std::stop_token& stop) { work(of, stop); }};
};

}  // namespace mesograin::heap
