// `neritic tradeoff swim`: how far a swimming diver strays from the finest model, and what it
// costs, over strips a segment, steps from 1 to 50 ms, and the planar model against the full one.
// One thread.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "diver/human_step.hpp"

namespace neritic::tools {

struct SwimTradeoffOptions {
  bool quick = false;             // a shorter swim, timed once: to see that it works
  bool timed = true;              // or errors and counted costs alone
  double swim_s = 20.0;           // of each swim; quick: 2 s
  double truth_step_s = 0.25e-3;  // and twice that, to see what it leaves
  std::vector<int> strips = {1, 2, 3, 4, 5, 6, 8, 16};  // a segment
  std::vector<double> steps_ms = {1, 2, 1e3 / 240, 8, 12.5, 20, 25, 50};
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const SwimTradeoffOptions& options);

// The fixed cost of a step in units of one strip's: 10.9 us over 17 ns, measured with 1 to 64
// strips a segment. Costs in strips are the same on any machine.
inline constexpr double kStepInStrips = 600.0;

// "straight" keeps to the body's plane, as far as beating legs do; "turning" also bends the spine
// to the sides; "ascent" sets out 45 degrees up, while suit and jacket expand.
struct SwimPoint {
  std::string swim;
  diver::Model model = diver::Model::kFull;
  int strips = 0;
  double step_s = 0.0;
  // Largest distance from the truth, and of the way at the end, over the swim.
  double error_m = 0.0, way_error = 0.0;
  double strips_a_second = 0.0;  // counted cost: the body's, and kStepInStrips, each step
  double us_a_second = 0.0;      // of one core, a second of the swim; 0: not timed
};

struct SwimTradeoff {
  double swim_s = 0.0;
  double way_m = 0.0;              // of the truth, straight
  double reference_error_m = 0.0;  // between two truths
  std::vector<SwimPoint> points;
};
SwimTradeoff run_swim_tradeoff(const SwimTradeoffOptions& options);

// True for the default settings (240 Hz and BodyParameters).
bool is_default(const SwimPoint& point);
// The largest errors over all swims of each model, strips and step, as a swim called "all".
inline constexpr const char* kAllSwims = "all";
std::vector<SwimPoint> worst_of_all(const SwimTradeoff& tradeoff);
// The default is the cheapest measured setting whose error in any swim is at most this share of the
// straight swim's distance.
inline constexpr double kWithinShare = 0.0025;
// Points of the full model, by counted cost; null where there is none. The knee of the front (no
// other is both cheaper and better), both axes logarithmic; and the cheapest within an error.
const SwimPoint* knee(std::span<const SwimPoint> points, const std::string& swim);
const SwimPoint* cheapest_within(std::span<const SwimPoint> points, const std::string& swim,
                                 double error_m);

// Writes swim.csv, .md, .json and .plot.json into the folder. True: swim.png was drawn too.
Result<bool> write_swim_tradeoff(const std::filesystem::path& folder, const SwimTradeoff& tradeoff);

}  // namespace neritic::tools
