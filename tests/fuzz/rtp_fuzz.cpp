// Any bytes as RTP: an Error in one line, or samples from -1 to 1 that are written as they were
// read.
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/net/rtp.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  using namespace neritic::net;
  const auto packet = decode_rtp(fuzz::as_bytes(data, size));
  if (!packet.ok()) {
    const std::string& message = packet.error().message;
    NERITIC_CHECK(message.starts_with("RTP: ") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  NERITIC_CHECK(!packet->samples.empty() && 2 * packet->samples.size() <= size, "{} samples",
                packet->samples.size());
  for (const float sample : packet->samples)
    NERITIC_CHECK(sample >= -1.0F && sample < 1.0F, "{}", sample);
  const auto again = decode_rtp(encode_rtp(*packet));
  NERITIC_CHECK(again.ok() && again->samples == packet->samples, "{} samples",
                packet->samples.size());
  return 0;
}
