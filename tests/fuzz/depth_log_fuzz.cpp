// Any bytes as a log of depths: an Error in one line, or samples that a dive computer survives.
#include "diver/deco_live.hpp"
#include "diver/depth_log.hpp"
#include "engine/core/check.hpp"
#include "engine/sim/fields.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto log = diver::read_depth_log({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  if (!log.ok()) {
    const std::string& message = log.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.csv") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  diver::DiveComputerSettings settings;
  for (const diver::GasMix& mix : log->gases)
    settings.gases.push_back({mix, 3.0, diver::GasRole::kDeco});
  if (settings.gases.size() > 32) return 0;  // of a plan
  const auto computer = diver::DiveComputer::create(settings);
  NERITIC_CHECK(computer.ok(), "{}", computer.error().message);
  diver::DiveComputerState state = computer->start();
  double time_s = log->samples.front().time_s;
  for (const diver::DepthSample& sample : log->samples) {
    NERITIC_CHECK(sample.time_s >= time_s, "{} after {}", sample.time_s, time_s);
    state = computer->step(state, {sample.depth_m, sample.gas}, sample.time_s - time_s);
    time_s = sample.time_s;
  }
  NERITIC_CHECK(state.refused == 0, "{} samples refused of {}", state.refused, log->samples.size());
  NERITIC_CHECK(sim::all_finite(state), "not finite after {} samples", log->samples.size());
  return 0;
}
