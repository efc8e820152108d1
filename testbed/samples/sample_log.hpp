// The samples that a run used, by step, and the hash of its state after each step: enough to run it
// again and to see whether it went the same way. In memory, and as a file:
//
//   all little-endian, nothing aligned; a name is a u8 length and printable ASCII
//   8 bytes  "NRTCLOG3"
//   f64 step_s   u64 seed   u32 kinds   u32 streams
//   kinds:    name, u32 fields; each field 1 byte type as Python's struct has it (d f i I q Q),
//             name
//   streams:  name, u32 kind (its place above)
//   records, each after a byte that says which it is, in the order of the run:
//     'N'  a source: name; its number is its place among these
//     'H'  u64 hash of the state at the start, then after each step
//     'S'  a sample that the next step uses: u32 stream, u32 source, u64 sequence,
//          i64 captured_ns, i64 arrived_ns, then the fields' numbers
//     'E'  the end: u64 steps, u64 samples that they used
//
// A run that was killed leaves a log without its end: it reads up to its last whole step.
//
// Pure functions and plain values; any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "testbed/samples/stream_table.hpp"

namespace neritic::testbed {

struct SampleLog {
  struct Entry {
    std::uint64_t step = 0;  // that used it first
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
  std::vector<std::uint64_t> hashes;  // one more than there are steps
  bool whole = true;                  // read from a file that has its end

  std::uint64_t steps() const { return hashes.empty() ? 0 : hashes.size() - 1; }
};

std::vector<SampleLog::LoggedStream> logged_streams(const StreamTable& table);

// Makes the bytes of a log while its run goes on.
class SampleLogWriter {
 public:
  SampleLogWriter(double step_s, std::uint64_t seed,
                  const std::vector<SampleLog::LoggedStream>& streams);
  void source(std::string_view name);
  std::size_t sources() const { return sources_; }
  // Preconditions: its source has been named, and the start has its hash.
  void sample(const Sample& sample);
  void hash(std::uint64_t hash);
  void end();
  // What was made since the last call.
  std::string take() { return std::exchange(bytes_, {}); }

 private:
  std::string bytes_;
  std::size_t sources_ = 0;
  std::uint64_t hashes_ = 0, samples_ = 0, used_ = 0;  // used_: by steps that ended
};

// Preconditions: at least the hash of the start; each entry of a step of the log.
std::string encode_sample_log(const SampleLog& log);
// The returned log keeps the format's promises, and every number is finite. name stands in
// messages.
Result<SampleLog> parse_sample_log(std::span<const std::byte> bytes, const std::string& name);
// kBadInput if the log has samples of a stream that the table lacks.
Status check_streams(const SampleLog& log, const StreamTable& table, const std::string& name);
Status write_sample_log(const std::filesystem::path& path, const SampleLog& log);
Result<SampleLog> read_sample_log(const std::filesystem::path& path);

}  // namespace neritic::testbed
