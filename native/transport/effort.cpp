// Hands pieces to threads as they come free.
#include "transport/effort.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace mesograin::transport {

Effort part_of(const Effort& effort, double first, double last) {
  Effort part = effort;
  if (effort.progress)
    part.progress = [progress = effort.progress, first, last](double share) {
      progress(first + (last - first) * share);
    };
  return part;
}

void run_pieces(const Effort& effort, std::size_t pieces, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::mutex mutex;  // of `done`, `failure` and calls of `progress`
  std::size_t done = 0;
  std::exception_ptr failure;
  const auto run = [&] {
    try {
      for (std::size_t piece = next++; piece < pieces && !failed; piece = next++) {
        if (effort.stop != nullptr && *effort.stop) throw Stopped{};
        work(piece);
        const std::lock_guard lock(mutex);
        ++done;
        if (effort.progress) effort.progress(static_cast<double>(done) / static_cast<double>(pieces));
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      failed = true;
    }
  };
  {
    const unsigned threads = effort.threads > 0 ? effort.threads : std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> helpers;
    for (unsigned i = 1; i < std::min<std::size_t>(threads, pieces); ++i) helpers.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace mesograin::transport
