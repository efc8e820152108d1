// Any bytes as a .wav: an Error in one line, or samples that are numbers or missing.
#include <cmath>

#include "diver/physio_wav.hpp"
#include "engine/core/check.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  for (const std::uint32_t channel : {0u, 1u}) {
    const auto sound = diver::parse_wav(fuzz::as_bytes(data, size), "fuzz.wav", channel);
    if (!sound.ok()) {
      const std::string& message = sound.error().message;
      NERITIC_CHECK(message.starts_with("fuzz.wav: ") && message.find('\n') == message.npos, "{}",
                    message);
      continue;
    }
    NERITIC_CHECK(!sound->samples.empty() && sound->samples.size() <= size, "{}",
                  sound->samples.size());
    NERITIC_CHECK(sound->rate_hz >= 1.0 && sound->rate_hz <= diver::kMostRate_hz, "{}",
                  sound->rate_hz);
    for (const double s : sound->samples) NERITIC_CHECK(!std::isinf(s), "{}", s);
  }
  return 0;
}
