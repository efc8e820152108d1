// The sweeps of `neritic tradeoff sonar` over one kind of sonar: each setting rendered, its passes
// timed and its images held against the rays'. Rendering thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "tools/tradeoff/kinds.hpp"
#include "tools/tradeoff/ray_world.hpp"

namespace neritic::tools {

struct KindPoint {
  std::string
      sweep;  // "gbuffer_scale", "gather", "columns", "rows", "range bins", "beams", "joint"
  std::string setting;  // what was set, in words
  Knobs knobs;
  std::uint32_t bins_range = 0, beams = 0;
  // Sum of absolute differences over the truth's total: of the image with the sensor's point
  // spread, and of the cells without it (-1: not measured).
  double error = 0.0, error_cells = -1.0;
  double energy = 0.0;  // total over the truth's, less 1
  double raster_ms = 0.0, gather_ms = 0.0, receive_ms = 0.0;
  double ms() const { return raster_ms + gather_ms + receive_ms; }
};

struct TermPoint {
  std::string term;
  double ms = 0.0;             // that it adds to a ping
  double resolution_ms = 0.0;  // standard error of that; 0: no difference of two
  double error_with = -1.0, error_without = -1.0;  // -1: nothing to compare
  std::string note;
};

struct KindResult {
  std::string kind;
  scene::Sonar base;
  Knobs middle;
  double uncertain = 0.0;  // error of the rays' own image, from its two halves
  double rays = 0.0;       // of the truth
  std::vector<KindPoint> points;
  std::vector<TermPoint> terms;
};

struct KindSweepOptions {
  bool quick = false;
  std::function<void()> step = [] {};
  // Receives the name of the next step, to show progress: some steps take a minute.
  std::function<void(const std::string&)> now = [](const std::string&) {};
};
// How often step is called for a kind.
std::uint64_t kind_steps(scene::SonarKind kind, bool quick);

// world: the scene's triangles about place_of(scene), axes of the scene's.
Result<KindResult> sweep_kind(gpu::Device& device, const scene::Scene& scene, const RayWorld& world,
                              const KindSetting& kind, const KindSweepOptions& options);

// A named quality level: the cheapest settings below this error.
struct ErrorLevel {
  const char* name;
  double max_error;
};
inline constexpr ErrorLevel kErrorLevels[] = {
    {"draft", 0.05}, {"standard", 0.02}, {"reference", 0.01}};

// The cheapest of the joint sweep whose error is at most that; nullptr: none.
const KindPoint* cheapest(const KindResult& result, double max_error);

}  // namespace neritic::tools
