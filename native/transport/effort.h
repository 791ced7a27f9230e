// Work in numbered pieces on all cores, that can be watched and stopped.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace mesograin::transport {

struct Effort {
  std::uint64_t seed = 1;
  unsigned threads = 0;                       ///< 0: as many as the machine has; no result depends on it
  const std::atomic<bool>* stop = nullptr;    ///< another thread may set it: what runs ends with Stopped
  std::function<void(double)> progress = {};  ///< called now and then, from any one thread, with the share that is done
};

/// For a part of some work: its progress is that from `first` to `last` of the whole.
Effort part_of(const Effort& effort, double first, double last);

/// Thrown where `Effort::stop` was set.
struct Stopped {};

/// Calls work(0) to work(pieces - 1), in any order and side by side; what it throws first is thrown on.
void run_pieces(const Effort& effort, std::size_t pieces, const std::function<void(std::size_t)>& work);

}  // namespace mesograin::transport
