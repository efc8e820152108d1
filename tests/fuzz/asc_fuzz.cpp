// Any bytes as an .asc heightfield: an Error in one line, or heights that fill the grid it names.
// Its cells may have no size: then the scene must give one.
#include <cmath>
#include <string_view>

#include "engine/core/check.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto field = scene::parse_asc({reinterpret_cast<const char*>(data), size}, "fuzz.asc");
  if (!field.ok()) {
    const std::string& message = field.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.asc") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  NERITIC_CHECK(field->columns > 0 && field->rows > 0 &&
                    field->heights_m.size() == std::size_t{field->columns} * field->rows,
                "{} heights for {} x {}", field->heights_m.size(), field->columns, field->rows);
  NERITIC_CHECK(field->cell_m >= 0.0 && std::isfinite(field->cell_m), "cells of {} m",
                field->cell_m);
  for (const float height : field->heights_m) NERITIC_CHECK(!std::isinf(height), "infinite height");
  return 0;
}
