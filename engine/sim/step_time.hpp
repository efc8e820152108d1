// When a step happens: its number, counted from time 0, and its length. The one counter of a run.
#pragma once

#include <cstdint>

namespace neritic::sim {

struct StepTime {
  std::uint64_t step = 0;  // steps taken before this one
  double step_s = 0.0;
  double time_s() const { return static_cast<double>(step) * step_s; }  // where the step begins
};

}  // namespace neritic::sim
