// Work on many things, each alone, on all cores: what comes out does not depend on how many there are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace mesograin::pile {

/// Calls work(first, last) for ranges that are all of 0 to `count` together. `work` must not throw.
template <typename Work>
void in_parallel(std::size_t count, std::size_t least_for_a_thread, const Work& work) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t threads = std::clamp<std::size_t>(count / least_for_a_thread, 1, cores);
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < threads; ++i)
    others.emplace_back([&work, first = count * i / threads, last = count * (i + 1) / threads] { work(first, last); });
  work(0, count / threads);
}

}  // namespace mesograin::pile
