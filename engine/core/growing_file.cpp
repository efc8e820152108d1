#include "engine/core/growing_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "engine/core/files.hpp"
#include "engine/core/log.hpp"

namespace neritic {
namespace fs = std::filesystem;

fs::path part_of(const fs::path& path) {
  fs::path part = path;
  part += ".part";
  return part;
}

Status GrowingFile::claim() {
  const auto refused = [&](const std::string& why) {
    return status_ = failure(ErrorCode::kIo, "{}: cannot be written: {}", path_.string(), why);
  };
  const auto target = write_target(path_);
  if (!target.ok()) return status_ = target.error();
  if (target->in_place) return {};
  const fs::path part = part_of(target->path);
  const int fd = ::open(part.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (fd < 0) return refused(std::strerror(errno));
  claim_.reset(::fdopen(fd, "ab"));
  // Some file systems have no locks.
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    return refused("another program writes " + part.string());
  if (::ftruncate(fd, 0) != 0) return refused(std::strerror(errno));
  target_ = target->path;
  return {};
}

Status GrowingFile::append(std::string_view text) {
  chunk_ += text;
  ends_.push_back(chunk_.size());
  return add();
}

Status GrowingFile::append_lines(std::string_view text) {
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1))
    ends_.push_back(chunk_.size() + at + 1);
  chunk_ += text;
  return add();
}

Status GrowingFile::add() {
  if (!status_.ok()) {
    chunk_.clear();
    ends_.clear();
    return status_;
  }
  if (written_ns_ == 0) written_ns_ = now_ns();
  if (chunk_.size() < kChunk_bytes && now_ns() - written_ns_ < kChunk_ns) return {};
  return write_chunk();
}

Status GrowingFile::append(std::span<const std::byte> bytes) {
  return append(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Result<GrowingFile::File> GrowingFile::open() {
  const bool first = target_.empty();
  if (first) {
    NERITIC_TRY(const WriteTarget target, write_target(path_));
    target_ = target.path;
    in_place_ = target.in_place;
  }
  const fs::path name = in_place_ ? target_ : part_of(target_);
  File file(std::fopen(name.c_str(), first ? "wb" : "ab"));
  if (!file) return failure(ErrorCode::kIo, "{}: cannot be written", name.string());
  return file;
}

Status GrowingFile::write_chunk() {
  if (!status_.ok()) return status_;
  File file = std::move(held_);
  if (!file) {
    Result<File> opened = open();
    if (!opened.ok()) return status_ = opened.error();
    file = std::move(*opened);
  }
  const bool written =
      chunk_.empty() || std::fwrite(chunk_.data(), 1, chunk_.size(), file.get()) == chunk_.size();
  const bool flushed = std::fflush(file.get()) == 0;
  if (in_place_) held_ = std::move(file);
  // Closed whatever happened: what the stream still keeps must not follow what is cut off.
  const bool closed = !file || std::fclose(file.release()) == 0;
  if (!written || !flushed || !closed) return status_ = not_whole();
  whole_bytes_ += chunk_.size();
  chunk_.clear();
  ends_.clear();
  written_ns_ = now_ns();
  return {};
}

// Keeps the pieces of the last chunk that are in the file whole.
Error GrowingFile::not_whole() {
  const std::string what = path_.string() + ": cannot be written whole (disk full?)";
  if (in_place_) return Error{ErrorCode::kIo, what};
  std::error_code error;
  const std::uintmax_t size = fs::file_size(part_of(target_), error);
  if (!error && size > whole_bytes_) {
    const auto after = std::ranges::upper_bound(ends_, size - whole_bytes_);
    if (after != ends_.begin()) whole_bytes_ += *(after - 1);
  }
  fs::resize_file(part_of(target_), whole_bytes_, error);
  chunk_ = {};
  ends_ = {};
  return failure(ErrorCode::kIo, "{}; what was written before is in {}", what,
                 part_of(target_).string());
}

Status GrowingFile::finish() {
  NERITIC_TRY_STATUS(write_chunk());
  held_.reset();
  if (in_place_) return {};
  std::error_code error;
  fs::rename(part_of(target_), target_, error);
  if (error)
    return status_ = failure(ErrorCode::kIo, "{}: cannot be written: {}", path_.string(),
                             error.message());
  claim_.reset();
  return {};
}

bool being_written(const fs::path& path) {
  const auto target = write_target(path);
  if (!target.ok() || target->in_place) return false;
  const int fd = ::open(part_of(target->path).c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool locked = ::flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(fd);
  return locked;
}

void keep_old(const fs::path& path) {
  const auto target = write_target(path);
  if (!target.ok() || target->in_place || being_written(path)) return;
  std::error_code none;
  const std::array<fs::path, 2> there{target->path, part_of(target->path)};
  if (std::ranges::none_of(there, [&](const fs::path& file) { return fs::exists(file, none); }))
    return;
  for (int i = 1;; ++i) {
    fs::path old = target->path;
    old.replace_filename(fmt::format("{}_old{}{}", target->path.stem().string(), i,
                                     target->path.extension().string()));
    const std::array<fs::path, 2> names{old, part_of(old)};
    if (std::ranges::any_of(names, [&](const fs::path& file) { return fs::exists(file, none); }))
      continue;
    for (std::size_t k = 0; k < there.size(); ++k) {
      std::error_code error;
      if (!fs::exists(there[k], none)) continue;
      fs::rename(there[k], names[k], error);
      if (!error) log_warn("{} was there; it is {} now", there[k].string(), names[k].string());
    }
    return;
  }
}

}  // namespace neritic
