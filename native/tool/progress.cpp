// Time left is what the samples so far took on average.
#include "tool/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace mesograin::tool {
namespace {

std::string duration(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace

Progress::Progress() : terminal_(::isatty(STDERR_FILENO) == 1) {}

double Progress::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::show(int samples_done, std::optional<int> samples, std::optional<double> preparing) {
  const Clock::duration pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(5);
  if (Clock::now() - shown_ < pause) return;
  shown_ = Clock::now();
  if (preparing && samples_done == 0) {
    fmt::print(stderr, "{}light in and between grains: {:.0f} %{}", terminal_ ? "\r\033[K" : "", 100.0 * *preparing,
               terminal_ ? "" : "\n");
    std::fflush(stderr);
    return;
  }
  const std::string of = samples ? fmt::format(" of {}", *samples) : "";
  const std::string left =
      samples_done == 0 || !samples
          ? ""
          : ", " + duration(seconds() / samples_done * std::max(0, *samples - samples_done)) + " left";
  fmt::print(stderr, "{}{}{} samples{}{}", terminal_ ? "\r\033[K" : "", samples_done, of, left, terminal_ ? "" : "\n");
  std::fflush(stderr);
}

void Progress::finish() {
  if (terminal_) fmt::print(stderr, "\r\033[K");
}

}  // namespace mesograin::tool
