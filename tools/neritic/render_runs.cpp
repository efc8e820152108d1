#include "tools/neritic/render_runs.hpp"

#include <limits>

#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::tools {

Result<std::string> render_runs(const RenderFlags& flags, const RenderOnce& once) {
  if (!flags.replay.empty() || !flags.files.log.empty() || !flags.dump_graph.empty())
    return refusal("--runs", "a flag of one run beside it", "no --replay, --log, --dump-graph");
  std::vector<MissionOutcome> outcomes;
  std::uint64_t first_seed = flags.seed.value_or(0);
  for (std::uint32_t i = 0; i < flags.runs; ++i) {
    RenderFlags run = flags;
    run.out = (std::filesystem::path(flags.out) / fmt::format("run_{:04}", i)).string();
    if (i > 0) run.seed = first_seed + i;
    RenderedRun told;
    NERITIC_TRY(const std::string summary, once(run, told));
    if (i == 0) first_seed = told.seed;
    if (i == 0 && first_seed > std::numeric_limits<std::uint64_t>::max() - flags.runs)
      return refusal("--seed", fmt::format("{}", first_seed),
                     "one with room for all runs after it");
    log_info("seed {}: {}", told.seed, summary);
    outcomes.insert(outcomes.end(), told.outcomes.begin(), told.outcomes.end());
  }
  if (!outcomes.empty()) print_outcomes(outcomes, false);
  return fmt::format("{}: run_0000 to {:04}, with the seeds {} to {}", flags.out, flags.runs - 1,
                     first_seed, first_seed + flags.runs - 1);
}

}  // namespace neritic::tools
