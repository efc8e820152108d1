// `neritic tradeoff modem`: how far off an acoustic range is by each way of finding a path's travel
// time, and what it costs, from steep paths to grazing ones in summer water. One thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::tools {

struct ModemPoint {
  std::string path;      // constant, straight, bent
  double slope = 0.0;    // of the depths' difference over the horizontal distance
  double error_m = 0.0;  // the largest, of range at 1500 m/s
  double cost_ns = 0.0;  // of one travel time
};

// Truth: Snell's integral over the depth by 200 000 midpoints, its ray parameter by bisection; for
// rays that do not turn. runs: of each cost's timing.
std::vector<ModemPoint> run_modem_tradeoff(int runs);
// Writes modem.csv, .md and .plot.json into the folder. True: modem.png was drawn too.
Result<bool> write_modem_tradeoff(const std::filesystem::path& folder,
                                  const std::vector<ModemPoint>& points);

}  // namespace neritic::tools
