// The address of a socket as a person writes it: "udp://127.0.0.1:9763". Numbers and "localhost"
// alone, so that no name is looked up. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/core/result.hpp"

namespace neritic {

enum class Transport : std::uint8_t { kUdp, kTcp };

struct Address {
  Transport transport = Transport::kUdp;
  std::uint32_t ipv4 = 0x7f000001;  // 127.0.0.1: the first number is the highest byte
  std::uint16_t port = 0;

  // 127.x.x.x: only this machine reaches it.
  bool loopback() const { return ipv4 >> 24 == 127; }
  bool operator==(const Address&) const = default;
};

// kBadInput: "found ...; accepted: ...", without a place. Ports from 1 to 65535.
Result<Address> parse_address(std::string_view text);
std::string to_text(const Address& address);

}  // namespace neritic
