// The motion suit's datagrams: Xsens MVN real-time network streaming (MXTP; protocol specification
// MV0305, revision N, 2018). UDP or TCP, port 9763, big endian: 24 bytes of header, then items.
// Axes of type 02: z up, x forward and y to the left of a person who faces x; metres (the
// specification's text says centimetres, the program sends metres); a rotation is that from the
// posture with arms spread (T). Pure functions of the bytes; any thread.
#pragma once

#include <array>
#include <string>
#include <variant>

#include "engine/core/result.hpp"
#include "engine/net/wire_bytes.hpp"

namespace neritic::net {

inline constexpr std::size_t kMxtpHeader = 24, kMxtpMostBytes = 65'507;
inline constexpr std::size_t kMxtpBodySegments = 23, kMxtpHandSegments = 20;

struct MxtpHeader {
  int type = 2;  // 1, 2, 20 to 25 are decoded
  std::uint32_t sample = 0;
  std::uint8_t datagram = 0;  // of the sample, from 0 to 127
  bool last = true;           // of the sample's datagrams
  std::uint8_t items = 0;
  std::uint32_t time_ms = 0;  // the sender's clock; wraps
  std::uint8_t character = 0, body_segments = 0, props = 0, finger_segments = 0;
  std::uint16_t payload = 0;  // bytes after the header; older programs leave it 0
};

using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;  // a quaternion w, x, y, z

// Type 01: y up, centimetres, degrees.
struct MxtpEuler {
  std::uint32_t id = 0;
  Float3 position_cm{}, angles_deg{};
};
// Type 02.
struct MxtpPose {
  std::uint32_t id = 0;
  Float3 position_m{};
  Float4 rotation{1, 0, 0, 0};
};
// Type 20: angles about x (abduction), y (axial rotation), z (flexion).
struct MxtpJoint {
  std::uint32_t parent_segment = 0, parent_point = 0, child_segment = 0, child_point = 0;
  Float3 angles_deg{};
};
// Type 21.
struct MxtpLinear {
  std::uint32_t id = 0;
  Float3 position_m{}, velocity_m_s{}, acceleration_m_s2{};
};
// Type 22. As on the wire: radians, where the specification's text says degrees.
struct MxtpAngular {
  std::uint32_t id = 0;
  Float4 rotation{1, 0, 0, 0};
  Float3 velocity_rad_s{}, acceleration_rad_s2{};
};
// Type 23, of 44 bytes (free acceleration, magnetic field) or 68 (all).
struct MxtpTracker {
  std::uint32_t id = 0;
  Float4 rotation{1, 0, 0, 0};
  Float3 free_acceleration_m_s2{}, acceleration_m_s2{}, turn_rate_rad_s{}, magnetic_field{};
  bool whole = false;  // of 68 bytes
};
// Type 24, of 12 bytes (the position) or 36.
struct MxtpMassCentre {
  Float3 position_m{}, velocity_m_s{}, acceleration_m_s2{};
  bool moving = false;  // of 36 bytes
};
// Type 25: "16:00:31.123".
struct MxtpTimeCode {
  std::string text;
};

using MxtpItems =
    std::variant<std::vector<MxtpEuler>, std::vector<MxtpPose>, std::vector<MxtpJoint>,
                 std::vector<MxtpLinear>, std::vector<MxtpAngular>, std::vector<MxtpTracker>,
                 std::vector<MxtpMassCentre>, MxtpTimeCode>;

struct MxtpDatagram {
  MxtpHeader header;
  MxtpItems items;
  std::uint32_t refused_items = 0;  // not finite, or a rotation of no length: left out of items
};

// kBadInput: no MXTP, or its lengths do not agree. kUnsupported: another type.
Result<MxtpDatagram> decode_mxtp(Bytes bytes);

// The bytes of the datagram at the front of a stream; 0: not known yet. Where an older program
// leaves the payload's length 0, items of types 01, 02 and 20 to 22 give it; any other datagram
// ends where the next begins. kBadInput: no datagram begins there, or it has no end.
Result<std::size_t> mxtp_length(Bytes stream);

// Puts another number and time into a datagram. Precondition: it is a whole header at least.
void put_mxtp_number(std::span<std::byte> datagram, std::uint32_t sample, std::uint32_t time_ms);

// Type 02, one datagram. Precondition: at most 255 poses.
std::vector<std::byte> encode_mxtp(MxtpHeader header, std::span<const MxtpPose> poses);

}  // namespace neritic::net
