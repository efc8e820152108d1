#include "tools/common/outputs.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "engine/core/growing_file.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::tools {
namespace fs = std::filesystem;
namespace {

Status refused(std::string_view flag, const fs::path& path, const std::string& reason) {
  return failure(ErrorCode::kIo, "{}: {} ({}): cannot be written", flag, path.string(), reason);
}

// Empty: something can be made in the folder. Permissions alone do not tell: file systems may be
// read-only or full.
std::string why_not_in(const fs::path& folder) {
  std::string name = (folder / ".neritic-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) return std::generic_category().message(errno);
  ::rmdir(name.c_str());
  return {};
}

bool keeps_one_result(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  return !fs::exists(status) || fs::is_regular_file(status);
}

// By their names where they are yet to be made.
bool same_file(const fs::path& one, const fs::path& other) {
  std::error_code error;
  if (fs::equivalent(one, other, error) && !error) return true;
  return fs::weakly_canonical(fs::absolute(one, error), error) ==
         fs::weakly_canonical(fs::absolute(other, error), error);
}

}  // namespace

Status check_output_folder(std::string_view flag, const fs::path& folder) {
  if (folder.empty()) return {};
  std::error_code error;
  fs::path there = fs::absolute(folder, error).lexically_normal();
  while (!error && fs::symlink_status(there, error).type() == fs::file_type::not_found &&
         there.has_relative_path()) {
    error.clear();
    there = there.parent_path();
  }
  if (error) return refused(flag, folder, error.message());
  if (!fs::is_directory(there, error))
    return refused(flag, folder, there.string() + " is no folder");
  if (const std::string reason = why_not_in(there); !reason.empty())
    return refused(flag, folder, reason);
  return {};
}

Status check_output_file(std::string_view flag, const fs::path& file) {
  if (file.empty()) return {};
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (fs::is_directory(status)) return refused(flag, file, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) return {};
  // A link is followed: the file that it names is replaced.
  error.clear();
  const fs::path behind = fs::is_symlink(fs::symlink_status(file, error))
                              ? fs::weakly_canonical(file, error)
                              : fs::absolute(file, error);
  if (error) return refused(flag, file, error.message());
  if (!fs::is_directory(behind.parent_path(), error))
    return refused(flag, file, "no folder " + behind.parent_path().string());
  if (const std::string reason = why_not_in(behind.parent_path()); !reason.empty())
    return refused(flag, file, reason);
  if (being_written(file)) return refused(flag, file, "another program writes it");
  return {};
}

Status check_outputs_differ(std::span<const OutputFile> files) {
  for (std::size_t i = 0; i < files.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const OutputFile &one = files[j], &other = files[i];
      if (one.file.empty() || other.file.empty() || !keeps_one_result(one.file)) continue;
      if (same_file(one.file, other.file))
        return refusal(fmt::format("{}, {}", one.flag, other.flag),
                       fmt::format("one file, {}", other.file.string()), "a file for each flag");
    }
  return {};
}

}  // namespace neritic::tools
