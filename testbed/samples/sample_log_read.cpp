#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "engine/core/refusal.hpp"
#include "engine/core/source_name.hpp"
#include "engine/core/text.hpp"
#include "engine/recording/cdr.hpp"
#include "engine/recording/ros_types.hpp"
#include "engine/sim/run_log.hpp"
#include "testbed/samples/recording_names.hpp"
#include "testbed/samples/sample_log.hpp"
#include "testbed/samples/sample_messages.hpp"

namespace neritic::testbed {
namespace {

constexpr std::size_t kMaxName = 255;

constexpr double kLatest_s = 1e9;  // of a start: thirty years

// Sums of two such times do not overflow: 36 years.
constexpr TimeNs kMostTime_ns = TimeNs{1} << 60;
bool plausible(TimeNs time_ns) {
  return time_ns >= -kMostTime_ns && time_ns <= kMostTime_ns;
}

bool is_name(const std::string& name) {
  return !name.empty() && name.size() <= kMaxName &&
         std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; });
}

template <class T>
bool parse(const std::string& text, T& value, int base) requires std::integral<T> {
  const auto end = text.data() + text.size();
  return std::from_chars(text.data(), end, value, base).ptr == end && !text.empty();
}
bool parse(const std::string& text, double& value) {
  const auto end = text.data() + text.size();
  return std::from_chars(text.data(), end, value).ptr == end && !text.empty();
}

class LogVisitor final : public recording::McapVisitor {
 public:
  explicit LogVisitor(const std::string& name) : name_(name) {}

  Status schema(std::uint16_t id, const recording::McapSchema& schema) override {
    schemas_[id] = schema;
    return {};
  }
  Status channel(std::uint16_t id, const recording::McapChannel& channel) override;
  Status message(const recording::McapMessage& message) override;
  Status attachment(const recording::McapAttachment& attachment) override;
  Status metadata(const recording::McapMetadata& metadata) override;

  Result<SampleLog> log(const recording::McapReport& report);

 private:
  enum class Use { kNone, kStep, kSource, kSample };
  struct Channel {
    Use use = Use::kNone;
    StreamId stream = 0;  // of the log
  };
  Status facts(const recording::McapMetadata& metadata);
  Error unknown_run() const {
    return bad_facts_
               ? *bad_facts_
               : refusal(name_, "an MCAP file without what was run", "a recording of this program");
  }
  Status step(std::span<const std::byte> bytes);
  Status source(std::span<const std::byte> bytes);
  Status sample(StreamId stream, std::span<const std::byte> bytes);

