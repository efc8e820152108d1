// Work on many items at once, on all cores, for what a frame waits for. Any thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace neritic {

// Ranges of at least `least` items (above 0), at most one a core and at least one.
inline std::size_t ranges_of(std::size_t count, std::size_t least) {
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(count / least, 1, cores);
}

// Calls work(i) for each i below count, each once and in any order, on at most one thread a core;
// returns when all are done. The calling thread takes part, so one item costs no thread, and does
// all where no thread is to be had. work must not throw.
template <class Work>
void each_on_cores(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto take = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::thread> helpers;
  try {
    for (std::size_t i = ranges_of(count, 1); i > 1; --i) helpers.emplace_back(take);
  } catch (const std::system_error&) {
    // No more threads to be had: those that there are do the work.
  }
  take();
  for (std::thread& helper : helpers) helper.join();
}

// Calls work(range, begin, end) for each of so many ranges (above 0) that make up [0, count), as
// each_on_cores does.
template <class Work>
void in_ranges(std::size_t count, std::size_t ranges, const Work& work) {
  each_on_cores(ranges,
                [&](std::size_t i) { work(i, count * i / ranges, count * (i + 1) / ranges); });
}

}  // namespace neritic
