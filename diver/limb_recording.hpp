// Limbs as a motion suit recorded them or a program wrote them: joint angles over time, out of a
// table. Any thread.
//
// The form: .csv; a column t_s (or another time of physio_csv.hpp), and of each joint that moves
// SEGMENT_x_deg, SEGMENT_y_deg, SEGMENT_z_deg of the segment that hangs on it (segments.hpp: twist,
// flexion, abduction); those not named are 0. Times rise, angles are numbers from -360 to 360.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diver/segments.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

struct LimbRecording {
  std::vector<double> time_s;  // from 0, rising; at least two
  std::vector<JointRotations> joints;

  double length_s() const { return time_s.back(); }
  // The shortest turn between two samples; the first before, the last after them, or again from the
  // first where it repeats.
  JointRotations at(double time_s, bool repeat) const;
};

// name stands in messages. Errors name what was found and is accepted.
Result<LimbRecording> read_limb_recording(std::string_view text, const std::string& name);

}  // namespace neritic::diver
