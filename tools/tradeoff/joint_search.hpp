// The cheapest setting of all knobs together within each bound of error: a descent over their
// ladders, from finest to coarsest. Knows knobs and errors only, no device; one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tools/tradeoff/kind_sweep.hpp"

namespace neritic::tools {

// The values that each knob can have, coarse to fine.
struct Ladders {
  std::vector<std::uint32_t> bins;  // of range
  std::vector<double> scales;       // pixels a cell
  std::vector<std::uint32_t> columns, rows;
};

// Error and cost of a setting; repeats: how often it is timed.
using MeasureKnobs = std::function<Result<KindPoint>(const Knobs& knobs, int repeats)>;

// Every setting that was looked at, the cheapest within each of kErrorLevels timed as often as
// repeats says.
Result<std::vector<KindPoint>> search_joint(const Ladders& ladders, const MeasureKnobs& measure,
                                            int repeats);

}  // namespace neritic::tools
