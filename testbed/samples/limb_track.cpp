#include "testbed/samples/limb_track.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/motion.hpp"
#include "testbed/samples/capture_times.hpp"
#include "testbed/samples/pose_track.hpp"

namespace neritic::testbed {

void LimbTrack::take(const BodyJoints& body, const SampleHeader& header, double hold_s,
                     std::uint64_t step) {
  const double since_s = seconds_between(base_captured_ns, header.captured_ns);
  const bool follows = taken > 0 && since_s >= 0.0 && since_s <= hold_s;
  for (std::size_t i = 0; i < diver::kJoints; ++i) newest[i] = glm::normalize(body.joints[i]);
  age_s = age_on_arrival_s(header);
  ++taken;
  taken_step = step;
  if (follows && since_s < kLeastInterval_s) return;
  rate_rad_s.fill(Vec3(0.0));
  for (std::size_t i = 0; follows && i < diver::kJoints; ++i) {
    const Vec3 rate = turning_rad_s(base[i], newest[i], since_s);
    if (glm::length(rate) <= kMostRate_rad_s) rate_rad_s[i] = rate;
  }
  interval_s = follows ? since_s : 0.0;
  base = newest;
  base_captured_ns = header.captured_ns;
}

diver::JointRotations LimbTrack::at(double since_arrival_s) const {
  const double ahead_s = age_s + std::min(since_arrival_s, std::max(kLeastAhead_s, interval_s));
  diver::JointRotations out;
  for (std::size_t i = 0; i < diver::kJoints; ++i)
    out[i] =
        predicted(Motion{{Vec3(0.0), newest[i]}, Vec3(0.0), rate_rad_s[i]}, ahead_s).pose.rotation;
  return out;
}

}  // namespace neritic::testbed
