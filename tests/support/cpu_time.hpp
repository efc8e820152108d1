// Processor time of what a test repeats, until it is quick enough or the trying has taken long:
// what else a machine does slows it, too.
#pragma once

#include <algorithm>
#include <ctime>

namespace neritic::test {

// The least milliseconds of all threads that one call takes: of five calls, then of as many as it
// takes to be under `enough_ms` until ten seconds are spent.
template <class Run>
double least_cpu_ms(double enough_ms, const Run& run) {
  double least_ms = 1e9, all_ms = 0.0;
  for (int i = 0; i < 5 || (least_ms >= enough_ms && all_ms < 1e4); ++i) {
    const std::clock_t begin = std::clock();
    run();
    const double ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    least_ms = std::min(least_ms, ms);
    all_ms += ms;
  }
  return least_ms;
}

}  // namespace neritic::test
