// Any text as a recording of limbs, and as one of a jacket's buttons: an Error in one line, or
// rotations and buttons at any time.
#include <cmath>

#include "diver/button_recording.hpp"
#include "diver/jacket.hpp"
#include "diver/limb_recording.hpp"
#include "engine/core/check.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

void check_line(const std::string& message) {
  NERITIC_CHECK(message.starts_with("fuzz.csv") && message.find('\n') == message.npos, "{}",
                message);
}

void read_as_buttons(std::string_view text) {
  using namespace neritic;
  const auto read = diver::read_button_recording(text, "fuzz.csv");
  if (!read.ok()) return check_line(read.error().message);
  NERITIC_CHECK(!read->time_s.empty() && read->time_s.size() == read->buttons.size(), "{}",
                read->time_s.size());
  for (const double at_s : {-1e10, read->time_s.front(), read->time_s.back(), 1e10}) {
    const auto pressed = read->at(at_s);
    NERITIC_CHECK(pressed.has_value() == (at_s >= read->time_s.front()), "{}", at_s);
    NERITIC_CHECK(pressed.value_or(0) <= diver::kAllButtons, "{}", *pressed);
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_as_buttons(text);
  const auto limbs = diver::read_limb_recording(text, "fuzz.csv");
  if (!limbs.ok()) {
    check_line(limbs.error().message);
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
