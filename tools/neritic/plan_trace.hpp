// A dive as a dive computer sees it, sample by sample: of a plan, or of a log of depths.
#pragma once

#include <string>
#include <vector>

#include "diver/deco_live.hpp"
#include "diver/depth_log.hpp"
#include "diver/dive_plan.hpp"

namespace neritic::tools {

struct TraceRow {
  double run_min = 0.0, depth_m = 0.0, cns_percent = 0.0, otu = 0.0;
  std::size_t gas = 0;
  diver::DiveComputerView view;
  bool failed = false;  // the log's sample: the depth is between its neighbours'
};

// A moment of which the report shows the tissues.
struct TraceMoment {
  std::string name;
  double run_min = 0.0, depth_m = 0.0;
  diver::TissueState tissues;
};

struct DiveTrace {
  std::vector<TraceRow> rows;
  std::vector<TraceMoment> moments;
  diver::DiveComputerState end;
  double above_ceiling_min = 0.0;  // of samples that violate their ceiling
  double most_ceiling_m = 0.0, fast_min = 0.0;
};

// Between rows of a plan; its segments are straight lines, so that tissues are exact at any.
inline constexpr double kTraceRow_s = 10.0;

// Rows every kTraceRow_s and where the plan changes.
DiveTrace trace_plan(const diver::DivePlanRequest& request, const diver::DivePlan& plan);
// Every sample is stepped; views are at most 20 000, evenly spread.
DiveTrace trace_log(const diver::DiveComputer& computer, const diver::DiveComputerState& start,
                    const diver::DepthLog& log);

std::string trace_csv(const DiveTrace& trace, const std::vector<diver::PlanGas>& gases);

}  // namespace neritic::tools
