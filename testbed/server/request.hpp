// A client's request, read from MessagePack as if a stranger had sent it: every number in its
// limits, every text short and printable, no key that the request does not have. PROTOCOL.md has
// the requests. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/net/wire_bytes.hpp"
#include "testbed/world/arrivals.hpp"

namespace neritic::testbed {

enum class Op : std::uint32_t {
  // Answered by the network's thread alone.
  kHello,
  kTime,
  kCounts,
  kObserve,
  kShared,
  // Answered by the simulation.
  kTick,
  kWait,
  kClock,
  kKeep,
  kImage,
  kLink,
  kCommand,
  kRelease,
  kInject,
  kSources,
  kTruth,
  kPoses,
  kInstruments,
  kSave,
  kRestore,
  kRecord,
  kStopRecording,
};
inline constexpr std::size_t kOps = static_cast<std::size_t>(Op::kStopRecording) + 1;
std::string_view name_of(Op op);
constexpr bool of_simulation(Op op) {
  return op >= Op::kTick;
}

inline constexpr std::uint32_t kProtocol = 1;
inline constexpr std::uint64_t kMostSteps = 100'000;  // of one tick
inline constexpr double kMostWait_s = 60.0;
inline constexpr std::size_t kMostText = 128, kMostValues = 256;

struct Request {
  Op op = Op::kHello;
  std::uint64_t id = 0;  // the client's; 0: it wants no answer
  std::uint64_t steps = 0;
  double wait_s = 0.0, hold_s = 0.0, rate_hz = 0.0;
  std::optional<double> stamp_s;
  std::int64_t sent_ns = 0;
  std::uint64_t token = 0;
  bool on = true, keep = false;
  std::string agent, kind, stream, name, source;
  std::vector<double> values;
  LinkOptions link;
  std::vector<std::byte> bytes;  // of kRestore
};

// The first frame is the map, a second one the bytes of a state. kBadInput: "OP: KEY: found ...;
// accepted: ...". id_out: the request's number, where it can be read, for the refusal; nothing
// where it cannot.
Result<Request> parse_request(const std::vector<net::Bytes>& frames,
                              std::optional<std::uint64_t>& id_out);

}  // namespace neritic::testbed