  const std::string& name_;
  SampleLog log_;
  bool known_ = false;  // its metadata came
  std::optional<Error> bad_facts_;
  bool gap_ = false;  // steps are missing: nothing that comes later is of use
  // Set at the first step after missing ones.
  std::optional<Error> doubt_;
  std::map<std::uint16_t, recording::McapSchema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

// Of two copies the first good one counts: this record has no CRC of its own.
Status LogVisitor::metadata(const recording::McapMetadata& metadata) {
  if (metadata.name != kRunMetadata || known_) return {};
  const Status read = facts(metadata);
  known_ = read.ok();
  if (!known_ && !bad_facts_) bad_facts_ = read.error();
  return {};
}

Status LogVisitor::facts(const recording::McapMetadata& metadata) {
  const auto word = [&](const char* key) {
    const auto at = metadata.words.find(key);
    return at == metadata.words.end() ? std::string() : at->second;
  };
  if (word("format") != kRunFormat)
    return refusal(name_, fmt::format("a recording of format '{}'", printable(word("format"))),
                   kRunFormat);
  if (!parse(word("step_s"), log_.step_s) || !parse(word("seed"), log_.seed, 10) ||
      !parse(word("first_step"), log_.first_step, 10))
    return refusal(name_, "a recording without step_s, seed or first_step", "one that names them");
  if (!(log_.step_s > 0.0 && log_.step_s <= sim::kMaxStep_s))
    return refusal(name_, fmt::format("a step of {} s", log_.step_s),
                   fmt::format("over 0 to {} s", sim::kMaxStep_s));
  if (static_cast<double>(log_.first_step) * log_.step_s > kLatest_s)
    return refusal(name_, fmt::format("first_step {}", log_.first_step),
                   fmt::format("a step before {:g} s", kLatest_s));
  log_.scene_path = word("scene");
  if (const std::string hash = word("scene_hash");
      !hash.empty() && !parse(hash, log_.scene_hash, 16))
    return refusal(name_, fmt::format("scene_hash '{}'", printable(hash)), "16 digits");
  return {};
}

Status LogVisitor::attachment(const recording::McapAttachment& attachment) {
  if (attachment.name == kSceneAttachment && log_.scene_text.empty())
    log_.scene_text.assign(reinterpret_cast<const char*>(attachment.data.data()),
                           attachment.data.size());
  if (attachment.name == kStateAttachment && log_.start_state.empty())
    log_.start_state.assign(attachment.data.begin(), attachment.data.end());
  return {};
}

Status LogVisitor::channel(std::uint16_t id, const recording::McapChannel& channel) {
  const recording::McapSchema& schema = schemas_[channel.schema];
  const auto is_own = [&](const char* type, const char* lines) {
    return schema.data == recording::own_schema(type, lines).data;
  };
  const auto other_fields = [&] {
    return refusal(name_, fmt::format("other fields of {}", printable(channel.topic)),
                   "those of this version");
  };
  if (channel.topic == kStepTopic) {
    if (!is_own(kStepType, kStepLines)) return other_fields();
    channels_[id] = {Use::kStep, 0};
    return {};
  }
  if (channel.topic == kSourceTopic) {
    if (!is_own(kSourceType, kSourceLines)) return other_fields();
    channels_[id] = {Use::kSource, 0};
    return {};
  }
  const auto way = channel.metadata.find(kWayKey);
  if (way == channel.metadata.end() || way->second != kIn) return {};
  const auto stream = channel.metadata.find(kStreamKey), kind = channel.metadata.find(kKindKey);
  if (stream == channel.metadata.end() || kind == channel.metadata.end() ||
      !is_name(stream->second))
    return refusal(name_, fmt::format("channel {} without a name or kind", id), "both");
  for (std::size_t i = 0; i < kPayloadKinds; ++i) {
    const auto at = static_cast<PayloadKind>(i);
    if (name_of(at) != kind->second || !enters(at)) continue;
    if (schema.data != sample_schema(at).data) return other_fields();
    channels_[id] = {Use::kSample, static_cast<StreamId>(log_.streams.size())};
    log_.streams.push_back({stream->second, at});
    return {};
  }
  return refusal(name_, fmt::format("samples of kind '{}'", printable(kind->second)),
                 "a kind of sample of this version");
}

Status LogVisitor::message(const recording::McapMessage& message) {
  const auto at = channels_.find(message.channel);
  if (at == channels_.end()) return {};
  if (!known_ && at->second.use != Use::kNone) return unknown_run();
  const bool is_step = at->second.use == Use::kStep;
  if (gap_ || (doubt_ && !is_step)) return {};
  switch (at->second.use) {
    case Use::kStep:
      return step(message.data);
    case Use::kSource:
      return source(message.data);
    case Use::kSample:
      return sample(at->second.stream, message.data);
    case Use::kNone:
      break;
  }
  return {};
}

Status LogVisitor::step(std::span<const std::byte> bytes) {
  recording::CdrReader in(bytes);
  in.number<std::int32_t>(), in.number<std::uint32_t>(), in.text();
  const auto step = in.number<std::uint64_t>();
  in.number<double>();
  const auto hash = in.number<std::uint64_t>();
  if (!in.whole() || in.left() > 0)
    return refusal(name_, fmt::format("a part of step {}", log_.hashes.size()), "whole steps");
  const std::uint64_t next = log_.first_step + log_.hashes.size();
  // A recording that was repaired lacks what was damaged.
  if (step > next) {
    gap_ = true;
    log_.damage = step == next + 1 ? fmt::format("step {} is missing", next)
                                   : fmt::format("steps {} to {} are missing", next, step - 1);
    return {};
  }
  if (step < next)
    return refusal(name_, fmt::format("step {}", step), fmt::format("{}, the next one", next));
  if (doubt_) return *doubt_;
  log_.hashes.push_back(hash);
  return {};
}

Status LogVisitor::source(std::span<const std::byte> bytes) {
  recording::CdrReader in(bytes);
  in.number<std::int32_t>(), in.number<std::uint32_t>(), in.text();
  const auto number = in.number<SourceId>();
  std::string source = in.text();
  const std::string where = fmt::format("{}: source {}", name_, log_.sources.size());
  Status named = number == kSimulation && source == kSimulationName
                     ? Status()
                     : check_source_name(where, source);
  const bool read = in.whole() && in.left() == 0 && named.ok();
  if (!read || number != log_.sources.size()) {
    const Error error = named.ok() ? refusal(where, fmt::format("the number {}", number),
                                             "whole messages, numbered one after another")
                                   : named.error();
    if (!read || number < log_.sources.size()) return error;
    doubt_ = error;
    return {};
  }
  log_.sources.push_back(std::move(source));
  return {};
}

Status LogVisitor::sample(StreamId stream, std::span<const std::byte> bytes) {
  const std::size_t index = log_.entries.size();
  const auto read = read_sample(log_.streams[stream].kind, bytes);
  if (!read) return refusal(name_, fmt::format("a part of sample {}", index), "whole samples");
  SampleLog::Entry entry{log_.steps(), read->sample};
  SampleHeader& header = entry.sample.header;
  header.stream = stream;
  if (log_.hashes.empty()) {
    doubt_ = refusal(name_, fmt::format("sample {} before the hash of the start", index),
                     "the hash first");
    return {};
  }
  if (header.source >= log_.sources.size()) {
    doubt_ =
        refusal(name_, fmt::format("sample {} of source {}", index, header.source),
                fmt::format("that of a source named before it, {} so far", log_.sources.size()));
    return {};
  }
  if (!plausible(header.captured_ns) || !plausible(header.arrived_ns))
    return refusal(
        name_,
        fmt::format("sample {} of {} and {} ns", index, header.captured_ns, header.arrived_ns),
        fmt::format("up to {} from 0", kMostTime_ns));
  if (!all_finite(entry.sample.payload))
    return refusal(name_,
                   fmt::format("a number that is not finite in sample {}, of {} at step {}", index,
                               log_.streams[stream].name, entry.step),
                   "finite numbers");
  log_.entries.push_back(entry);
  return {};
}

Result<SampleLog> LogVisitor::log(const recording::McapReport& report) {
  if (!known_) return unknown_run();
  if (gap_ && log_.hashes.empty())
    return failure(ErrorCode::kUnsupported, "{}: {}: it cannot be replayed", name_, log_.damage);
  if (doubt_ && !gap_) return *doubt_;
  if (log_.hashes.empty())
    return refusal(name_, "an end before the hash of the start", "one step at least");
  log_.whole = report.whole && !gap_;
  if (!gap_ && !report.damage.empty()) log_.damage = report.damage.front();
  // For a step that did not end.
  while (!log_.entries.empty() && log_.entries.back().step >= log_.steps()) log_.entries.pop_back();
  return std::move(log_);
}

}  // namespace

Result<SampleLog> parse_sample_log(recording::McapSource& source, const std::string& name) {
  LogVisitor visitor(name);
  NERITIC_TRY(const auto report, recording::read_mcap(source, name, visitor));
  return visitor.log(report);
}

Result<SampleLog> parse_sample_log(std::span<const std::byte> bytes, const std::string& name) {
  const auto source = recording::mcap_of(bytes);
  return parse_sample_log(*source, name);
}

Result<SampleLog> read_sample_log(const std::filesystem::path& path) {
  NERITIC_TRY(const auto source, recording::open_mcap(path));
  return parse_sample_log(*source, path.string());
}

}  // namespace neritic::testbed
