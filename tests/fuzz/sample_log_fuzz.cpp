// Any bytes as a log of samples: an Error in one line, or a log that keeps the format's promises
// and is written as it was read.
#include <algorithm>

#include "engine/core/check.hpp"
#include "testbed/samples/sample_log.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto bytes = fuzz::as_bytes(data, size);
  const auto log = testbed::parse_sample_log(bytes, "fuzz.log");
  if (!log.ok()) {
    const std::string& message = log.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.log: ") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  NERITIC_CHECK(log->step_s > 0.0 && !log->hashes.empty(), "step {} s, {} hashes", log->step_s,
                log->hashes.size());
  std::uint64_t last_step = 0;
  for (const auto& entry : log->entries) {
    NERITIC_CHECK(entry.step >= last_step && entry.step < log->steps(), "step {}", entry.step);
    last_step = entry.step;
    const testbed::SampleHeader& header = entry.sample.header;
    NERITIC_CHECK(header.stream < log->streams.size() && header.source < log->sources.size() &&
                      log->streams[header.stream].kind == entry.sample.kind() &&
                      testbed::all_finite(entry.sample.payload),
                  "stream {}, source {}", header.stream, header.source);
  }
  // Kinds that no stream has are read and not written again.
  const std::string written = testbed::encode_sample_log(*log);
  const auto again = testbed::parse_sample_log(std::as_bytes(std::span(written)), "fuzz.log");
  NERITIC_CHECK(again.ok() && testbed::encode_sample_log(*again) == written, "{} bytes", size);
  return 0;
}
