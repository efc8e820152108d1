// The timeline of a run's frames as a picture.
#pragma once

#include <filesystem>

#include "engine/core/result.hpp"
#include "testbed/view/frame_timeline.hpp"

namespace neritic::tools {

// Writes F.plot.json beside F.png and draws it. budget_ms: of a frame; 0: none. kIo.
Status write_timeline(const std::filesystem::path& picture, const std::string& title,
                      double budget_ms, const testbed::FrameTimeline& timeline);

}  // namespace neritic::tools
