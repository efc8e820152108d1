// Gaze from a .csv file. Pure functions of the text; any thread.
#pragma once

#include <optional>
#include <string_view>

#include "diver/gaze_events.hpp"

namespace neritic::diver {

struct GazeRecording {
  std::vector<GazeSample> samples;
  // Codes of a person who looked at the recording, where there is a column 'evt': 0 undefined, 1
  // fixation, 2 saccade, 3 after a saccade, 4 pursuit, 5 blink. One per sample.
  std::vector<int> marks;
};
// Columns: time (t_s, or a rate in a comment), then x_deg and y_deg (or x_rad, y_rad: angles on a
// screen, y up; of 90 degrees or more they are no direction, and refused), or dx, dy, dz (any
// direction, as of a headset in the world); 'status' or 'valid' 0, false or empty: the eye was not
// seen.
Result<GazeRecording> parse_gaze_csv(std::string_view text, const std::string& name,
                                     double rate_hz);

}  // namespace neritic::diver
