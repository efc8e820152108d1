// The newest posture that a source told of a diver who swims elsewhere, and the limbs' motion after
// it: each joint goes on turning at its rate between the newest two postures, by their capture
// times. Plain bytes; a step's input.
#pragma once

#include "testbed/samples/sample.hpp"

namespace neritic::testbed {

struct LimbTrack {
  // Postures captured closer together than this say where the limbs are, not how fast they turn.
  static constexpr double kLeastInterval_s = 1e-3;
  // A joint that turns faster jumped: another suit, another posture.
  static constexpr double kMostRate_rad_s = 50.0;
  // Limbs go on for this long, or for as long as between the newest two postures.
  static constexpr double kLeastAhead_s = 0.1;

  diver::JointRotations newest = diver::straight_joints();  // parent_from_child, when captured
  double age_s = 0.0;                                       // from the capture to the arrival
  std::array<Vec3, diver::kJoints> rate_rad_s{};            // axes of the parent
  diver::JointRotations base = diver::straight_joints();    // from which the next rates count
  std::int64_t base_captured_ns = 0;
  double interval_s = 0.0;
  std::uint64_t taken = 0;       // postures so far
  std::uint64_t taken_step = 0;  // the step that used the newest first

  // step: the one that uses it first. hold_s: after a longer silence the rates are not known.
  void take(const BodyJoints& body, const SampleHeader& header, double hold_s, std::uint64_t step);
  // So long after the newest posture arrived. Where no newer one came the limbs rest at last.
  diver::JointRotations at(double since_arrival_s) const;

  static void fields(auto&& field, auto& self) {
    field("newest", self.newest);
    field("age_s", self.age_s);
    field("rate_rad_s", self.rate_rad_s);
    field("base", self.base);
    field("base_captured_ns", self.base_captured_ns);
    field("interval_s", self.interval_s);
    field("taken", self.taken);
    field("taken_step", self.taken_step);
  }
};

}  // namespace neritic::testbed
