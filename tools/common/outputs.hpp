// Whether results can be written, asked before the work that makes them: a run of hours must not
// end with a folder that cannot be made. Makes and removes a file or folder of its own for the
// answer, and leaves nothing. One thread.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "engine/core/result.hpp"

namespace neritic::tools {

// A folder for results, which make_folder() makes with its parents. An empty path: none is asked
// for. kIo, with the flag and the reason, where it cannot be made or nothing can be written in it.
Status check_output_folder(std::string_view flag, const std::filesystem::path& folder);

// A file, which write_file() writes: its folder must be there. Devices and pipes are written to as
// they stand.
Status check_output_file(std::string_view flag, const std::filesystem::path& file);

// A file that a flag asks for. An empty path: none is asked for.
struct OutputFile {
  std::string_view flag;
  std::filesystem::path file;
};
// kBadInput if two flags name one file: the last that is written would replace the others. Devices
// and pipes may be named twice.
Status check_outputs_differ(std::span<const OutputFile> files);

}  // namespace neritic::tools
