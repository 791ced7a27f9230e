// Hands numbered pieces of work to threads as they come free.
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace mesograin::referee {

/// Calls work(0) to work(count - 1), in any order; `threads` 0 is as many as the machine has.
template <class Work>
void parallel(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t piece = next++; piece < count; piece = next++) work(piece);
  };
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> helpers;
  for (unsigned helper = 1; helper < threads; ++helper) helpers.emplace_back(run);
  run();
}

}  // namespace mesograin::referee
