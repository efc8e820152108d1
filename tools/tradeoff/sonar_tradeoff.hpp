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
  std::function<void(const std::string&)> now = [](const std::string&) {};  // what comes next
  // After the plain cosine ("plain") and each kind, with all that is measured until then.
  std::function<Status(const std::string& part, const struct SonarTradeoff& so_far)> part_done =
      [](const std::string&, const struct SonarTradeoff&) { return Status(); };
};
std::uint64_t steps(const SonarTradeoffOptions& options);

struct SonarTradeoff {
  bool quick = false;  // too coarse to tell levels by
  std::string device;
  std::uint32_t rays_a_cell = 0;
  std::vector<Point> points;
  std::vector<KindResult> kinds;
  std::string kinds_scene;  // its name
};
Result<SonarTradeoff> run_sonar_tradeoff(const SonarTradeoffOptions& options);

// In the folder: tradeoff.csv, .json, .plot.json and plain.md of the plain cosine. Each of these
// two gives whether the picture, .png, could be drawn too.
Result<bool> write_plain(const std::filesystem::path& folder, const SonarTradeoff& tradeoff);
// KIND.csv, KIND_terms.csv, KIND.plot.json of the last of the kinds; tradeoff.md and quality.json
// of all.
Result<bool> write_last_kind(const std::filesystem::path& folder, const SonarTradeoff& tradeoff);

}  // namespace neritic::tools
