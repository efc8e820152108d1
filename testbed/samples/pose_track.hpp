// The newest poses that a source measured of one object, and its motion after them. Velocities are
// the source's, or those between two poses by their capture times. Plain bytes; a step's input.
#pragma once

#include "engine/core/motion.hpp"
#include "testbed/samples/sample.hpp"

namespace neritic::testbed {

// The rate of the shortest turn from one attitude to another, in their target's axes. Precondition:
// interval_s > 0.
Vec3 turning_rad_s(const Quat& from, const Quat& to, double interval_s);

struct PoseTrack {
  // Poses captured closer together than this say where the object is, not how fast it moves.
  static constexpr double kLeastInterval_s = 1e-3;
  // A faster change is a jump: a marker taken for another, an object put somewhere else.
  static constexpr double kMostSpeed_m_s = 50.0, kMostRate_rad_s = 100.0;
  // After its newest pose an object moves on for this long, or for the time between the newest two.
  static constexpr double kLeastAhead_s = 0.1;

  Motion newest;       // world_from_object, when it was captured
  double age_s = 0.0;  // from its capture to its arrival
  // The pose from which the next one's velocity counts, and the time between it and the one before.
  Pose base;
  std::int64_t base_captured_ns = 0;
  double interval_s = 0.0;
  std::uint64_t taken = 0;  // poses so far

  // hold_s: after a longer silence the velocity is not known.
  void take(const ObjectPose& pose, const SampleHeader& header, double hold_s);
  // So long after the newest pose arrived. Where no newer one came it stands still at last.
  Motion at(double since_arrival_s) const;

  static void fields(auto&& field, auto& self) {
    field("newest", self.newest);
    field("age_s", self.age_s);
    field("base", self.base);
    field("base_captured_ns", self.base_captured_ns);
    field("interval_s", self.interval_s);
    field("taken", self.taken);
  }
};

}  // namespace neritic::testbed
