// Any bytes as an .asc heightfield: an Error in one line, or a grid filled with heights in bounds.
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

// Its file, removed at the end.
struct Scratch {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("neritic_fuzz_{}.asc", ::getpid());
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
  const auto field = scene::read_heightfield(scratch.path, {});
  if (!field.ok()) {
    const std::string& message = field.error().message;
    NERITIC_CHECK(message.starts_with(scratch.path.string()) && message.find('\n') == message.npos,
                  "{}", message);
    return 0;
  }
  NERITIC_CHECK(field->columns > 0 && field->rows > 0 &&
                    field->heights_m.size() == std::size_t{field->columns} * field->rows,
                "{} heights for {} x {}", field->heights_m.size(), field->columns, field->rows);
  NERITIC_CHECK(field->cell_m > 0.0 && std::isfinite(field->cell_m), "cells of {} m",
                field->cell_m);
  for (const float height : field->heights_m)
    NERITIC_CHECK(std::isnan(height) || std::abs(height) <= scene::kMaxHeight_m, "{} m", height);
  return 0;
}
