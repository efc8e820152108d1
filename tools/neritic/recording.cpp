// `neritic recording info|check|repair|export FILE`: what a recording holds, whether it is whole, a
// whole copy of a damaged one, and its messages as tables, arrays, sound and pictures.
#include <nlohmann/json.hpp>

#include "engine/core/growing_file.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/recording/mcap_copy.hpp"
#include "testbed/samples/sample_log.hpp"
#include "tools/common/outputs.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/recording_export.hpp"

namespace neritic::tools {
namespace {

using recording::McapReport;

constexpr std::string_view kNoReplay = ": it cannot be replayed";

struct Topic {
  std::string name, type;
  std::uint64_t messages = 0, bytes = 0;
  std::uint64_t first_ns = 0, last_ns = 0;
  double rate_hz() const {
    const double seconds = static_cast<double>(last_ns - first_ns) * 1e-9;
    return messages > 1 && seconds > 0.0 ? static_cast<double>(messages - 1) / seconds : 0.0;
  }
};

class FactsVisitor final : public recording::McapVisitor {
 public:
  Status header(const std::string& of_profile, const std::string& of_library) override {
    profile = of_profile, library = of_library;
    return {};
  }
  Status schema(std::uint16_t id, const recording::McapSchema& schema) override {
    types_[id] = schema.name;
    return {};
  }
  Status channel(std::uint16_t id, const recording::McapChannel& channel) override {
    at_[id] = topics.size();
    topics.push_back({channel.topic, types_[channel.schema], 0, 0, 0, 0});
    return {};
  }
  Status message(const recording::McapMessage& message) override {
    Topic& topic = topics[at_.at(message.channel)];
    if (topic.messages++ == 0) topic.first_ns = message.log_ns;
    topic.last_ns = message.log_ns;
    topic.bytes += message.data.size();
    return {};
  }
  Status attachment(const recording::McapAttachment& attachment) override {
    attachments.emplace_back(attachment.name, attachment.data.size());
    return {};
  }
  Status metadata(const recording::McapMetadata& metadata) override {
    for (const auto& [key, value] : metadata.words) words.emplace(key, value);
    return {};
  }

  std::string profile, library;
  std::vector<Topic> topics;
  std::vector<std::pair<std::string, std::size_t>> attachments;
  recording::Words words;

