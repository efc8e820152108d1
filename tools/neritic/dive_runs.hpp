// `neritic dive --headless --runs N`: the same dive with N seeds, and a table of what became of it.
#pragma once

#include "engine/scene/scene.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/interrupt.hpp"

namespace neritic::tools {

// Runs of the scene with the seeds from its own on, each until its missions are done or --seconds
// are over. An Error (exit status 1) where a mission was not done. Precondition: a vehicle of the
// scene has a mission with an end.
Status dive_runs(const DiveFlags& flags, const scene::Scene& scene, const Interrupt& interrupt);

}  // namespace neritic::tools
