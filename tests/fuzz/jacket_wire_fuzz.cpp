// Any bytes as packets of a jacket's buttons: an Error in one line, or buttons; version 1 is
// written as it was read.
#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/net/jacket_wire.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  using namespace neritic::net;
  const Bytes bytes = fuzz::as_bytes(data, size);
  const auto packet = decode_jacket(bytes);
  if (!packet.ok()) {
    const std::string& message = packet.error().message;
    NERITIC_CHECK(message.starts_with("jacket: ") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  const std::vector<std::byte> again = encode_jacket(*packet);
  NERITIC_CHECK(!packet->counters || std::ranges::equal(again, bytes), "{} bytes", size);
  NERITIC_CHECK(decode_jacket(again).ok() && decode_jacket(again)->pressed == packet->pressed,
                "{} bytes", size);
  return 0;
}
