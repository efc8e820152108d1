// Any bytes as a .csv of copies: an Error in one line, or finite transforms of no more copies than
// there are labels.
#include <cmath>
#include <string_view>

#include "engine/core/check.hpp"
#include "engine/scene/scene_copies.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto copies = scene::parse_copies({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  if (!copies.ok()) {
    const std::string& message = copies.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.csv") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  NERITIC_CHECK(copies->size() <= scene::kMaxInstances, "{} copies", copies->size());
  for (const Mat4& copy : *copies)
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        NERITIC_CHECK(std::isfinite(copy[column][row]), "column {}, row {}", column, row);
  return 0;
}
