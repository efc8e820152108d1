#include "engine/net/heart_strap.hpp"

#include <cmath>

#include "engine/core/refusal.hpp"

namespace neritic::net {
namespace {

constexpr std::uint8_t kWideRate = 1, kContact = 2, kContactKnown = 4, kEnergy = 8, kIntervals = 16;
constexpr std::int32_t kSampleSign = 0x800000;

}  // namespace

Result<HeartRatePacket> decode_heart_rate(Bytes bytes) {
  constexpr std::string_view kWhere = "heart rate";
  if (bytes.size() < 2 || bytes.size() > kMostNotification)
    return refusal(kWhere, fmt::format("{} bytes", bytes.size()),
                   fmt::format("2 to {}", kMostNotification));
  const auto flags = std::to_integer<std::uint8_t>(bytes[0]);
  const std::size_t rate = (flags & kWideRate) != 0 ? 2 : 1,
                    energy = (flags & kEnergy) != 0 ? 2 : 0;
  std::size_t at = 1 + rate + energy;
  const bool intervals = (flags & kIntervals) != 0;
  if (bytes.size() < at || (!intervals && bytes.size() != at))
    return refusal(kWhere, fmt::format("{} bytes", bytes.size()),
                   fmt::format("{} by its flags", at));
  if ((bytes.size() - at) % 2 != 0) return refusal(kWhere, "half an interval", "whole ones");
  HeartRatePacket out;
  out.bpm =
      rate == 2 ? little_endian<std::uint16_t>(bytes, 1) : little_endian<std::uint8_t>(bytes, 1);
  if ((flags & kContactKnown) != 0) out.contact = (flags & kContact) != 0;
  if (energy != 0) out.energy_kj = little_endian<std::uint16_t>(bytes, 1 + rate);
  for (; at < bytes.size(); at += 2)
    out.intervals.push_back(little_endian<std::uint16_t>(bytes, at));
  return out;
}

std::vector<std::byte> encode_heart_rate(const HeartRatePacket& packet) {
  std::uint8_t flags = 0;
  if (packet.bpm > 255) flags |= kWideRate;
  if (packet.contact) flags |= *packet.contact ? kContactKnown | kContact : kContactKnown;
  if (packet.energy_kj) flags |= kEnergy;
  if (!packet.intervals.empty()) flags |= kIntervals;
  std::vector<std::byte> out{static_cast<std::byte>(flags)};
  if (packet.bpm > 255)
    put_little(out, packet.bpm);
  else
    put_little(out, static_cast<std::uint8_t>(packet.bpm));
  if (packet.energy_kj) put_little(out, *packet.energy_kj);
  for (const std::uint16_t interval : packet.intervals) put_little(out, interval);
  return out;
}

Result<EcgFrame> decode_ecg(Bytes bytes) {
  constexpr std::string_view kWhere = "PMD";
  if (bytes.size() < kEcgHeader || bytes.size() > kMostNotification)
    return refusal(kWhere, fmt::format("{} bytes", bytes.size()),
                   fmt::format("{} to {}", kEcgHeader + 3, kMostNotification));
  const int type = std::to_integer<int>(bytes[0]), form = std::to_integer<int>(bytes[9]);
  if (type != 0 || form != 0)
    return failure(ErrorCode::kUnsupported,
                   "PMD: found measurement {} in frames of type {}; accepted: ECG (0) in type 0",
                   type, form);
  const std::size_t left = bytes.size() - kEcgHeader;
  if (left == 0 || left % 3 != 0)
    return refusal(kWhere, fmt::format("{} bytes of samples", left), "3 each");
  EcgFrame out{little_endian<std::uint64_t>(bytes, 1), {}};
  out.samples_uv.reserve(left / 3);
  for (std::size_t at = kEcgHeader; at < bytes.size(); at += 3) {
    const auto raw = static_cast<std::int32_t>(little_endian<std::uint16_t>(bytes, at) |
                                               std::to_integer<std::uint32_t>(bytes[at + 2]) << 16);
    out.samples_uv.push_back((raw ^ kSampleSign) - kSampleSign);
  }
  return out;
}

std::vector<std::byte> encode_ecg(const EcgFrame& frame) {
  std::vector<std::byte> out{std::byte{0}};
  put_little(out, frame.time_ns);
  out.push_back(std::byte{0});
  for (const std::int32_t sample : frame.samples_uv)
    for (int shift = 0; shift < 24; shift += 8)
      out.push_back(static_cast<std::byte>(static_cast<std::uint32_t>(sample) >> shift & 255));
  return out;
}

std::uint64_t ecg_time_ns(std::size_t i, std::size_t n, std::uint64_t time_ns,
                          std::optional<std::uint64_t> before_ns) {
  if (before_ns) {
    // Whole numbers: the product is far below 2^64 for any frame.
    const std::uint64_t span = time_ns - *before_ns;
    return *before_ns + span / n * (i + 1) + span % n * (i + 1) / n;
  }
  return time_ns -
         static_cast<std::uint64_t>(std::llround(static_cast<double>(n - 1 - i) * 1e9 / kEcg_hz));
}

bool looks_like_ecg(Bytes bytes) {
  return bytes.size() >= kEcgHeader && bytes[0] == std::byte{0};
}

}  // namespace neritic::net
