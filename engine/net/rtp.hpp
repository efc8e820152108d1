// Sound over the network: RTP (RFC 3550) with linear 16-bit samples, big endian (L16, RFC 3551), as
// common programs send it: under a payload type that the session assigns (96 to 127), or under 11,
// one channel at 44.1 kHz. Pure functions of the bytes; any thread.
#pragma once

#include "engine/core/result.hpp"
#include "engine/net/wire_bytes.hpp"

namespace neritic::net {

// RFC 3551, table 4: L16 of one channel at 44.1 kHz.
inline constexpr std::uint8_t kRtpL16 = 11;
inline constexpr double kRtpL16_hz = 44'100.0;

struct RtpPacket {
  std::uint8_t payload_type = 96;
  std::uint16_t sequence = 0;
  std::uint32_t timestamp = 0;  // of the first sample, in samples; wraps
  std::uint32_t ssrc = 0;
  std::vector<float> samples;  // -1 to 1
};

// Mono. kUnsupported: another payload type, 10 (two channels) and those of compressed sound among
// them. kBadInput: no RTP of version 2, cut, padding that is longer than the packet, half a sample,
// or no sample.
Result<RtpPacket> decode_rtp(Bytes bytes);
// Samples beyond -1 to 1 are clipped.
std::vector<std::byte> encode_rtp(const RtpPacket& packet);

}  // namespace neritic::net
