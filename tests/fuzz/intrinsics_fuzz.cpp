// Any bytes as a JSON or YAML file of a camera: an Error in one line, or finite numbers.
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "sonar/offline_input.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

// Its file, removed at the end.
struct ScratchFolder {
  explicit ScratchFolder(const char* ending)
      : path(std::filesystem::temp_directory_path() /
             fmt::format("neritic_fuzz_{}{}", ::getpid(), ending)) {}
  std::filesystem::path path;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

using namespace neritic;

template <class T>
bool is_value(const Result<T>& read, const std::string& path) {
  if (read.ok()) return true;
  const std::string& message = read.error().message;
  NERITIC_CHECK(message.starts_with(path) && message.find('\n') == message.npos, "{}", message);
  return false;
}

void try_file(const ScratchFolder& scratch, std::span<const std::byte> bytes) {
  const Status written = write_file(scratch.path, bytes);
  NERITIC_CHECK(written.ok(), "{}", written.error().message);
  sonar::MapFile depth;
  depth.path = "images/frame_7_depth.png";
  depth.width = 640;
  depth.height = 480;
  const auto k = sonar::read_intrinsics(scratch.path, depth);
  if (is_value(k, scratch.path.string()))
    for (const double value : {k->fx, k->fy, k->cx, k->cy})
      NERITIC_CHECK(std::isfinite(value), "{}", value);
  const auto rotation = sonar::read_camera_rotation(scratch.path, depth);
  if (is_value(rotation, scratch.path.string()))
    NERITIC_CHECK(std::isfinite(glm::determinant(*rotation)), "{}", glm::determinant(*rotation));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder json(".json"), yaml(".yaml");
  try_file(json, fuzz::as_bytes(data, size));
  try_file(yaml, fuzz::as_bytes(data, size));
  return 0;
}
