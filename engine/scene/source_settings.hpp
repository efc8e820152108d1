// A device that a scene connects: one line of its table [sources]. Plain data: engine/scene knows
// neither the device's bytes nor the samples that come of them. Any thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/address.hpp"

namespace neritic::scene {

struct DeviceSource {
  std::string name;      // under which its samples enter
  std::string device;    // of kDeviceKinds
  std::string by;        // the way its bytes come: "udp", "tcp", "tcp-to", "bluetooth", ...
  Address address;       // of udp, tcp, tcp-to
  std::string port;      // of the others: a Bluetooth device, a sound card, a file, a stream
  std::string diver;     // who wears it
  int character = 0;     // of a suit's stream
  double rate_hz = 0.0;  // of sound
};

// The kinds of devices, and the groups of a diver's inputs that it feeds.
struct DeviceKind {
  std::string_view name;
  std::array<std::string_view, 2> groups;  // the second may be empty
  std::array<std::string_view, 4> ways;    // accepted, the rest empty
  std::uint16_t port = 0;                  // of udp and tcp unless one is named
};
inline constexpr DeviceKind kDeviceKinds[] = {
    {"mxtp", {"body", "hands"}, {"udp", "tcp", "tcp-to"}, 9763},
    {"strap", {"heart"}, {"udp", "bluetooth", "lsl"}, 47811},
    {"jacket", {"buttons"}, {"udp", "lsl"}, 47810},
    {"microphone", {"breath"}, {"udp", "alsa", "wav", "lsl"}, 5004},
    {"gaze", {"gaze"}, {"udp", "lsl"}, 47813},
};
const DeviceKind* device_kind(std::string_view name);

// "mxtp udp 9763", "strap bluetooth Polar H10": device and the way its bytes come. An address
// without a host is this machine's own, which no other can reach. kBadInput: "found ...;
// accepted: ...", without a place.
Result<DeviceSource> parse_device(std::string_view text);

}  // namespace neritic::scene
