// The inputs of a run by step, and the hash of its state after each: enough to run it again and to
// see whether it went the same way. In memory, and as a file:
//
//   all little-endian, nothing aligned
//   8 bytes  "NRTCLOG1"
//   f64      step_s             u64 seed        u64 steps        u64 entries        u32 fields
//   fields:  1 byte type as Python's struct has it (d f i I q Q), u8 length, name in printable
//   ASCII entries: u64 step, ascending, the first 0; then the fields' numbers: these inputs from
//   that step hashes:  u64 each, of the state at step 0, 1, ... steps
//
// Pure functions and plain values; any thread.
#pragma once

#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/core/result.hpp"
#include "engine/sim/fields.hpp"

namespace neritic::sim {

// The longest step a simulation takes, in seconds.
inline constexpr double kMaxStep_s = 1.0;

template <class Inputs>
struct InputLog {
  struct Entry {
    std::uint64_t step = 0;
    Inputs inputs{};
  };
  double step_s = 0.0;
  std::uint64_t seed = 0;        // the run's, for whoever sets the run up again
  std::uint64_t first_step = 0;  // where it begins: not 0 after a restored state
  std::vector<Entry> entries;
  std::vector<std::uint64_t> hashes;  // one more than there are steps

  std::uint64_t steps() const { return hashes.empty() ? 0 : hashes.size() - 1; }
};

// The same without the type of its inputs: what a file holds.
struct LogField {
  char type = 'd';
  std::string name;
  bool operator==(const LogField&) const = default;
};
struct RawInputLog {
  struct Entry {
    std::uint64_t step = 0;
    std::vector<std::byte> numbers;
  };
  double step_s = 0.0;
  std::uint64_t seed = 0;
  std::vector<LogField> fields;
  std::vector<Entry> entries;
  std::vector<std::uint64_t> hashes;
};

std::vector<std::byte> encode_input_log(const RawInputLog& log);
// Every promise of the format holds in what is returned, and every number is finite. name stands in
// messages.
Result<RawInputLog> parse_input_log(std::span<const std::byte> bytes, const std::string& name);
// kBadInput where the log's fields are not these.
Status check_log_fields(const RawInputLog& log, std::span<const LogField> expected,
                        const std::string& name);
Status write_raw_input_log(const std::filesystem::path& path, const RawInputLog& log);
Result<RawInputLog> read_raw_input_log(const std::filesystem::path& path);

template <Scalar T>
constexpr char log_type() {
  if constexpr (std::same_as<T, double>) return 'd';
  if constexpr (std::same_as<T, float>) return 'f';
  if constexpr (std::same_as<T, std::int32_t>) return 'i';
  if constexpr (std::same_as<T, std::uint32_t>) return 'I';
  if constexpr (std::same_as<T, std::int64_t>) return 'q';
  return 'Q';
}

template <class Inputs>
std::vector<LogField> log_fields(const Inputs& inputs) {
  std::vector<LogField> fields;
  for_each_named_scalar(inputs, [&](const std::string& name, const auto& scalar) {
    fields.push_back({log_type<std::remove_cvref_t<decltype(scalar)>>(), name});
  });
  return fields;
}

// Precondition: the log begins at step 0.
template <class Inputs>
Status write_input_log(const std::filesystem::path& path, const InputLog<Inputs>& log) {
  NERITIC_CHECK(log.first_step == 0 && !log.entries.empty(), "the log begins at step {}",
                log.first_step);
  RawInputLog raw{log.step_s, log.seed, log_fields(log.entries.front().inputs), {}, log.hashes};
  for (const auto& entry : log.entries) {
    auto& out = raw.entries.emplace_back();
    out.step = entry.step;
    for_each_scalar(entry.inputs, [&](const auto& scalar) {
      const auto bytes = std::as_bytes(std::span(&scalar, 1));
      out.numbers.insert(out.numbers.end(), bytes.begin(), bytes.end());
    });
  }
  return write_raw_input_log(path, raw);
}

// like: inputs of the layout that the log must have.
template <class Inputs>
Result<InputLog<Inputs>> read_input_log(const std::filesystem::path& path,
                                        const Inputs& like = Inputs{}) {
  NERITIC_TRY(const RawInputLog raw, read_raw_input_log(path));
  NERITIC_TRY_STATUS(check_log_fields(raw, log_fields(like), path.string()));
  InputLog<Inputs> log{raw.step_s, raw.seed, 0, {}, raw.hashes};
  for (const RawInputLog::Entry& entry : raw.entries) {
    auto& out = log.entries.emplace_back(entry.step, like);
    std::size_t at = 0;
    for_each_scalar(out.inputs, [&](auto& scalar) {
      std::memcpy(&scalar, entry.numbers.data() + at, sizeof scalar);
      at += sizeof scalar;
    });
  }
  return log;
}

}  // namespace neritic::sim
