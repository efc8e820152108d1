#include "testbed/samples/sample_log.hpp"

#include <cmath>

#include "engine/core/files.hpp"
#include "engine/core/version.hpp"
#include "engine/recording/cdr.hpp"
#include "engine/recording/mcap_writer.hpp"
#include "engine/recording/ros_types.hpp"
#include "testbed/samples/recording_names.hpp"
#include "testbed/samples/sample_messages.hpp"

namespace neritic::testbed {
namespace {

// No sample is stamped so far ahead of the clock that it is by.
constexpr std::int64_t kFarAhead_ns = 1'000'000'000;

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

std::uint64_t stamp(std::int64_t ns) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
}

// "2026-11-26T11:30:00Z"
std::string utc(std::int64_t ns) {
  const auto seconds = static_cast<std::time_t>(ns / 1'000'000'000);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace

std::vector<SampleLog::LoggedStream> logged_streams(const StreamTable& table) {
  std::vector<SampleLog::LoggedStream> out;
  for (const Stream& stream : table.streams()) out.push_back({stream.name, stream.kind});
  return out;
}

std::string topic_of(std::string_view stream) {
  std::string topic = "/";
  for (const char c : stream) {
    const bool digit = c >= '0' && c <= '9';
    const bool good = digit || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '/';
    if (digit && topic.back() == '/') topic += '_';
    topic += good ? c : '_';
  }
  return topic;
}

SampleLogWriter::SampleLogWriter(recording::McapOut& out, const SampleLog& run,
                                 std::optional<std::int64_t> recorded_at_ns)
    : out_(out),
      streams_(run.streams),
      channels_(run.streams.size()),
      schemas_(kPayloadKinds),
      now_ns_(std::llround(1e9 * static_cast<double>(run.first_step) * run.step_s)) {
  recording::McapMetadata facts{kRunMetadata,
                                {{"format", kRunFormat},
                                 {"program", std::string(program_version())},
                                 {"step_s", fmt::format("{}", run.step_s)},
                                 {"seed", fmt::format("{}", run.seed)},
                                 {"first_step", fmt::format("{}", run.first_step)}}};
  if (!run.scene_path.empty()) {
    facts.words["scene"] = run.scene_path;
    facts.words["scene_hash"] = fmt::format("{:016x}", run.scene_hash);
  }
  if (recorded_at_ns) {
    facts.words["recorded_at"] = utc(*recorded_at_ns);
    facts.words["recorded_at_ns"] = fmt::format("{}", *recorded_at_ns);
  }
  out_.metadata(facts);
  const std::uint64_t at = stamp(recorded_at_ns.value_or(0));
  if (!run.scene_text.empty())
    out_.attachment({0, at, kSceneAttachment, "application/toml", bytes_of(run.scene_text)});
  if (!run.start_state.empty())
    out_.attachment({0, at, kStateAttachment, "application/octet-stream", run.start_state});
  // Again: a damaged place leaves one of the two, without which nothing can be replayed.
  out_.metadata(facts);
  const auto channel = [&](const char* topic, const char* type, const char* lines) {
    return out_.add_channel(
        {out_.add_schema(recording::own_schema(type, lines)), topic, "cdr", {}});
  };
  step_channel_ = channel(kStepTopic, kStepType, kStepLines);
  source_channel_ = channel(kSourceTopic, kSourceType, kSourceLines);
}

void SampleLogWriter::source(std::string_view name) {
  std::string bytes;
  recording::CdrWriter cdr(bytes);
  cdr.header(now_ns_, "");
  cdr.number(static_cast<SourceId>(sources_));
  cdr.text(name);
  out_.message({source_channel_, static_cast<std::uint32_t>(sources_), stamp(now_ns_),
                stamp(now_ns_), bytes_of(bytes)});
  ++sources_;
}

void SampleLogWriter::step(std::uint64_t step, double time_s, TimeNs host_ns, std::uint64_t hash) {
  begun_ = true;
  step_ = step;
  now_ns_ = std::llround(time_s * 1e9);
  host_ns_ = host_ns;
  std::string bytes;
  recording::CdrWriter cdr(bytes);
  cdr.header(now_ns_, "");
  cdr.number(step);
  cdr.number(time_s);
  cdr.number(hash);
  out_.message({step_channel_, static_cast<std::uint32_t>(step), stamp(now_ns_), stamp(now_ns_),
                bytes_of(bytes)});
}

void SampleLogWriter::sample(const Sample& sample) {
  const SampleHeader& header = sample.header;
  NERITIC_CHECK(header.source < sources_ && begun_, "source {} of {}", header.source, sources_);
  auto& channel = channels_.at(header.stream);
  if (!channel) {
    const PayloadKind kind = sample.kind();
    auto& schema = schemas_.at(static_cast<std::size_t>(kind));
    if (!schema) schema = out_.add_schema(sample_schema(kind));
    const std::string& name = streams_[header.stream].name;
    channel = out_.add_channel({*schema,
                                topic_of(name),
                                "cdr",
                                {{kStreamKey, name},
                                 {kKindKey, std::string(name_of(kind))},
                                 {kWayKey, enters(kind) ? kIn : kOut}}});
  }
  // Before the first step of a run at the host's pace no step says yet what the host's clock
  // showed: such a sample lies its age before the start.
  const bool unknown = host_ns_ == now_ns_ && header.captured_ns > now_ns_ + kFarAhead_ns;
  const std::int64_t captured_ns =
      unknown ? now_ns_ - std::max<TimeNs>(header.arrived_ns - header.captured_ns, 0)
              : scene_ns(header.captured_ns);
  const std::string bytes = sample_message(sample, {step_, captured_ns});
  out_.message({*channel, static_cast<std::uint32_t>(header.sequence), stamp(now_ns_),
                stamp(captured_ns), bytes_of(bytes)});
}

std::string encode_sample_log(const SampleLog& log) {
  recording::McapWriter file("ros2", program_version());
  SampleLogWriter out(file, log);
  for (const std::string& source : log.sources) out.source(source);
  std::size_t next = 0;
  for (std::uint64_t i = 0; i < log.hashes.size(); ++i) {
    const std::uint64_t step = log.first_step + i;
    const double time_s = static_cast<double>(step) * log.step_s;
    out.step(step, time_s, std::llround(time_s * 1e9), log.hashes[i]);
    for (; next < log.entries.size() && log.entries[next].step == i; ++next)
      out.sample(log.entries[next].sample);
  }
  NERITIC_CHECK(next == log.entries.size(), "entry {} is of step {} of {}", next,
                log.entries[next].step, log.steps());
  file.finish();
  return file.take();
}

Status check_streams(const SampleLog& log, const StreamTable& table, const std::string& name) {
  std::vector<bool> used(log.streams.size());
  for (const SampleLog::Entry& entry : log.entries) used[entry.sample.header.stream] = true;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const auto found = table.find(log.streams[i].name);
    if (!found || table[*found].kind != log.streams[i].kind)
      return bad_input("{}: samples of {} found; accepted: of the scene's streams", name,
                       log.streams[i].name);
  }
  return {};
}

Status write_sample_log(const std::filesystem::path& path, const SampleLog& log) {
  return write_text(path, encode_sample_log(log));
}

}  // namespace neritic::testbed
