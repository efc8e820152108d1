// `neritic render --runs N`: the same frames with N seeds, each in a folder of its own, and a table
// of outcomes.
#pragma once

#include <functional>

#include "tools/neritic/commands.hpp"
#include "tools/neritic/mission_outcomes.hpp"

namespace neritic::tools {

struct RenderedRun {
  std::uint64_t seed = 0;
  std::vector<MissionOutcome> outcomes;  // of missions and plans that end
};
using RenderOnce = std::function<Result<std::string>(const RenderFlags& flags, RenderedRun& told)>;

// OUT/run_0000 with --seed (else the scene's own), run_0001 with the next, and so on.
Result<std::string> render_runs(const RenderFlags& flags, const RenderOnce& once);

}  // namespace neritic::tools
