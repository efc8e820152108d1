#include "testbed/server/request.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/refusal.hpp"
#include "engine/core/source_name.hpp"
#include "engine/net/message_pack.hpp"

namespace neritic::testbed {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, kOps> kNames{
    "hello", "time",        "counts", "observe", "shared",  "tick",          "wait",    "clock",
    "keep",  "image",       "link",   "command", "release", "inject",        "sources", "truth",
    "poses", "instruments", "save",   "restore", "record",  "stop_recording"};

// The value found, short enough for a line and printable.
std::string shown(const json& value) {
  if (value.is_string()) {
    std::string text = value.get<std::string>().substr(0, 40);
    for (char& c : text)
      if (c < ' ' || c > '~') c = '?';
    return "\"" + text + "\"";
  }
  if (value.is_number_float()) {
    // 1.0 is another thing than 1 where a whole number is accepted.
    std::string text = fmt::format("{}", value.get<double>());
    if (text.find_first_not_of("-0123456789") == text.npos) text += ".0";
    return text;
  }
  if (value.is_number_unsigned()) return fmt::format("{}", value.get<std::uint64_t>());
  if (value.is_number_integer()) return fmt::format("{}", value.get<std::int64_t>());
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  return value.type_name();
}

// The keys of a request, each read once; the first that is wrong stops all.
class Keys {
 public:
  Keys(std::string_view op, const json& map) : op_(op), map_(map) {}

  void number(const char* key, double& to, double least, double most, bool required = false) {
    const json* value = find(key, required);
    if (!value) return;
    if (value->is_number()) {
      const double number = value->get<double>();
      if (number >= least && number <= most) {
        to = number;
        return;
      }
    }
    refuse(key, shown(*value), fmt::format("a number from {} to {}", least, most));
  }
  void number(const char* key, std::optional<double>& to, double least, double most) {
    if (!map_.contains(key)) return;
    double value = 0.0;
    number(key, value, least, most);
    to = value;
  }
  void count(const char* key, std::uint64_t& to, std::uint64_t least, std::uint64_t most,
             bool required = false) {
    const json* value = find(key, required);
    if (!value) return;
    if (value->is_number_unsigned() && value->get<std::uint64_t>() >= least &&
        value->get<std::uint64_t>() <= most)
      to = value->get<std::uint64_t>();
    else
      refuse(key, shown(*value), fmt::format("a whole number from {} to {}", least, most));
  }
  void flag(const char* key, bool& to) {
    const json* value = find(key, false);
    if (!value) return;
    if (value->is_boolean())
      to = value->get<bool>();
    else
      refuse(key, shown(*value), "true or false");
  }
  void text(const char* key, std::string& to, bool required) {
    const json* value = find(key, required);
    if (!value) return;
    if (value->is_string()) {
      const auto& text = value->get_ref<const std::string&>();
      const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
      if (!text.empty() && text.size() <= kMostText && std::ranges::all_of(text, printable)) {
        to = text;
        return;
      }
    }
    refuse(key, shown(*value), fmt::format("up to {} letters, digits and signs", kMostText));
  }
  // Under which samples enter.
  void source(const char* key, std::string& to) {
    const json* value = find(key, false);
    if (!value) return;
    if (!value->is_string()) return refuse(key, shown(*value), std::string(kAcceptedSourceName));
    to = value->get<std::string>();
    error_ = check_source_name(fmt::format("{}: {}", op_, key), to);
  }
  void values(const char* key, std::vector<double>& to) {
    const json* value = find(key, true);
    if (!value) return;
    const auto good = [](const json& one) {
      return one.is_number() && std::isfinite(one.get<double>());
    };
    if (value->is_array() && value->size() <= kMostValues && std::ranges::all_of(*value, good)) {
      to.clear();
      for (const json& one : *value) to.push_back(one.get<double>());
      return;
    }
    refuse(key, value->is_array() ? "numbers that are none, or too many" : shown(*value),
           fmt::format("up to {} finite numbers", kMostValues));
  }
  Status end() {
    for (const auto& [key, value] : map_.items())
      if (error_.ok() && !known_.contains(key) && key != "op" && key != "id")
        error_ = refusal(op_, fmt::format("the key {}", shown(key)),
                         known_.empty() ? "no key" : fmt::format("{}", fmt::join(known_, ", ")));
    return error_;
  }

 private:
  const json* find(const char* key, bool required) {
    known_.insert(key);
    const auto at = map_.find(key);
    if (at != map_.end()) return error_.ok() ? &*at : nullptr;
    if (required) refuse(key, "nothing", "a value");
    return nullptr;
  }
  void refuse(const char* key, const std::string& found, const std::string& accepted) {
    if (error_.ok()) error_ = refusal(fmt::format("{}: {}", op_, key), found, accepted);
  }

