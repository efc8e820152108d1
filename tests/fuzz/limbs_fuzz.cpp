// Any text as a recording of limbs: an Error in one line, or rotations at any time.
#include <cmath>

#include "diver/limb_recording.hpp"
#include "engine/core/check.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto limbs =
      diver::read_limb_recording({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
  if (!limbs.ok()) {
    const std::string& message = limbs.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.csv") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  NERITIC_CHECK(limbs->joints.size() == limbs->time_s.size() && limbs->joints.size() >= 2, "{}",
                limbs->joints.size());
  NERITIC_CHECK(limbs->time_s.front() == 0.0 && std::isfinite(limbs->length_s()), "{} {}",
                limbs->time_s.front(), limbs->length_s());
  const double length_s = limbs->length_s();
  for (const double at_s : {-1.0, 0.0, 0.37 * length_s, length_s, 2.6 * length_s, 1e9})
    for (const bool repeat : {false, true})
      for (const Quat& q : limbs->at(at_s, repeat))
        NERITIC_CHECK(std::abs(glm::length(q) - 1.0) < 1e-6, "{} at {} s", glm::length(q), at_s);
  return 0;
}
