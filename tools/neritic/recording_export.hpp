// `neritic recording export`: the messages of a recording in the forms that other programs read.
#pragma once

#include "tools/neritic/commands.hpp"

namespace neritic::tools {

Result<std::string> export_recording(const RecordingFlags& flags);

}  // namespace neritic::tools
