// `neritic tradeoff deco`: how far tissues stray when a dive is known by samples, by step sizes
// from 1 to 60 s and by what is done between two samples, against the exact solution of its linear
// depth changes; and what it costs. One thread.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::tools {

struct DecoTradeoffOptions {
  bool quick = false;                  // timed once
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const DecoTradeoffOptions& options);

// The integration of tissue pressures between two samples.
enum class TissueMethod {
  kEuler,      // p += k (P - p) dt, P of the older sample
  kHeld,       // exact for the older sample's pressure
  kMean,       // exact for the mean of both
  kSchreiner,  // exact for a linear change
  kFactors,    // the same with what a fixed step lets be known before
};
const char* name_of(TissueMethod method);

struct DecoPoint {
  std::string dive;
  TissueMethod method = TissueMethod::kSchreiner;
  double step_s = 0.0;
  // The largest over all samples. Not finite: it diverged.
  double error_bar = 0.0, ceiling_error_m = 0.0;
  double us_an_hour = 0.0;  // of one core, an hour of diving
};

struct DecoTradeoff {
  std::vector<std::string> dives;
  std::vector<DecoPoint> points;
};
DecoTradeoff run_deco_tradeoff(const DecoTradeoffOptions& options);

// The largest error and cost over all dives for each method and step.
std::vector<DecoPoint> worst_of(const DecoTradeoff& tradeoff);
// The knee of the front of all methods, over the worst of the dives; both axes as they are.
DecoPoint knee(const DecoTradeoff& tradeoff);

// Writes deco.csv, .md, .json and .plot.json into the folder. True: deco.png was drawn too.
Result<bool> write_deco_tradeoff(const std::filesystem::path& folder, const DecoTradeoff& tradeoff);

}  // namespace neritic::tools