 private:
  std::map<std::uint16_t, std::string> types_;
  std::map<std::uint16_t, std::size_t> at_;
};

std::string state_words(const McapReport& report) {
  if (report.whole) return "whole";
  if (report.damages > 0)
    return fmt::format("damaged: {}{}", report.damage.front(),
                       report.damages > 1 ? fmt::format(" and {} more", report.damages - 1) : "");
  return "cut off: it has no end";
}

Result<std::string> info(const RecordingFlags& flags) {
  NERITIC_TRY(const auto source, recording::open_mcap(flags.file));
  FactsVisitor facts;
  NERITIC_TRY(const McapReport report,
              recording::read_mcap(*source, flags.file, facts, recording::AfterDamage::kGoOn));
  const double seconds = static_cast<double>(report.last_ns - report.first_ns) * 1e-9;
  if (flags.json) {
    nlohmann::json json{{"file", flags.file},       {"state", state_words(report)},
                        {"whole", report.whole},    {"profile", facts.profile},
                        {"library", facts.library}, {"bytes", report.size_bytes},
                        {"chunks", report.chunks},  {"unpacked_bytes", report.unpacked_bytes},
                        {"seconds", seconds},       {"messages", report.messages},
                        {"run", facts.words}};
    json["topics"] = nlohmann::json::array();
    for (const Topic& topic : facts.topics)
      json["topics"].push_back({{"topic", topic.name},
                                {"type", topic.type},
                                {"messages", topic.messages},
                                {"bytes", topic.bytes},
                                {"rate_hz", topic.rate_hz()}});
    json["attachments"] = nlohmann::json::array();
    for (const auto& [name, bytes] : facts.attachments)
      json["attachments"].push_back({{"name", name}, {"bytes", bytes}});
    return json_text(json);
  }
  std::string text = fmt::format(
      "{}: {}\n{:.3f} s, {} messages in {} chunks, {:.2f} MB ({:.1f} times packed), by {}\n",
      flags.file, state_words(report), seconds, report.messages, report.chunks,
      static_cast<double>(report.size_bytes) * 1e-6,
      static_cast<double>(report.unpacked_bytes) /
          static_cast<double>(std::max<std::uint64_t>(report.size_bytes, 1)),
      printable(facts.library));
  for (const auto& [key, value] : facts.words)
    text += fmt::format("  {} = {}\n", printable(key), printable(value, 200));
  for (const auto& [name, bytes] : facts.attachments)
    text += fmt::format("  attached: {}, {} bytes\n", printable(name), bytes);
  for (const Topic& topic : facts.topics)
    text += fmt::format("{:>9} {:8.2f} Hz  {}  {}\n", topic.messages, topic.rate_hz(),
                        printable(topic.name), printable(topic.type));
  text.pop_back();
  return text;
}

// How many steps can be replayed; else why none can, and what else can be done.
std::string steps_words(const Result<testbed::SampleLog>& log, const std::string& file) {
  if (log.ok()) return fmt::format(", {} steps to replay", log->steps());
  std::string why = log.error().message;
  if (why.starts_with(file + ": ")) why.erase(0, file.size() + 2);
  if (why.ends_with(kNoReplay)) why.resize(why.size() - kNoReplay.size());
  return fmt::format("; {}{}, only exported", why, kNoReplay);
}

Result<std::string> check(const RecordingFlags& flags) {
  NERITIC_TRY(const auto source, recording::open_mcap(flags.file));
  recording::McapVisitor nobody;
  NERITIC_TRY(const McapReport report,
              recording::read_mcap(*source, flags.file, nobody, recording::AfterDamage::kGoOn));
  const auto log = testbed::read_sample_log(flags.file);
  const std::string steps = steps_words(log, flags.file);
  if (report.whole && !(log.ok() && log->whole))
    return failure(ErrorCode::kUnsupported, "{}: {}{} chunks and {} messages are good{}",
                   flags.file, log.ok() ? log->damage + "; " : "", report.chunks, report.messages,
                   steps);
  if (report.whole)
    return fmt::format("{}: whole; {} chunks with right CRCs and indexes, {} messages{}",
                       flags.file, report.chunks, report.messages, steps);
  std::string lines;
  for (const std::string& damage : report.damage) lines += "; " + damage;
  return failure(
      ErrorCode::kUnsupported, "{}: {}{}; {} chunks and {} messages are good{}{}", flags.file,
      report.damages > 0 ? "damaged" : "cut off: it has no end", lines, report.chunks,
      report.messages, steps,
      report.messages > 0 ? "; `neritic recording repair` makes a whole file of them" : "");
}

Result<std::string> repair(const RecordingFlags& flags) {
  if (flags.out.empty()) return refusal("--out", "none", "the name of the whole file (.mcap)");
  NERITIC_TRY_STATUS(check_output_file("--out", flags.out.string()));
  std::error_code ignored;
  if (std::filesystem::equivalent(flags.file, flags.out, ignored))
    return refusal("--out", "the damaged file itself", "another name");
  if (std::filesystem::is_regular_file(flags.out, ignored))
    return refusal("--out", printable(flags.out.string()) + ", which is there already",
                   "another name");
  // While it is written a file has the name of a killed run's recording, which may be there.
  std::filesystem::path made = flags.out;
  if (!std::filesystem::exists(flags.out, ignored)) made += ".repaired";
  NERITIC_TRY(const McapReport report, recording::repair_mcap(flags.file, made));
  if (made != flags.out) {
    std::error_code error;
    std::filesystem::rename(made, flags.out, error);
    if (error)
      return failure(ErrorCode::kIo, "{}: cannot be written: {}", flags.out.string(),
                     error.message());
  }
  const std::string out = flags.out.string();
  return fmt::format("{}: {} messages of {} chunks{}; {}", out, report.messages, report.chunks,
                     steps_words(testbed::read_sample_log(flags.out), out),
                     report.damages > 0
                         ? fmt::format("{} damaged places are left out", report.damages)
                     : report.whole ? "the file was whole"
                                    : "the file had no end");
}

}  // namespace

Result<std::string> run_recording(const RecordingFlags& flags) {
  if (flags.what == "info") return info(flags);
  if (flags.what == "check") return check(flags);
  if (flags.what == "repair") return repair(flags);
  if (flags.what == "export") return export_recording(flags);
  return refusal("recording", fmt::format("'{}'", printable(flags.what)),
                 "info, check, repair, export");
}

}  // namespace neritic::tools
