// Work on many items at once, on all cores, for what a frame waits for. Any thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace neritic {

// Ranges of at least `least` items (above 0), at most one a core and at least one.
inline std::size_t ranges_of(std::size_t count, std::size_t least) {
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(count / least, 1, cores);
}

// Calls work(range, begin, end) for each of so many ranges (above 0) that make up [0, count), in
// their order; returns when all are done. The last runs on the calling thread, the others on
// threads of their own, so one range costs no thread. work must not throw.
template <class Work>
void in_ranges(std::size_t count, std::size_t ranges, const Work& work) {
  std::vector<std::thread> helpers;
  for (std::size_t i = 0; i + 1 < ranges; ++i)
    helpers.emplace_back(
        [&work, count, ranges, i] { work(i, count * i / ranges, count * (i + 1) / ranges); });
  work(ranges - 1, count * (ranges - 1) / ranges, count);
  for (std::thread& helper : helpers) helper.join();
}

}  // namespace neritic
