// Any bytes as a log of inputs: an Error in one line, or a log that keeps the format's promises and
// is written as it was read.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/core/check.hpp"
#include "engine/sim/input_log.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto bytes = fuzz::as_bytes(data, size);
  const auto log = sim::parse_input_log(bytes, "fuzz.log");
  if (!log.ok()) {
    const std::string& message = log.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.log: ") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  NERITIC_CHECK(log->step_s > 0.0 && log->step_s <= sim::kMaxStep_s, "step {} s", log->step_s);
  NERITIC_CHECK(!log->hashes.empty() && !log->entries.empty() && log->entries[0].step == 0,
                "{} hashes, {} entries", log->hashes.size(), log->entries.size());
  for (std::size_t i = 1; i < log->entries.size(); ++i)
    NERITIC_CHECK(log->entries[i - 1].step < log->entries[i].step &&
                      log->entries[i].step < log->hashes.size(),
                  "entry {} of step {}", i, log->entries[i].step);
  NERITIC_CHECK(std::ranges::equal(sim::encode_input_log(*log), bytes), "{} bytes", size);
  return 0;
}
