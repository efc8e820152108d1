// `neritic sonar` on folders: a frame a file, results in OUT/FRAME/, on all cores. Goes on where it
// stopped; frames that cannot be read are listed and left out.
#pragma once

#include "tools/neritic/sonar_job.hpp"

namespace neritic::tools {

// Whether the flags name more than one frame.
bool is_folder_job(const SonarJob& job);

// kBadInput where the folders do not fit, OUT holds frames of other settings, or no frame could be
// read; else the first error that is not one frame's. The text says how many frames and how fast.
Result<std::string> run_folder(const SonarJob& job);

}  // namespace neritic::tools
