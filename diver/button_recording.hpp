// Presses of the jacket's buttons over time, read from a table. Any thread.
//
// The form: .csv; a column t_s (or another time of physio_csv.hpp) and any of inflate, deflate,
// dump: 1 pressed, 0 not, each from its row's time up to the next one's. Buttons not named are
// never pressed; other columns are refused. Times rise, and count from the scene's start.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::diver {

struct ButtonRecording {
  std::vector<double> time_s;          // rising; at least one
  std::vector<std::uint64_t> buttons;  // bits, jacket.hpp

  // Nothing before the first row; the last row's after it.
  std::optional<std::uint64_t> at(double time_s) const;
};

// name stands in messages. Errors name what was found and is accepted.
Result<ButtonRecording> read_button_recording(std::string_view text, const std::string& name);

}  // namespace neritic::diver
