#include "engine/net/gaze_wire.hpp"

#include <cmath>
#include <string_view>

#include "engine/core/refusal.hpp"
#include "engine/net/jacket_wire.hpp"

namespace neritic::net {
namespace {

constexpr std::string_view kGazeMagic = "UGZD", kGaze = "gaze";
constexpr std::size_t kChecked = kGazeBytes - 2;
// Lengths whose square is neither 0 nor infinite.
constexpr float kShortest = 1e-9F, kLongest = 1e9F;

}  // namespace

Result<GazePacket> decode_gaze(Bytes bytes) {
  if (bytes.size() != kGazeBytes)
    return refusal(kGaze, fmt::format("{} bytes", bytes.size()), fmt::format("{}", kGazeBytes));
  if (std::string_view(reinterpret_cast<const char*>(bytes.data()), kGazeMagic.size()) !=
      kGazeMagic)
    return refusal(kGaze, "another beginning", "UGZD");
  if (const int version = std::to_integer<int>(bytes[4]); version != 1)
    return refusal(kGaze, fmt::format("UGZD version {}", version), "1");
  if (little_endian<std::uint16_t>(bytes, kChecked) != crc16(bytes.first(kChecked)))
    return refusal(kGaze, "a wrong checksum", "CRC-16/CCITT-FALSE of the first 28 bytes");
  const auto flags = std::to_integer<unsigned>(bytes[5]);
  if (flags > 1) return refusal(kGaze, fmt::format("flags {:#x}", flags), "bit 0");
  GazePacket out{.valid = flags == 1,
                 .sequence = little_endian<std::uint16_t>(bytes, 6),
                 .time_us = little_endian<std::uint64_t>(bytes, 8)};
  for (int i = 0; i < 3; ++i)
    out.direction[i] = std::bit_cast<float>(
        little_endian<std::uint32_t>(bytes, 16 + 4 * static_cast<std::size_t>(i)));
  if (!out.valid) return out;
  float longest = 0.0F;
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(out.direction[i]))
      return refusal(kGaze, "a direction that is not finite", "finite numbers");
    longest = std::max(longest, std::abs(out.direction[i]));
  }
  if (longest < kShortest || longest > kLongest)
    return refusal(kGaze, fmt::format("a direction as long as {:g}", longest),
                   fmt::format("{:g} to {:g}", kShortest, kLongest));
  return out;
}

std::vector<std::byte> encode_gaze(const GazePacket& packet) {
  std::vector<std::byte> out;
  for (const char c : kGazeMagic) out.push_back(static_cast<std::byte>(c));
  out.push_back(std::byte{1});
  out.push_back(packet.valid ? std::byte{1} : std::byte{0});
  put_little(out, packet.sequence);
  put_little(out, packet.time_us);
  for (int i = 0; i < 3; ++i) put_little(out, std::bit_cast<std::uint32_t>(packet.direction[i]));
  put_little(out, crc16(out));
  return out;
}

}  // namespace neritic::net
