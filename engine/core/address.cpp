#include "engine/core/address.hpp"

#include <charconv>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic {
namespace {

// A whole number up to `most` at the text's start, which is cut off. -1: there is none.
int take_number(std::string_view& text, int most) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || text[0] == '-' || value > most) return -1;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

bool take(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

bool take_host(std::string_view& text, std::uint32_t& ipv4) {
  if (take(text, "localhost")) return true;
  ipv4 = 0;
  for (int i = 0; i < 4; ++i) {
    if (i > 0 && !take(text, ".")) return false;
    const int part = take_number(text, 255);
    if (part < 0) return false;
    ipv4 = ipv4 << 8 | static_cast<std::uint32_t>(part);
  }
  return true;
}

}  // namespace

Result<Address> parse_address(std::string_view text) {
  std::string_view left = text;
  Address address;
  bool good = take(left, "udp://");
  if (!good && take(left, "tcp://")) address.transport = Transport::kTcp, good = true;
  good = good && take_host(left, address.ipv4) && take(left, ":");
  const int port = good ? take_number(left, 65535) : -1;
  if (port < 1 || !left.empty())
    return refusal("", fmt::format("'{}'", printable(text)),
                   "udp:// or tcp://, an IPv4 address or localhost, and a port from 1 to 65535, "
                   "as \"udp://127.0.0.1:9763\"");
  address.port = static_cast<std::uint16_t>(port);
  return address;
}

std::string to_text(const Address& address) {
  const std::uint32_t a = address.ipv4;
  return fmt::format("{}://{}.{}.{}.{}:{}", address.transport == Transport::kUdp ? "udp" : "tcp",
                     a >> 24, a >> 16 & 255, a >> 8 & 255, a & 255, address.port);
}

}  // namespace neritic
