// Whole files in and out. Output goes to a temporary name in the same folder and is renamed when
// whole: a half-written file never carries its final name. Symbolic links are followed; what is no
// plain file (a device, a pipe) is written to as it stands. Any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic {

// Largest file read_file accepts, in bytes (2 GiB): bad input must not exhaust the memory.
inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 31;

// kBadInput where the file is missing, not a plain file, unreadable or too large.
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path);
Result<std::string> read_text(const std::filesystem::path& path);

// kIo where it can't be written; then nothing is left behind under either name.
Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
Status write_text(const std::filesystem::path& path, std::string_view text);

// Where a file of that name is written: the name that symbolic links lead to, whether or not there
// is a file yet (a rename must replace that one, not the link). in_place: it is no plain file. kIo
// for a loop of links.
struct WriteTarget {
  std::filesystem::path path;
  bool in_place = false;
};
Result<WriteTarget> write_target(const std::filesystem::path& path);

// A file that is not there is no fault. kIo where it is and can't be removed.
Status remove_file(const std::filesystem::path& path);

// Makes the folder and its parents. kIo where that fails.
Status make_folder(const std::filesystem::path& path);

}  // namespace neritic
