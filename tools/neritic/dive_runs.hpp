// `neritic dive --headless --runs N`: the same dive with N seeds, and a table of outcomes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/scene/scene.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/interrupt.hpp"

namespace neritic::tools {

// Steps until so long has passed: at least one, since 0 stands for no end.
inline std::uint64_t steps_in(double seconds, double step_s) {
  return static_cast<std::uint64_t>(std::max(1.0, std::ceil(seconds / step_s - 1e-9)));
}

// Runs of the scene with the seeds from its own on, each until its missions are done or the seconds
// are over. kBadInput if no vehicle has a mission with an end; another Error (exit status 1) if a
// mission was not done, or in the vehicle's belief alone (mission_outcomes.hpp). Precondition:
// PhysicsWorld::needed.
Status dive_runs(const DiveFlags& flags, const scene::Scene& scene, double seconds,
                 const Interrupt& interrupt);

}  // namespace neritic::tools
