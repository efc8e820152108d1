// The samples that a run used, by step, and the hash of its state after each step: enough to run it
// again and to see whether it went the same way. In memory; and as messages of a recording (MCAP,
// README.md), beside whatever else that holds:
//
//   metadata "neritic"        what was run: step_s, seed, first_step, scene, scene_hash, program
//   attachments               scene.toml: the scene's text; start.state: the state that a recording
//                             of mid-run begins with (saved_state.hpp)
//   /neritic/step             one a state, the start first: its hash
//   /neritic/source           a source's name, before its first sample; its number counts from 0
//   /diver/joints and so on   a sample that the step after the newest /neritic/step uses
//
// A run that was killed leaves a recording without its end: it reads up to its last whole step.
//
// Pure functions and plain values; any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/recording/mcap_out.hpp"
#include "engine/recording/mcap_reader.hpp"
#include "testbed/samples/stream_table.hpp"

namespace neritic::testbed {

struct SampleLog {
  struct Entry {
    std::uint64_t step = 0;  // that used it first; 0 is the recording's first
    Sample sample;
  };
  struct LoggedStream {
    std::string name;
    PayloadKind kind = PayloadKind::kEvent;
    bool operator==(const LoggedStream&) const = default;
  };
  double step_s = 0.0;
  std::uint64_t seed = 0;  // the scene's
  std::vector<LoggedStream> streams;
  std::vector<std::string> sources;  // by SourceId
  std::vector<Entry> entries;
  std::vector<std::uint64_t> hashes;   // one more than there are steps
  bool whole = true;                   // read from a file that has its end and all steps
  std::uint64_t first_step = 0;        // of the run, where the recording begins
  std::string scene_path, scene_text;  // empty: of no scene
  std::uint64_t scene_hash = 0;
  std::vector<std::byte> start_state;  // a saved state; empty: it begins at the scene's start
  std::string damage;                  // where the file is damaged, or what is missing: it is read
                                       // up to there

  std::uint64_t steps() const { return hashes.empty() ? 0 : hashes.size() - 1; }
};

std::vector<SampleLog::LoggedStream> logged_streams(const StreamTable& table);
// As ROS names topics: letters, digits, '_' and '/', no part that begins with a digit.
std::string topic_of(std::string_view stream);

// Writes a run's messages while it goes on.
class SampleLogWriter {
 public:
  // run: its entries, sources and hashes do not count. recorded_at_ns: since 1970, of runs on a
  // real clock. Borrows out.
  SampleLogWriter(recording::McapOut& out, const SampleLog& run,
                  std::optional<std::int64_t> recorded_at_ns = {});
  void source(std::string_view name);
  std::size_t sources() const { return sources_; }
  // A state: when it was due on the host's clock, which samples are stamped by.
  void step(std::uint64_t step, double time_s, TimeNs host_ns, std::uint64_t hash);
  // That the next step uses; or that the newest step gave. Preconditions: its source has been
  // named, and the start has its hash.
  void sample(const Sample& sample);
  // The scene's time when that was on the host's clock.
  std::int64_t scene_ns(TimeNs host_ns) const { return now_ns_ - (host_ns_ - host_ns); }
  // The scene's time of the newest step; before it of the log's first.
  std::int64_t now_ns() const { return now_ns_; }

 private:
  recording::McapOut& out_;
  std::vector<SampleLog::LoggedStream> streams_;
  std::vector<std::optional<std::uint16_t>> channels_;  // by stream
  std::vector<std::optional<std::uint16_t>> schemas_;   // by kind
  std::uint16_t step_channel_ = 0, source_channel_ = 0;
  std::size_t sources_ = 0;
  std::uint64_t step_ = 0;
  std::int64_t now_ns_ = 0, host_ns_ = 0;
  bool begun_ = false;
};

// Preconditions: at least the hash of the start; each entry of a step of the log.
std::string encode_sample_log(const SampleLog& log);
// The returned log keeps the format's promises, and every number is finite. name stands in
// messages.
Result<SampleLog> parse_sample_log(recording::McapSource& source, const std::string& name);
Result<SampleLog> parse_sample_log(std::span<const std::byte> bytes, const std::string& name);
// kBadInput if the log has samples of a stream that the table lacks.
Status check_streams(const SampleLog& log, const StreamTable& table, const std::string& name);
Status write_sample_log(const std::filesystem::path& path, const SampleLog& log);
Result<SampleLog> read_sample_log(const std::filesystem::path& path);

}  // namespace neritic::testbed
