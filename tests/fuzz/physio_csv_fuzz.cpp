// Any text as a .csv of a diver's signals: an Error in one line, or evenly spaced samples, and gaze
// that the event finder takes.
#include <cmath>
#include <string_view>

#include "diver/gaze_csv.hpp"
#include "diver/physio_csv.hpp"
#include "engine/core/check.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

void check_csv_message(const std::string& message) {
  NERITIC_CHECK(message.starts_with("fuzz.csv:") && message.find('\n') == message.npos, "{}",
                message);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  // A leap of the clock is filled up with missing samples: this long is enough to see.
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto recording = diver::parse_csv(text, "fuzz.csv", {});
  if (recording.ok()) {
    NERITIC_CHECK(recording->samples.size() <= diver::kMostSamples, "{}",
                  recording->samples.size());
    NERITIC_CHECK(recording->rate_hz > 0.0 && std::isfinite(recording->start_s), "{}",
                  recording->rate_hz);
    for (const double s : recording->samples) NERITIC_CHECK(!std::isinf(s), "{}", s);
  } else {
    check_csv_message(recording.error().message);
  }
  const auto gaze = diver::parse_gaze_csv(text, "fuzz.csv", 0.0);
  if (!gaze.ok()) {
    check_csv_message(gaze.error().message);
    return 0;
  }
  const auto events = diver::find_gaze_events(gaze->samples, {});
  NERITIC_CHECK(events.classes.size() == gaze->samples.size(), "{} {}", events.classes.size(),
                gaze->samples.size());
  for (const auto& fixation : events.fixations)
    NERITIC_CHECK(is_finite(fixation.direction) && fixation.end_s >= fixation.start_s, "{}",
                  fixation.start_s);
  return 0;
}
