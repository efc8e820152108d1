// `neritic tradeoff sonar`: the sweeps over G-buffer resolution, bins, normal precision and gather,
// and their report. Rendering thread.
#pragma once

#include <filesystem>
#include <functional>

#include "tools/tradeoff/measure.hpp"

namespace neritic::tools {

struct SonarTradeoffOptions {
  std::filesystem::path scene;  // empty: only the analytic scene
  std::string device;
  bool quick = false;                  // fewer rays, bins and points: to see that it works
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const SonarTradeoffOptions& options);

struct SonarTradeoff {
  std::string device;
  std::uint32_t rays_a_cell = 0;
  std::vector<Point> points;
};
Result<SonarTradeoff> run_sonar_tradeoff(const SonarTradeoffOptions& options);

// tradeoff.csv, tradeoff.png, tradeoff.json in the folder.
Status write_sonar_tradeoff(const std::filesystem::path& folder, const SonarTradeoff& tradeoff);

}  // namespace neritic::tools
