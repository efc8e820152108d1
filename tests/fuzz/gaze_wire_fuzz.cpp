// Any bytes as a packet of an eye tracker: an Error in one line, or a sample that is written as it
// was read and whose direction has a length.
#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/net/gaze_wire.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  using namespace neritic::net;
  const Bytes bytes = fuzz::as_bytes(data, size);
  const auto packet = decode_gaze(bytes);
  if (!packet.ok()) {
    const std::string& message = packet.error().message;
    NERITIC_CHECK(message.starts_with("gaze: ") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  NERITIC_CHECK(std::ranges::equal(encode_gaze(*packet), bytes), "{} bytes", size);
  const float length = glm::length(packet->direction);
  NERITIC_CHECK(!packet->valid || (std::isfinite(length) && length > 0.0F), "{}", length);
  return 0;
}
