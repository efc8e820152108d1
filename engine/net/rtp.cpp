#include "engine/net/rtp.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"

namespace neritic::net {
namespace {

constexpr std::size_t kRtpHeader = 12;
constexpr float kScale = 32768.0F;
constexpr std::uint8_t kFirstAssigned = 96;  // RFC 3551: a session says what 96 to 127 are

}  // namespace

Result<RtpPacket> decode_rtp(Bytes bytes) {
  constexpr std::string_view kWhere = "RTP";
  if (bytes.size() < kRtpHeader)
    return refusal(kWhere, fmt::format("{} bytes", bytes.size()), "12 or more");
  const auto first = std::to_integer<unsigned>(bytes[0]);
  if (first >> 6 != 2) return refusal(kWhere, fmt::format("version {}", first >> 6), "2");
  const auto type = static_cast<std::uint8_t>(std::to_integer<unsigned>(bytes[1]) & 127);
  if (type != kRtpL16 && type < kFirstAssigned) {
    return failure(ErrorCode::kUnsupported,
                   "RTP: found payload type {}; accepted: 11 and 96 to 127, 16 bits in one channel",
                   type);
  }
  std::size_t begin = kRtpHeader + 4 * (first & 15);
  std::size_t end = bytes.size();
  if ((first & 0x10) != 0) {  // a header extension, with its length in words
    if (begin + 4 > end) return refusal(kWhere, "a cut extension", "a whole one");
    begin += 4 + 4 * std::size_t{big_endian<std::uint16_t>(bytes, begin + 2)};
  }
  if ((first & 0x20) != 0) {
    const auto padding = std::to_integer<std::size_t>(bytes[end - 1]);
    if (padding == 0 || padding > end - kRtpHeader)
      return refusal(kWhere, fmt::format("{} bytes of padding", padding), "less than the packet");
    end -= padding;
  }
  if (begin >= end || (end - begin) % 2 != 0)
    return refusal(kWhere, fmt::format("{} bytes of sound", begin < end ? end - begin : 0),
                   "2 for each sample, at least 1 sample");
  RtpPacket out;
  out.payload_type = type;
  out.sequence = big_endian<std::uint16_t>(bytes, 2);
  out.timestamp = big_endian<std::uint32_t>(bytes, 4);
  out.ssrc = big_endian<std::uint32_t>(bytes, 8);
  out.samples.reserve((end - begin) / 2);
  for (std::size_t at = begin; at < end; at += 2)
    out.samples.push_back(static_cast<std::int16_t>(big_endian<std::uint16_t>(bytes, at)) / kScale);
  return out;
}

std::vector<std::byte> encode_rtp(const RtpPacket& packet) {
  std::vector<std::byte> out{std::byte{0x80}, static_cast<std::byte>(packet.payload_type & 127)};
  put_big(out, packet.sequence);
  put_big(out, packet.timestamp);
  put_big(out, packet.ssrc);
  for (const float sample : packet.samples) {
    const float level =
        std::isfinite(sample) ? std::clamp(sample * kScale, -32768.0F, 32767.0F) : 0;
    put_big(out, static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(level))));
  }
  return out;
}

}  // namespace neritic::net
