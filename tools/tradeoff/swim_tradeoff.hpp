// `neritic tradeoff swim`: how far a swimming diver strays from the finest model, and what it
// costs, over strips a segment, steps from 1 to 50 ms, and the planar model against the full one.
// One thread.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "diver/human_step.hpp"

namespace neritic::tools {

struct SwimTradeoffOptions {
  bool quick = false;                  // a shorter swim, timed once: to see that it works
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const SwimTradeoffOptions& options);

// "straight" keeps to the body's plane, as far as beating legs do; "turning" also bends the spine
// to the sides.
struct SwimPoint {
  std::string swim;
  diver::Model model = diver::Model::kFull;
  int strips = 0;
  double step_s = 0.0;
  // Largest distance from the truth, and of the way at the end, over the swim.
  double error_m = 0.0, way_error = 0.0;
  double us_a_second = 0.0;  // of one core, a second of the swim
};

struct SwimTradeoff {
  double swim_s = 0.0;
  double way_m = 0.0;              // of the truth, straight
  double reference_error_m = 0.0;  // between two truths
  std::vector<SwimPoint> points;
};
SwimTradeoff run_swim_tradeoff(const SwimTradeoffOptions& options);

// What is used where nothing is said (240 Hz and BodyParameters).
bool is_default(const SwimPoint& point);
// The knee of the front of the full model (no other is both cheaper and better), both axes
// logarithmic.
const SwimPoint* knee(const SwimTradeoff& tradeoff, const std::string& swim);

// swim.csv, swim.md, swim.json, swim.png in the folder.
Status write_swim_tradeoff(const std::filesystem::path& folder, const SwimTradeoff& tradeoff);

}  // namespace neritic::tools
