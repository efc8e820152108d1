// `neritic recording export`: the messages of a recording in the forms that other programs read.
#pragma once

#include <filesystem>

#include "tools/neritic/commands.hpp"

namespace neritic::tools {

Result<std::string> export_recording(const RecordingFlags& flags);
// All numbers of a recording as one .xdf, also of one that was cut off.
Status write_xdf(const std::filesystem::path& mcap, const std::filesystem::path& xdf);

}  // namespace neritic::tools
