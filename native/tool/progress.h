// How far a render is and how long it will take yet, on stderr.
#pragma once

#include <chrono>
#include <optional>

namespace mesograin::tool {

/// On a terminal one line that is rewritten; elsewhere a line every few seconds, so that a log stays readable.
class Progress {
 public:
  Progress();

  /// May be called as often as one likes. `samples`: how many there are to be, if that is known; `preparing`: the share
  /// done of what comes before the first.
  void show(int samples_done, std::optional<int> samples, std::optional<double> preparing);

  /// Clears the terminal's line.
  void finish();

  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;

  bool terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
};

}  // namespace mesograin::tool
