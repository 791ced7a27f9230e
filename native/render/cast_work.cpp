// Bands small enough to share out evenly.
#include "render/cast_work.h"

#include <algorithm>
#include <atomic>

#include "transport/effort.h"

namespace mesograin::render {
namespace {

constexpr int rows_in_band = 8;

}  // namespace

bool cast_rows(int height, const GoOn& go_on, const std::function<void(int first, int end)>& work) {
  std::atomic<bool> stop{false};
  transport::Effort effort;
  effort.stop = &stop;
  effort.progress = [&](double /*share*/) {
    if (!go_on()) stop = true;
  };
  const int bands = (height + rows_in_band - 1) / rows_in_band;
  try {
    transport::run_pieces(effort, static_cast<std::size_t>(bands), [&](std::size_t band) {
      const int first = static_cast<int>(band) * rows_in_band;
      work(first, std::min(first + rows_in_band, height));
    });
  } catch (const transport::Stopped&) {
    return false;
  }
  return !stop;
}

}  // namespace mesograin::render
