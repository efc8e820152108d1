// Any bytes as a saved state, and a valid one with any bytes written into it, its hash put right or
// not: an Error in one line, or a state that fits the format, is finite and is written as it was
// read.
#include <algorithm>
#include <cstring>

#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"
#include "testbed/simulation/saved_state.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

using namespace neritic;
using namespace neritic::testbed;

const StateFormat& format() {
  static const StateFormat format{7,
                                  1,
                                  1.0 / 240.0,
                                  PhysicsState::example(),
                                  PhysicsInputs(1, 1, 1, 1, 1, 1, 1),
                                  {"simulation"}};
  return format;
}

void check(std::span<const std::byte> bytes) {
  const auto saved = parse_state(format(), bytes, "fuzz.state");
  if (!saved.ok()) {
    const std::string& message = saved.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.state: ") && message.find('\n') == message.npos, "{}",
                  message);
    return;
  }
  NERITIC_CHECK(sim::all_finite(saved->state) && sim::all_finite(saved->inputs), "step {}",
                saved->step);
  NERITIC_CHECK(std::ranges::equal(encode_state(format(), *saved), bytes), "{} bytes",
                bytes.size());
}

}  // namespace

// The first 4 bytes: where the rest goes; the lowest bit: whether the hash at the end is put right.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check(fuzz::as_bytes(data, size));
  if (size < 4) return 0;
  std::vector<std::byte> bytes =
      encode_state(format(), {3, format().state, format().inputs, {"simulation", "keyboard"}});
  std::uint32_t place = 0;
  std::memcpy(&place, data, 4);
  const std::size_t at = (place >> 1) % bytes.size();
  const std::size_t count = std::min(size - 4, bytes.size() - at);
  if (count > 0) std::memcpy(bytes.data() + at, data + 4, count);
  if ((place & 1) != 0) {
    Hash64 hash;
    hash.add_span(std::span<const std::byte>(bytes).first(bytes.size() - 8));
    const std::uint64_t sum = hash.value();
    std::memcpy(bytes.data() + bytes.size() - 8, &sum, 8);
  }
  check(bytes);
  return 0;
}
