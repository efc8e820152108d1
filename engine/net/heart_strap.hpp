// The notifications of a heart strap: the Bluetooth heart rate measurement (characteristic 0x2A37;
// Heart Rate Service 1.0) and the ECG of Polar's measurement data service (PMD). The same bytes
// come over UDP, one notification a datagram. Pure functions of the bytes; any thread.
#pragma once

#include <optional>

#include "engine/core/clock.hpp"
#include "engine/core/result.hpp"
#include "engine/net/wire_bytes.hpp"

namespace neritic::net {

inline constexpr std::size_t kMostNotification = 512;  // of an attribute

struct HeartRatePacket {
  std::uint16_t bpm = 0;  // 0 without contact: a gap, no slow heart
  std::optional<bool> contact;
  std::optional<std::uint16_t> energy_kj;
  std::vector<std::uint16_t> intervals;  // RR, oldest first, in 1/1024 s
};
inline constexpr double kRrUnit_s = 1.0 / 1024.0;
// kBadInput: empty, cut, half an interval, or bytes too many.
Result<HeartRatePacket> decode_heart_rate(Bytes bytes);
std::vector<std::byte> encode_heart_rate(const HeartRatePacket& packet);

struct EcgFrame {
  std::uint64_t time_ns = 0;  // of the last sample, since 2000-01-01, by the strap's clock
  std::vector<std::int32_t> samples_uv;
};
// Nominal; straps were measured at 130.16 Hz, so that samples are spread between frames' times.
inline constexpr double kEcg_hz = 130.0;
inline constexpr std::size_t kEcgHeader = 10;
// kBadInput: cut, or no whole samples. kUnsupported: another measurement or frame.
Result<EcgFrame> decode_ecg(Bytes bytes);
std::vector<std::byte> encode_ecg(const EcgFrame& frame);
// The time of sample i of a frame of n. before_ns: of the frame before, if there is one; after a
// gap there is none.
std::uint64_t ecg_time_ns(std::size_t i, std::size_t n, std::uint64_t time_ns,
                          std::optional<std::uint64_t> before_ns);

// The bytes are an ECG frame, not a heart rate: a heart rate without flags has two bytes.
bool looks_like_ecg(Bytes bytes);

}  // namespace neritic::net
