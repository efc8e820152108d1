// `neritic tradeoff sonar`: the plain cosine over G-buffer resolution, bins, normal precision and
// gather, cell by cell; then, in a scene, each kind of sonar with its point spread over every knob
// and every term. Rendering thread.
#pragma once

#include <filesystem>
#include <functional>

#include "tools/tradeoff/kind_sweep.hpp"
#include "tools/tradeoff/measure.hpp"

namespace neritic::tools {

struct SonarTradeoffOptions {
  std::filesystem::path scene;  // empty: only the analytic scene, and no kinds
  std::string device;
  std::string kind;                    // only this one; empty: all, and the plain cosine
  bool quick = false;                  // fewer rays, bins and points: to see that it works
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const SonarTradeoffOptions& options);

struct SonarTradeoff {
  std::string device;
  std::uint32_t rays_a_cell = 0;
  std::vector<Point> points;
  std::vector<KindResult> kinds;
  std::string kinds_scene;  // its name
};
Result<SonarTradeoff> run_sonar_tradeoff(const SonarTradeoffOptions& options);

// tradeoff.csv, tradeoff.png, tradeoff.json of the plain cosine; KIND.csv, KIND_terms.csv, KIND.png
// of each kind, quality.json and tradeoff.md in the folder.
Status write_kinds(const std::filesystem::path& folder, const SonarTradeoff& tradeoff);
Status write_sonar_tradeoff(const std::filesystem::path& folder, const SonarTradeoff& tradeoff);

}  // namespace neritic::tools
