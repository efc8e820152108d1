// The inputs of one participant as groups, each with its authority and its newest value. Samples
// change one group and leave the others. Plain bytes, pure functions; the stepping thread.
#pragma once

#include "testbed/samples/authority.hpp"
#include "testbed/samples/limb_track.hpp"
#include "testbed/samples/pose_track.hpp"

namespace neritic::testbed {

struct DiverInputs {
  std::array<GroupControl, kDiverGroups> control;
  BodyJoints body;
  HandJoints hands;
  HandPoses hand_poses;
  std::uint64_t hands_by_pose = 0;  // 1: the newest sample of the hands is a pose
  HeadPose head;
  Gaze gaze;
  JacketButtons buttons;
  Breath breath;
  Heart heart;
  GasSupply gas;
  std::uint64_t refused_events = 0;  // that name no group, authority or recording

  const GroupControl& of(DiverGroup group) const {
    return control[static_cast<std::size_t>(group)];
  }
  GroupControl& of(DiverGroup group) { return control[static_cast<std::size_t>(group)]; }

  static void fields(auto&& field, auto& self) {
    field("control", self.control);
    field("body", self.body);
    field("hands", self.hands);
    field("hand_poses", self.hand_poses);
    field("hands_by_pose", self.hands_by_pose);
    field("head", self.head);
    field("gaze", self.gaze);
    field("buttons", self.buttons);
    field("breath", self.breath);
    field("heart", self.heart);
    field("gas", self.gas);
    field("refused_events", self.refused_events);
  }
};

struct VehicleInputs {
  std::array<GroupControl, kVehicleGroups> control;
  VehicleWrench wrench;
  VehicleThrusters thrusters;
  VehicleSetpoint setpoint;
  VehicleVelocity velocity;
  // 1: the newest sample of the group is forces of thrusters; a velocity.
  std::uint64_t wrench_by_thrusters = 0, setpoint_by_velocity = 0;
  ThrusterFault fault;
  std::uint64_t refused_events = 0;  // that name no group, authority or recording

  const GroupControl& of(VehicleGroup group) const {
    return control[static_cast<std::size_t>(group)];
  }
  GroupControl& of(VehicleGroup group) { return control[static_cast<std::size_t>(group)]; }

  static void fields(auto&& field, auto& self) {
    field("control", self.control);
    field("wrench", self.wrench);
    field("thrusters", self.thrusters);
    field("setpoint", self.setpoint);
    field("velocity", self.velocity);
    field("wrench_by_thrusters", self.wrench_by_thrusters);
    field("setpoint_by_velocity", self.setpoint_by_velocity);
    field("fault", self.fault);
    field("refused_events", self.refused_events);
  }
};

// The inputs of an object that devices move.
struct ObjectInputs {
  std::array<GroupControl, kObjectGroups> control;
  PoseTrack track;
  std::uint64_t refused_events = 0;  // that name no group, authority or recording

  static void fields(auto&& field, auto& self) {
    field("control", self.control);
    field("track", self.track);
    field("refused_events", self.refused_events);
  }
};

// Everything under the autopilot, with each group's own hold time.
DiverInputs autopilot_diver();
VehicleInputs autopilot_vehicle();
ObjectInputs autopilot_object();

// Puts a sample that arrived before `step` into its group if its source has the authority. An event
// sets an authority. False if it changed nothing; the group or `refused_events` counts it then.
// recorded: bit i: the scene has a file for group i; others have none.
bool apply(DiverInputs& inputs, const Sample& sample, std::uint64_t step,
           std::uint64_t recorded = 0);
bool apply(VehicleInputs& inputs, const Sample& sample, std::uint64_t step);
// limbs: of the object, if it has them: its joints come under the authority of its poses.
bool apply(ObjectInputs& inputs, const Sample& sample, std::uint64_t step,
           LimbTrack* limbs = nullptr);

}  // namespace neritic::testbed
