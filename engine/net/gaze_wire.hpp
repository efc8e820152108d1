// Where a person looks, over UDP: "UGZD" version 1 (a form of ours, README.md: trackers have no
// standard), a datagram a sample. Pure functions of the bytes; any thread.
#pragma once

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "engine/net/wire_bytes.hpp"

namespace neritic::net {

inline constexpr std::uint16_t kGazePort = 47813;
inline constexpr std::size_t kGazeBytes = 30;

struct GazePacket {
  bool valid = true;  // the tracker saw the eyes
  std::uint16_t sequence = 0;
  std::uint64_t time_us = 0;           // when it saw them, on its monotonic clock
  Vec3f direction{0.0F, 0.0F, -1.0F};  // x east, y up, z south; of any length
};

// kBadInput: no such datagram, a wrong checksum, or a direction that is none.
Result<GazePacket> decode_gaze(Bytes bytes);
std::vector<std::byte> encode_gaze(const GazePacket& packet);

}  // namespace neritic::net