  std::string_view op_;
  const json& map_;
  std::set<std::string> known_;
  Status error_;
};

void read_keys(Keys& keys, Request& request) {
  constexpr double kMostTime_s = 1e9;
  switch (request.op) {
    case Op::kHello: {
      std::uint64_t protocol = 0;
      keys.count("protocol", protocol, kProtocol, kProtocol, true);
      keys.source("name", request.name);
      keys.text("participant", request.agent, false);
      return;
    }
    case Op::kTime: {
      std::uint64_t sent = 0;
      keys.count("sent_ns", sent, 0, std::uint64_t{1} << 62, true);
      request.sent_ns = static_cast<std::int64_t>(sent);
      return;
    }
    case Op::kObserve:
      keys.number("wait_s", request.wait_s, 0.0, kMostWait_s);
      return;
    case Op::kShared:
      keys.count("token", request.token, 0, ~std::uint64_t{0}, true);
      return;
    case Op::kTick:
      keys.count("steps", request.steps, 1, kMostSteps, true);
      return;
    case Op::kWait:
      keys.count("steps", request.steps, 1, kMostSteps, true);
      request.wait_s = kMostWait_s;
      keys.number("wait_s", request.wait_s, 0.0, kMostWait_s);
      return;
    case Op::kClock:
      keys.flag("take", request.on);
      return;
    case Op::kKeep:
      keys.text("stream", request.stream, true);
      keys.flag("on", request.on);
      return;
    case Op::kImage:
      keys.text("stream", request.stream, true);
      keys.flag("on", request.on);
      keys.flag("keep", request.keep);
      keys.number("rate_hz", request.rate_hz, 0.0, 1000.0);
      return;
    case Op::kLink:
      keys.text("stream", request.stream, true);
      keys.number("delay_s", request.link.delay_s, 0.0, 3600.0);
      keys.number("jitter_s", request.link.jitter_s, 0.0, 3600.0);
      keys.number("loss", request.link.loss, 0.0, 1.0);
      return;
    case Op::kCommand:
      keys.text("agent", request.agent, true);
      keys.text("kind", request.kind, true);
      keys.values("values", request.values);
      keys.number("hold_s", request.hold_s, 0.0, kMostTime_s);
      return;
    case Op::kInject:
      keys.text("stream", request.stream, true);
      keys.values("values", request.values);
      keys.source("source", request.source);
      keys.number("stamp_s", request.stamp_s, -kMostTime_s, kMostTime_s);
      return;
    case Op::kRelease:
    case Op::kTruth:
    case Op::kInstruments:
      keys.text("agent", request.agent, true);
      return;
    case Op::kRecord:
      keys.text("name", request.name, true);
      return;
    case Op::kCounts:
    case Op::kSources:
    case Op::kPoses:
    case Op::kSave:
    case Op::kRestore:
    case Op::kStopRecording:
      return;
  }
}

}  // namespace

std::string_view name_of(Op op) {
  return kNames.at(static_cast<std::size_t>(op));
}

Result<Request> parse_request(const std::vector<net::Bytes>& frames,
                              std::optional<std::uint64_t>& id_out) {
  constexpr net::PackLimits kLimits{.bytes = 64 << 10, .values = 1024};
  id_out.reset();
  if (!frames.empty()) id_out = net::number_under(frames[0], "id", kLimits);
  if (frames.empty() || frames.size() > 2)
    return refusal("request", fmt::format("{} frames", frames.size()),
                   "a map, and the bytes of a state after restore");
  NERITIC_TRY(const json map, net::unpack(frames[0], kLimits));
  if (const auto id = map.find("id"); id == map.end())
    id_out = 0;
  else if (!id_out)
    return refusal("request: id", shown(*id), "a whole number");
  const auto op = map.find("op");
  const auto at = op != map.end() && op->is_string()
                      ? std::ranges::find(kNames, op->get_ref<const std::string&>())
                      : kNames.end();
  if (at == kNames.end())
    return refusal("request: op", op == map.end() ? "nothing" : shown(*op),
                   fmt::format("{}", fmt::join(kNames, ", ")));
  Request request{.op = static_cast<Op>(at - kNames.begin()), .id = *id_out};
  Keys keys(*at, map);
  read_keys(keys, request);
  NERITIC_TRY_STATUS(keys.end());
  if ((request.op == Op::kRestore) != (frames.size() == 2))
    return refusal(*at, fmt::format("{} frames", frames.size()),
                   request.op == Op::kRestore ? "2: the map and a state" : "1");
  if (frames.size() == 2) request.bytes.assign(frames[1].begin(), frames[1].end());
  return request;
}

}  // namespace neritic::testbed
