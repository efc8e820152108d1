// Any bytes as a recording: an Error in one line, or what reads of it, which keeps the format's
// promises. Its messages are read by their schemas; a copy of what is good is whole; a log of
// samples is written as it was read.
#include <algorithm>
#include <map>

#include "engine/core/check.hpp"
#include "engine/recording/mcap_copy.hpp"
#include "engine/recording/mcap_writer.hpp"
#include "engine/recording/ros_message.hpp"
#include "testbed/samples/sample_log.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

using namespace neritic;
using namespace neritic::recording;

void one_line(const Error& error) {
  NERITIC_CHECK(error.message.find('\n') == error.message.npos, "{}", error.message);
}

// Reads each message by its schema.
class Decoding final : public McapVisitor {
 public:
  Status schema(std::uint16_t id, const McapSchema& schema) override {
    auto type = RosMessage::parse(schema);
    if (type.ok())
      types_.emplace(id, std::move(*type));
    else
      one_line(type.error());
    return {};
  }
  Status channel(std::uint16_t id, const McapChannel& channel) override {
    schema_of_[id] = channel.schema;
    return {};
  }
  Status message(const McapMessage& message) override {
    const auto type = types_.find(schema_of_.at(message.channel));
    if (type == types_.end()) return {};
    const auto values = type->second.read(message.data);
    NERITIC_CHECK(!values || values->size() == type->second.columns().size(), "{} values",
                  values->size());
    return {};
  }

 private:
  std::map<std::uint16_t, RosMessage> types_;
  std::map<std::uint16_t, std::uint16_t> schema_of_;
};

void check_log(const testbed::SampleLog& log) {
  NERITIC_CHECK(log.step_s > 0.0 && !log.hashes.empty(), "step {} s, {} hashes", log.step_s,
                log.hashes.size());
  std::uint64_t last_step = 0;
  for (const auto& entry : log.entries) {
    NERITIC_CHECK(entry.step >= last_step && entry.step < log.steps(), "step {}", entry.step);
    last_step = entry.step;
    const testbed::SampleHeader& header = entry.sample.header;
    NERITIC_CHECK(header.stream < log.streams.size() && header.source < log.sources.size() &&
                      log.streams[header.stream].kind == entry.sample.kind() &&
                      testbed::all_finite(entry.sample.payload),
                  "stream {}, source {}", header.stream, header.source);
  }
  const std::string written = testbed::encode_sample_log(log);
  const auto again = testbed::parse_sample_log(std::as_bytes(std::span(written)), "fuzz.mcap");
  NERITIC_CHECK(again.ok() && again->whole && testbed::encode_sample_log(*again) == written,
                "{} bytes", written.size());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = fuzz::as_bytes(data, size);
  const auto source = mcap_of(bytes);
  Decoding decoding;
  const auto report = read_mcap(*source, "fuzz.mcap", decoding, AfterDamage::kGoOn);
  if (!report.ok()) {
    one_line(report.error());
    return 0;
  }
  McapWriter writer("ros2", "fuzz", 0);
  McapCopy copy(writer);
  NERITIC_CHECK(read_mcap(*source, "fuzz.mcap", copy, AfterDamage::kGoOn).ok(), "{} bytes", size);
  writer.finish();
  const std::string copied = writer.take();
  const auto copy_source = mcap_of(std::as_bytes(std::span(copied)));
  McapVisitor nobody;
  const auto whole = read_mcap(*copy_source, "copy.mcap", nobody);
  NERITIC_CHECK(whole.ok() && whole->whole && whole->messages == report->messages, "{} of {}",
                whole->messages, report->messages);

  const auto log = testbed::parse_sample_log(bytes, "fuzz.mcap");
  if (log.ok())
    check_log(*log);
  else
    one_line(log.error());
  return 0;
}
