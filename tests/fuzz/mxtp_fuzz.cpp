// Any bytes as datagrams of a motion suit: an Error in one line, or finite items of which poses are
// written as they were read; and frames of whole segments out of them.
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/net/mxtp_frames.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  using namespace neritic::net;
  Bytes bytes = fuzz::as_bytes(data, size);
  static SuitFrames frames;
  static LinkCounts counts;
  static TimeNs now_ns = 0;
  now_ns += 4'000'000;
  const auto datagram = decode_mxtp(bytes);
  if (!datagram.ok()) {
    const std::string& message = datagram.error().message;
    NERITIC_CHECK(message.starts_with("MXTP: ") && message.find('\n') == message.npos, "{}",
                  message);
  } else {
    if (const auto* poses = std::get_if<std::vector<MxtpPose>>(&datagram->items)) {
      for (const MxtpPose& pose : *poses)
        NERITIC_CHECK(pose.id > 0 && std::isfinite(pose.position_m[0] + pose.rotation[0]), "{}",
                      pose.id);
      const auto again = decode_mxtp(encode_mxtp(datagram->header, *poses));
      NERITIC_CHECK(again.ok() && again->refused_items == 0, "{} poses", poses->size());
    }
    if (const SuitFrame* frame = frames.take(*datagram, now_ns, counts))
      for (std::size_t i = 0; i < frame->body.size(); ++i)
        NERITIC_CHECK(frame->body[i].id == i + 1, "segment {}", frame->body[i].id);
  }
  // As a stream.
  const auto length = mxtp_length(bytes);
  NERITIC_CHECK(!length.ok() || *length == 0 || *length >= kMxtpHeader, "{} bytes", *length);
  return 0;
}
