// MessagePack of a server and its clients: one map a message, checked as if a stranger had sent it.
// Arrays travel beside it as bytes of their own. Pure functions; any thread.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>

#include "engine/core/result.hpp"
#include "engine/net/wire_bytes.hpp"

namespace neritic::net {

// For one message. Beyond them it is refused before it is built: a stranger's bytes cost no more
// memory or stack than these.
struct PackLimits {
  std::size_t bytes = std::size_t{1} << 20;
  std::size_t values = 65536;  // numbers, texts, maps and lists together
  int depth = 8;               // of maps and lists in each other
};

// A map, whose texts may be any bytes and whose numbers may be NaN or infinite. kBadInput:
// "MessagePack: found ...; accepted: ...".
Result<nlohmann::json> unpack(Bytes bytes, const PackLimits& limits = {});
// The whole number under a key of the map, also of one that unpack() refuses, so that a refusal can
// say which message it answers. Absent: not found before bytes that do not read or lie too deep.
std::optional<std::uint64_t> number_under(Bytes bytes, std::string_view key,
                                          const PackLimits& limits = {});
std::vector<std::byte> pack(const nlohmann::json& value);

}  // namespace neritic::net
