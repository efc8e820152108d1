// A file that is written while a run goes on, so that the memory stays bounded and a killed run
// keeps what it had written. It grows under its name with ".part" and takes its name when it is
// whole: a half-written file never carries its final name. A run that is killed, fails or fills the
// disk leaves the .part, which ends with a whole piece (an append or a line); the next file of the
// same name replaces it. A device or a pipe is written to as it stands. One thread.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/result.hpp"

namespace neritic {

class GrowingFile {
 public:
  // A chunk is written when it has this size, or at the first append a second after the last one.
  static constexpr std::size_t kChunk_bytes = 1 << 16;
  static constexpr TimeNs kChunk_ns = 1'000'000'000;

  // Opens nothing: the first chunk does.
  explicit GrowingFile(std::filesystem::path path) : path_(std::move(path)) {}
  // Before the first append: makes the .part at once, and keeps other programs from writing a file
  // of this name (being_written()). An Error if one does so already.
  Status claim();

  // One piece each. After an Error all further calls return it.
  Status append(std::string_view text);
  Status append(std::span<const std::byte> bytes);
  // Each line is a piece.
  Status append_lines(std::string_view text);
  // Writes what was appended, at once.
  Status flush() { return write_chunk(); }
  // Writes what is left and gives the file its name. Also a file of nothing.
  Status finish();
  const std::filesystem::path& path() const { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;
  Status add();
  Status write_chunk();
  Result<File> open();
  Error not_whole();
  std::filesystem::path path_, target_;  // target_: behind links; empty before the first chunk
  bool in_place_ = false;
  File claim_;  // locked; nothing is written through it
  File held_;   // of what is written to as it stands; plain files are opened for each chunk
  std::string chunk_;
  std::vector<std::size_t> ends_;  // of the pieces in the chunk
  Status status_;
  std::uintmax_t whole_bytes_ = 0;  // of the chunks that are written
  TimeNs written_ns_ = 0;
};

// The name that a file grows under.
std::filesystem::path part_of(const std::filesystem::path& path);
// Whether a program writes a file of this name, which it has claimed.
bool being_written(const std::filesystem::path& path);
// Gives files that have this name, whole or in part, another one: NAME_old1. Where that fails, or
// the part is being written, writing says why.
void keep_old(const std::filesystem::path& path);

}  // namespace neritic
