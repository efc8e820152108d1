// `neritic tradeoff tether`: how far off a cable of segments is (rov/cable.hpp), and what it costs,
// by its number of segments and its rate: hanging, against the catenary; in a current, against its
// equilibrium integrated along the line; swinging, against Bernoulli's chain. One thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::tools {

struct TetherPoint {
  std::string rig;  // hangs, current, swings
  std::uint32_t segments = 0;
  double rate_hz = 0.0;
  // Hangs, current: the farthest node from its true place over 50 m, and of the pull at the end.
  // Swings: of the period; and 0.
  double error_m = 0.0, error_percent = 0.0;
  double us_a_second = 0.0;  // of one core, a second simulated
};

std::vector<TetherPoint> run_tether_tradeoff(bool quick);
// Writes tether.csv, .md and .plot.json into the folder. True: tether.png was drawn too.
Result<bool> write_tether_tradeoff(const std::filesystem::path& folder,
                                   const std::vector<TetherPoint>& points);

}  // namespace neritic::tools
