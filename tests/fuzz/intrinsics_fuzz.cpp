// Any bytes as the JSON file of a pinhole: an Error in one line, or finite numbers.
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "sonar/offline_input.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

// Its file, removed at the end.
struct Scratch {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("neritic_fuzz_{}.json", ::getpid());
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  static const Scratch scratch;
  const Status written = write_file(scratch.path, fuzz::as_bytes(data, size));
  NERITIC_CHECK(written.ok(), "{}", written.error().message);
  sonar::MapFile depth;
  depth.path = "images/frame_7_depth.png";
  depth.width = 640;
  depth.height = 480;
  const auto k = sonar::read_intrinsics(scratch.path, depth);
  if (!k.ok()) {
    const std::string& message = k.error().message;
    NERITIC_CHECK(message.starts_with(scratch.path.string()) && message.find('\n') == message.npos,
                  "{}", message);
    return 0;
  }
  for (const double value : {k->fx, k->fy, k->cx, k->cy})
    NERITIC_CHECK(std::isfinite(value), "{}", value);
  return 0;
}
