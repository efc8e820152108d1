#include "engine/net/jacket_wire.hpp"

#include <algorithm>
#include <string_view>

#include "engine/core/refusal.hpp"

namespace neritic::net {
namespace {

constexpr std::string_view kUbcdMagic = "UBCD", kJacket = "jacket";
constexpr std::size_t kMostText = 64;

Result<JacketPacket> decode_ubcd(Bytes bytes) {
  if (bytes.size() != kUbcdBytes)
    return refusal(kJacket, fmt::format("{} bytes of UBCD", bytes.size()), "26");
  if (const int version = std::to_integer<int>(bytes[4]); version != 1)
    return refusal(kJacket, fmt::format("UBCD version {}", version), "1");
  if (little_endian<std::uint16_t>(bytes, 24) != crc16(bytes.first(24)))
    return refusal(kJacket, "a wrong checksum", "CRC-16/CCITT-FALSE of the first 24 bytes");
  const auto state = std::to_integer<unsigned>(bytes[16]);
  if (state > 7) return refusal(kJacket, fmt::format("buttons {:#x}", state), "bits 0 to 2");
  JacketPacket out;
  UbcdCounters counters;
  counters.device = std::to_integer<std::uint8_t>(bytes[5]);
  counters.sequence = little_endian<std::uint16_t>(bytes, 6);
  counters.time_us = little_endian<std::uint64_t>(bytes, 8);
  counters.presses = std::to_integer<std::uint8_t>(bytes[17]);
  for (std::size_t i = 0; i < 3; ++i) {
    out.pressed[i] = (state >> i & 1) != 0;
    counters.pressed_ms[i] = little_endian<std::uint16_t>(bytes, 18 + 2 * i);
  }
  out.counters = counters;
  return out;
}

std::string_view without_spaces(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t\n\r"), text.size()));
}

// Takes a word from the front, with the spaces before it.
bool take(std::string_view& text, std::string_view word) {
  text = without_spaces(text);
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

Result<JacketPacket> decode_list(Bytes bytes) {
  const Error no_list = refusal(kJacket, "another list",
                                "three of true, false, 1, 0 in brackets: [true,false,false]");
  if (bytes.size() > kMostText) return no_list;
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  JacketPacket out;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!take(text, i == 0 ? "[" : ",")) return no_list;
    out.pressed[i] = take(text, "true") || take(text, "1");
    if (!out.pressed[i] && !take(text, "false") && !take(text, "0")) return no_list;
  }
  if (!take(text, "]") || (take(text, ""), !text.empty())) return no_list;
  return out;
}

}  // namespace

std::uint16_t crc16(Bytes bytes) {
  std::uint32_t crc = 0xffff;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint32_t>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x8000) != 0 ? 0x1021U : 0U);
    crc &= 0xffff;
  }
  return static_cast<std::uint16_t>(crc);
}

Result<JacketPacket> decode_jacket(Bytes bytes) {
  if (bytes.size() >= 4 &&
      std::string_view(reinterpret_cast<const char*>(bytes.data()), 4) == kUbcdMagic)
    return decode_ubcd(bytes);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (without_spaces(text).starts_with('[')) return decode_list(bytes);
  JacketPacket out;
  bool raw = bytes.size() == 3;
  for (std::size_t i = 0; raw && i < 3; ++i) {
    raw = bytes[i] <= std::byte{1};
    out.pressed[i] = bytes[i] == std::byte{1};
  }
  if (!raw)
    return refusal(kJacket, fmt::format("{} other bytes", bytes.size()),
                   "UBCD, a list of three booleans, or three bytes 0 or 1");
  return out;
}

std::vector<std::byte> encode_jacket(const JacketPacket& packet) {
  std::vector<std::byte> out;
  std::uint8_t state = 0;
  for (std::size_t i = 0; i < 3; ++i) state |= static_cast<std::uint8_t>(packet.pressed[i] << i);
  if (!packet.counters) {
    for (const bool pressed : packet.pressed) out.push_back(static_cast<std::byte>(pressed));
    return out;
  }
  const UbcdCounters& counters = *packet.counters;
  for (const char c : kUbcdMagic) out.push_back(static_cast<std::byte>(c));
  out.push_back(std::byte{1});
  put_little(out, counters.device);
  put_little(out, counters.sequence);
  put_little(out, counters.time_us);
  put_little(out, state);
  put_little(out, counters.presses);
  for (const std::uint16_t ms : counters.pressed_ms) put_little(out, ms);
  put_little(out, crc16(out));
  return out;
}

}  // namespace neritic::net
