#include "testbed/loop/dive_pilot.hpp"

#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// What held keys push with; with shift, all that there is room for.
constexpr double kPush_n = 30.0, kLift_n = 40.0, kTurn_n_m = 3.0, kFastTurn_n_m = 10.0;
constexpr double kFullThrust_n = 1e4;
// Behind and above a vehicle that carries no camera.
const Pose kChase{{0.0, 0.6, 2.2}, from_yaw_pitch_roll(0.0, -0.2, 0.0)};

VehicleInputs inputs_of(const DiveInput& input, std::uint64_t failed_thrusters) {
  VehicleInputs out;
  out.piloted = 1;
  out.failed_thrusters = failed_thrusters;
  out.pilot[0] = -input.move.z * (input.fast ? kFullThrust_n : kPush_n);
  out.pilot[1] = input.move.x * (input.fast ? kFullThrust_n : kPush_n);
  out.pilot[2] = -input.move.y * (input.fast ? kFullThrust_n : kLift_n);
  out.pilot[5] = input.turn * (input.fast ? kFastTurn_n_m : kTurn_n_m);
  return out;
}

}  // namespace

DivePilot::DivePilot(LivePhysics* physics, const scene::Mount& view)
    : physics_(physics), vehicle_from_view_(kChase) {
  if (!physics_) return;
  const auto& vehicles = physics_->world().vehicles();
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (view.object != static_cast<int>(vehicles[i].object)) continue;
    vehicle_ = i;
    vehicle_from_view_ = view.pose;
  }
}

bool DivePilot::take(const DiveInput& input) {
  if (!physics_) return false;
  const bool was_flying = flying_;
  if (input.toggle_pilot) flying_ = !flying_;
  VehicleInputs inputs;
  inputs.failed_thrusters = physics_->world().vehicles()[vehicle_].failed_thrusters;
  if (flying_) inputs = inputs_of(input, inputs.failed_thrusters);
  const bool news = flying_ != was_flying || !sim::same_bits(inputs, told_);
  if ((flying_ || was_flying) && news && physics_->steer(vehicle_, inputs)) told_ = inputs;
  return flying_;
}

Pose DivePilot::world_from_view() const {
  return physics_->pose(vehicle_) * vehicle_from_view_;
}

std::vector<std::string> DivePilot::lines() const {
  std::vector<std::string> out;
  if (!physics_) return out;
  const auto& vehicles = physics_->world().vehicles();
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const VehicleState& state = physics_->shown().vehicles()[i];
    double heading_deg = degrees(rov::heading_of(state.body.attitude));
    if (heading_deg < 0.0) heading_deg += 360.0;
    std::string line = fmt::format("{}: depth {:.2f} m, heading {:03.0f}\u00b0, {:.2f} m/s",
                                   vehicles[i].name, state.body.position_ned_m.z, heading_deg,
                                   glm::length(state.body.velocity.linear()));
    if (flying_ && i == vehicle_)
      line += ", piloted";
    else if (vehicles[i].mission && vehicles[i].mission->waypoint_count() > 0)
      line +=
          fmt::format(", waypoint {} of {}", vehicles[i].mission->waypoint_index(state.mission) + 1,
                      vehicles[i].mission->waypoint_count());
    out.push_back(line);
  }
  if (const auto dropped = physics_->counts().dropped; dropped > 0)
    out.push_back(fmt::format("{} steps dropped", dropped));
  return out;
}

}  // namespace neritic::testbed
