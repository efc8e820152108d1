#include "engine/core/files.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <memory>
#include <system_error>

#include "engine/core/refusal.hpp"

namespace neritic {
namespace fs = std::filesystem;
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

constexpr const char* kReadable = "a file that can be read";

template <class Buffer>
Status read_into(const fs::path& path, Buffer& out) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  // Links that lead round in a loop, a folder that may not be entered.
  if (status.type() == fs::file_type::none)
    return refusal(path.string(), error.message(), kReadable);
  if (!fs::exists(status)) return refusal(path.string(), "no such file", kReadable);
  if (!fs::is_regular_file(status)) return refusal(path.string(), "no plain file", kReadable);
  const auto size = fs::file_size(path, error);
  if (error) return refusal(path.string(), error.message(), kReadable);
  if (size > kMaxFileBytes)
    return refusal(path.string(), fmt::format("{} bytes", size),
                   fmt::format("at most {}", kMaxFileBytes));
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) return refusal(path.string(), "a file that may not be opened", kReadable);
  out.resize(size);
  if (size > 0 && std::fread(out.data(), 1, size, file.get()) != size)
    return refusal(path.string(), "an end before its size", kReadable);
  return {};
}

Result<fs::path> behind_links(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as Linux
  std::error_code error;
  fs::path name = path;
  for (int i = 0; fs::is_symlink(fs::symlink_status(name, error)); ++i) {
    const fs::path next = fs::read_symlink(name, error);
    if (error || i == kMostLinks)
      return failure(ErrorCode::kIo, "{}: cannot be written: {}", path.string(),
                     error ? error.message() : std::string("a loop of links"));
    name = name.parent_path() / next;
  }
  return name;
}

}  // namespace

Result<std::vector<std::byte>> read_file(const fs::path& path) {
  std::vector<std::byte> bytes;
  NERITIC_TRY_STATUS(read_into(path, bytes));
  return bytes;
}

Result<std::string> read_text(const fs::path& path) {
  std::string text;
  NERITIC_TRY_STATUS(read_into(path, text));
  return text;
}

Result<WriteTarget> write_target(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  // A device or a pipe is written to: a rename would put a plain file in its place.
  if (fs::exists(status) && !fs::is_regular_file(status)) return WriteTarget{path, true};
  NERITIC_TRY(fs::path target, behind_links(path));
  return WriteTarget{std::move(target), false};
}

Status write_file(const fs::path& path, std::span<const std::byte> bytes) {
  NERITIC_TRY(const auto where, write_target(path));
  const auto& [target, in_place] = where;
  std::error_code error;
  static std::atomic<unsigned> counter{0};  // two threads may write the same name at once
  fs::path name = target;
  if (!in_place) name += fmt::format(".{}-{}.tmp", ::getpid(), counter++);
  File file(std::fopen(name.c_str(), "wb"));
  if (!file) return failure(ErrorCode::kIo, "{}: cannot be written", path.string());
  const bool written =
      bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  const bool closed = std::fclose(file.release()) == 0;
  if (written && closed && !in_place) fs::rename(name, target, error);
  if (!written || !closed || error) {
    std::error_code ignored;
    if (!in_place) fs::remove(name, ignored);
    return failure(ErrorCode::kIo, "{}: cannot be written{}", path.string(),
                   error ? ": " + error.message() : std::string(" whole (disk full?)"));
  }
  return {};
}

Status write_text(const fs::path& path, std::string_view text) {
  return write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

Status remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error)
    return failure(ErrorCode::kIo, "{}: cannot be removed: {}", path.string(), error.message());
  return {};
}

Status make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  std::error_code not_there;
  if (error || !fs::is_directory(path, not_there))
    return failure(ErrorCode::kIo, "{}: the folder cannot be made{}", path.string(),
                   error ? ": " + error.message() : std::string());
  return {};
}

}  // namespace neritic
