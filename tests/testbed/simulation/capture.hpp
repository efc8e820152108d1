// A prop that a motion capture moves.
#pragma once

#include "tests/testbed/simulation/devices.hpp"

namespace neritic::testbed {

inline std::string prop_text(const std::string& keys,
                             const std::string& place = "position_m = [0, -5, 0]\n") {
  return std::string(kStillWater) +
         "[[objects]]\nname = \"prop\"\nshape = \"box\"\nclass = \"rock\"\n"
         "size_m = [1, 1, 1]\n" +
         place + keys;
}

inline ObjectPose at(const Vec3& position_m, const Quat& rotation = Quat(1, 0, 0, 0)) {
  return {.world_from_object = {position_m, rotation}};
}

inline const ObjectState& prop(const TestDive& dive) {
  return dive.state().objects()[0];
}

// Round a circle of 2 m, a quarter of it a second: 3.1 m/s.
inline constexpr double kRound_rad_s = kPi / 2.0;
inline Motion circling(double t) {
  const double s = std::sin(kRound_rad_s * t), c = std::cos(kRound_rad_s * t);
  return {{{2.0 * c, -5.0, -2.0 * s}, glm::angleAxis(kRound_rad_s * t, Vec3(0, 1, 0))},
          Vec3(-s, 0.0, -c) * (2.0 * kRound_rad_s),
          Vec3(0.0, kRound_rad_s, 0.0)};
}

// A motion capture in step with the physics' clock; it sends from the step before on.
struct Capture : Device {
  Capture(SampleInbox& inbox, const StreamTable& streams)
      : Device(inbox, streams, "mocap", "prop/pose") {}
  explicit Capture(const TestDive& dive)
      : Capture(dive.simulation->inbox(), dive.world->streams()) {}
  SampleVerdict see(double captured_s, const ObjectPose& pose, double latency_s = 0.0) {
    return inbox.push({{stream, source, sequence++, std::llround(1e9 * captured_s),
                        std::llround(1e9 * (captured_s + latency_s))},
                       pose});
  }
};

}  // namespace neritic::testbed
