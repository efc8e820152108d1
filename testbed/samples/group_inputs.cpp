#include "testbed/samples/group_inputs.hpp"

namespace neritic::testbed {
namespace {

// Copies the payload where the sample is of that kind.
template <class T>
void take(const Sample& sample, T& value) {
  if (const T* said = std::get_if<T>(&sample.payload)) value = *said;
}

template <class Inputs>
bool apply_event(Inputs& inputs, const Event& event, std::uint64_t recorded) {
  const bool known = event.kind == EventKind::kSetAuthority &&
                     event.group < inputs.control.size() && event.hold_s >= 0.0 &&
                     (event.authority != static_cast<std::uint64_t>(Authority::kRecording) ||
                      (recorded >> event.group & 1) != 0);
  if (!known || !set_authority(inputs.control[event.group], event.authority, event.source)) {
    ++inputs.refused_events;
    return false;
  }
  if (event.hold_s > 0.0) inputs.control[event.group].hold_s = event.hold_s;
  return true;
}

// Whether the sample's own group listens to its source.
template <class Inputs>
bool heard(Inputs& inputs, const Sample& sample, std::uint64_t step) {
  const auto group = group_of(sample.kind());
  return group && hear(inputs.control.at(*group), sample.header.source, step);
}

template <class Inputs, std::size_t n>
Inputs all_autopilot(const std::array<double, n>& hold_s) {
  Inputs inputs;
  for (std::size_t i = 0; i < n; ++i) inputs.control[i].hold_s = hold_s[i];
  return inputs;
}

}  // namespace

DiverInputs autopilot_diver() {
  return all_autopilot<DiverInputs>(kDiverHold_s);
}
VehicleInputs autopilot_vehicle() {
  return all_autopilot<VehicleInputs>(kVehicleHold_s);
}
ObjectInputs autopilot_object() {
  return all_autopilot<ObjectInputs>(kObjectHold_s);
}

bool apply(DiverInputs& inputs, const Sample& sample, std::uint64_t step, std::uint64_t recorded) {
  if (const Event* event = std::get_if<Event>(&sample.payload))
    return apply_event(inputs, *event, recorded);
  if (!heard(inputs, sample, step)) return false;
  take(sample, inputs.body);
  take(sample, inputs.hands);
  take(sample, inputs.hand_poses);
  take(sample, inputs.head);
  take(sample, inputs.gaze);
  take(sample, inputs.buttons);
  take(sample, inputs.breath);
  take(sample, inputs.heart);
  take(sample, inputs.gas);
  if (sample.kind() == PayloadKind::kHandJoints) inputs.hands_by_pose = 0;
  if (sample.kind() == PayloadKind::kHandPoses) inputs.hands_by_pose = 1;
  return true;
}

bool apply(VehicleInputs& inputs, const Sample& sample, std::uint64_t step) {
  if (const Event* event = std::get_if<Event>(&sample.payload))
    return apply_event(inputs, *event, 0);
  if (!heard(inputs, sample, step)) return false;
  take(sample, inputs.wrench);
  take(sample, inputs.thrusters);
  take(sample, inputs.setpoint);
  take(sample, inputs.velocity);
  take(sample, inputs.fault);
  if (sample.kind() == PayloadKind::kWrench) inputs.wrench_by_thrusters = 0;
  if (sample.kind() == PayloadKind::kThrusters) inputs.wrench_by_thrusters = 1;
  if (sample.kind() == PayloadKind::kSetpoint) inputs.setpoint_by_velocity = 0;
  if (sample.kind() == PayloadKind::kVelocity) inputs.setpoint_by_velocity = 1;
  return true;
}

bool apply(ObjectInputs& inputs, const Sample& sample, std::uint64_t step, LimbTrack* limbs) {
  const GroupControl& control = inputs.control.front();
  if (const Event* event = std::get_if<Event>(&sample.payload)) {
    const std::uint64_t before = control.source;
    const bool known = apply_event(inputs, *event, 0);
    if (limbs && control.source != before) *limbs = {};
    return known;
  }
  if (const BodyJoints* body = std::get_if<BodyJoints>(&sample.payload)) {
    // Only poses count as heard: a diver whose place is not known is not shown by limbs.
    if (!limbs || control.authority != Authority::kLive || control.source != sample.header.source)
      return false;
    limbs->take(*body, sample.header, control.hold_s, step);
    return true;
  }
  if (!heard(inputs, sample, step)) return false;
  if (control.heard == 1) inputs.track = {};  // another source's poses say nothing of this one's
  inputs.track.take(std::get<ObjectPose>(sample.payload), sample.header, control.hold_s);
  return true;
}

}  // namespace neritic::testbed
