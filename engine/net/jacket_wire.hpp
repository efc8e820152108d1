// The buttons of a buoyancy jacket over UDP: "UBCD" version 1 (a form of ours, README.md: there is
// no standard), a JSON list of three booleans, or three raw bytes; inflate, deflate, dump. Pure
// functions of the bytes; any thread.
#pragma once

#include <array>
#include <optional>

#include "engine/core/result.hpp"
#include "engine/net/wire_bytes.hpp"

namespace neritic::net {

inline constexpr std::uint16_t kJacketPort = 47810;
inline constexpr std::size_t kUbcdBytes = 26;

// Fields of version 1 alone. Counters wrap.
struct UbcdCounters {
  std::uint8_t device = 0;
  std::uint16_t sequence = 0;
  std::uint64_t time_us = 0;                  // the sender's monotonic clock
  std::uint8_t presses = 0;                   // of any button
  std::array<std::uint16_t, 3> pressed_ms{};  // each button's time so far
};

struct JacketPacket {
  std::array<bool, 3> pressed{};  // inflate, deflate, dump
  std::optional<UbcdCounters> counters;
};

// kBadInput: none of the three forms, or a wrong checksum.
Result<JacketPacket> decode_jacket(Bytes bytes);
// With counters version 1, else the three raw bytes.
std::vector<std::byte> encode_jacket(const JacketPacket& packet);

// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xffff. "123456789" gives 0x29b1.
std::uint16_t crc16(Bytes bytes);

}  // namespace neritic::net
