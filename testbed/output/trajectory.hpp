// Where every participant of a run was, frame by frame: OUT/trajectory.csv with velocities, and a
// file each in the format of the TUM RGB-D benchmark ("timestamp tx ty tz qx qy qz qw"; Sturm et
// al. 2012), which trajectory tools read. One thread.
//
// World axes: right-handed, y up, metres, the still surface at y = 0. A pose is world_from_NAME:
// cameras and sonars look along their -z, x to the right, y up; models face -z. Velocities are of
// NAME's origin and rotation in world axes. The last column tells how a pose is known
// (scene::Knowledge): of the state of just that time, between two states, predicted or held.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/core/growing_file.hpp"
#include "testbed/sensors/frame_result.hpp"
#include "testbed/sensors/participants.hpp"

namespace neritic::testbed {

class TrajectoryFiles {
 public:
  TrajectoryFiles(std::vector<Participant> participants, const std::filesystem::path& out);
  // The result's poses are of the participants, in their order.
  Status add(const FrameResult& frame);
  Status finish();

 private:
  std::vector<Participant> participants_;
  std::filesystem::path folder_;
  GrowingFile csv_;
  std::vector<GrowingFile> tum_;
  bool begun_ = false;
};

}  // namespace neritic::testbed
