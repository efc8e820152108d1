#include "testbed/loop/dive_pilot.hpp"

#include "engine/core/log.hpp"
#include "rov/frames.hpp"
#include "testbed/samples/authority_words.hpp"

namespace neritic::testbed {
namespace {

// The force of held keys; with shift, as much as the thrusters have room for.
constexpr double kPush_n = 30.0, kLift_n = 40.0, kTurn_n_m = 3.0, kFastTurn_n_m = 10.0;
constexpr double kFullThrust_n = 1e4;
// Each frame sends the keys. A window that draws none for so long has let go of the vehicle.
constexpr double kKeysHold_s = 1.0;
// Behind and above a vehicle that carries no camera.
const Pose kChase{{0.0, 0.6, 2.2}, from_yaw_pitch_roll(0.0, -0.2, 0.0)};

VehicleWrench wrench_of(const DiveInput& input) {
  VehicleWrench out;
  out.wrench[0] = -input.move.z * (input.fast ? kFullThrust_n : kPush_n);
  out.wrench[1] = input.move.x * (input.fast ? kFullThrust_n : kPush_n);
  out.wrench[2] = -input.move.y * (input.fast ? kFullThrust_n : kLift_n);
  out.wrench[5] = input.turn * (input.fast ? kFastTurn_n_m : kTurn_n_m);
  return out;
}

}  // namespace

DivePilot::DivePilot(LivePhysics* physics, const scene::Mount& view)
    : physics_(physics), vehicle_from_view_(kChase) {
  if (!physics_) return;
  watch_.emplace(physics_->world(), physics_->inbox(),
                 [](const std::string& line) { log_warn("{}", line); });
  const auto& vehicles = physics_->world().vehicles();
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (view.object != static_cast<int>(vehicles[i].object)) continue;
    vehicle_ = i;
    vehicle_from_view_ = view.pose;
  }
  // A state that was saved in flight: nobody holds the keys now, so the scene's choice comes back.
  if (vehicles.empty()) return;
  const GroupControl& wrench =
      physics_->simulation().inputs().vehicles()[vehicle_].of(VehicleGroup::kWrench);
  const auto sources = physics_->inbox().source_names();
  flew_ = wrench.authority == Authority::kLive && wrench.source < sources.size() &&
          sources[wrench.source] == "keyboard";
}

Result<DivePilot> DivePilot::create(LivePhysics* physics, const scene::Mount& view, bool may_fly) {
  DivePilot pilot(physics, view);
  if (may_fly && physics && !physics->world().vehicles().empty()) {
    NERITIC_TRY(pilot.keyboard_, physics->inbox().open("keyboard"));
  }
  return pilot;
}

void DivePilot::send(SampleInbox& inbox, PayloadKind kind, std::uint64_t& sequence,
                     const Payload& payload) {
  const auto vehicle = static_cast<std::uint32_t>(vehicle_);
  const StreamId stream = physics_->world().streams().id(OwnerSort::kVehicle, vehicle, kind);
  const TimeNs now = now_ns();
  inbox.push({{stream, *keyboard_, sequence++, now, now}, payload});
}

// Gives the vehicle's wrench to the keyboard while it flies, else back to the scene's choice.
void DivePilot::hand_over(SampleInbox& inbox) {
  const GroupControl& chosen =
      physics_->world().start_inputs().vehicles()[vehicle_].of(VehicleGroup::kWrench);
  Event event{.group = static_cast<std::uint64_t>(VehicleGroup::kWrench)};
  event.authority = static_cast<std::uint64_t>(flying_ ? Authority::kLive : chosen.authority);
  event.source = flying_ ? *keyboard_ : chosen.source;
  event.hold_s = flying_ ? kKeysHold_s : chosen.hold_s;
  send(inbox, PayloadKind::kEvent, events_, event);
}

bool DivePilot::take(const DiveInput& input) {
  if (!physics_) return false;
  if (input.toggle_pilot && keyboard_) flying_ = !flying_;
  wrench_ = wrench_of(input);
  sent_ = false;
  return flying_;
}

Status DivePilot::poll(SampleInbox& inbox, double) {
  if (!physics_ || std::exchange(sent_, true)) return {};
  NERITIC_TRY_STATUS(watch_->accept(physics_->shown_snapshot(), {}));
  if (flying_ != flew_) hand_over(inbox);
  flew_ = flying_;
  if (flying_) send(inbox, PayloadKind::kWrench, wrenches_, wrench_);
  return {};
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
  const auto sources = physics_->inbox().source_names();
  for (std::size_t i = 0; i < vehicles.size(); ++i)
    add_trouble<VehicleGroup>(vehicles[i].name, physics_->shown().vehicles()[i].groups, sources,
                              out);
  const auto& humans = physics_->world().humans();
  for (std::size_t i = 0; i < humans.size(); ++i)
    add_trouble<DiverGroup>(humans[i].name, physics_->shown().humans()[i].groups, sources, out);
  if (const auto dropped = physics_->counts().dropped; dropped > 0)
    out.push_back(fmt::format("{} steps dropped", dropped));
  return out;
}

}  // namespace neritic::testbed
