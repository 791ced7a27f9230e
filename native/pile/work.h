// A pile that settles beside whoever asked for it.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>

#include "pile/settle.h"

namespace mesograin::pile {

class Work {
 public:
  /// Begins to settle; the arguments are settle's.
  Work(Grains grains, Ground ground, Walls walls, double friction, std::uint64_t seed);

  /// Ends it.
  ~Work();
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// How far it is, 0 to 1.
  double share() const { return share_; }
  bool done() const { return done_; }
  void cancel() { cancelled_ = true; }

  /// Waits. Throws what settle threw, and Error if it was cancelled.
  const Pile& result();

 private:
  Pile pile_;
  std::exception_ptr error_;
  std::atomic<double> share_{0.0};
  std::atomic<bool> cancelled_{false};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace mesograin::pile
