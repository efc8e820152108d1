#include "testbed/view/dive_pilot.hpp"

#include "diver/human_step.hpp"
#include "engine/core/log.hpp"
#include "hud/numbers.hpp"
#include "rov/frames.hpp"
#include "testbed/samples/authority_words.hpp"
#include "testbed/view/panel_frame.hpp"

namespace neritic::testbed {
namespace {

// The force of held keys; with shift, as much as the thrusters have room for.
constexpr double kPush_n = 30.0, kLift_n = 40.0, kTurn_n_m = 3.0, kFastTurn_n_m = 10.0;
constexpr double kFullThrust_n = 1e4;

VehicleWrench wrench_of(const DiveInput& input) {
  VehicleWrench out;
  out.wrench[0] = -input.move.z * (input.fast ? kFullThrust_n : kPush_n);
  out.wrench[1] = input.move.x * (input.fast ? kFullThrust_n : kPush_n);
  out.wrench[2] = -input.move.y * (input.fast ? kFullThrust_n : kLift_n);
  out.wrench[5] = input.turn * (input.fast ? kFastTurn_n_m : kTurn_n_m);
  return out;
}

}  // namespace

DivePilot::DivePilot(LivePhysics* physics) : physics_(physics) {
  if (!physics_) return;
  watch_.emplace(physics_->world(), physics_->inbox(),
                 [](const std::string& line) { log_warn("{}", line); });
  // A state that was saved in flight: nobody holds the keys now, so the scene's choice comes back.
  flew_ = had_authority();
}

// In the newest state.
bool DivePilot::had_authority() const {
  const auto& vehicles = physics_->shown().vehicles();
  if (vehicles.empty()) return false;
  const GroupState& wrench =
      vehicles[vehicle_].groups[static_cast<std::size_t>(VehicleGroup::kWrench)];
  const auto sources = physics_->inbox().source_names();
  return wrench.authority == Authority::kLive && wrench.source < sources.size() &&
         sources[wrench.source] == kKeyboard;
}

// Whether the keys fly the vehicle in the newest state, as far as that can know of them.
bool DivePilot::heard() const {
  const GroupState& wrench = physics_->shown()
                                 .vehicles()[vehicle_]
                                 .groups[static_cast<std::size_t>(VehicleGroup::kWrench)];
  return !flew_ || (had_authority() && wrench.phase == GroupPhase::kLive);
}

Result<DivePilot> DivePilot::create(LivePhysics* physics, bool may_fly) {
  DivePilot pilot(physics);
  if (may_fly && physics && !physics->world().vehicles().empty()) {
    NERITIC_TRY(pilot.keyboard_, physics->inbox().open(std::string(kKeyboard)));
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
  // Each frame sends the keys. A window that draws none for so long has let go of the vehicle.
  event.hold_s = flying_ ? hold_.scene_s() : chosen.hold_s;
  told_ = true;
  send(inbox, PayloadKind::kEvent, events_, event);
}

bool DivePilot::take(const DiveInput& input, int object, double speed) {
  if (!physics_) return false;
  if (hold_.frame(now_ns(), speed)) told_ = false;
  const auto& vehicles = physics_->world().vehicles();
  for (std::size_t i = 0; i < vehicles.size() && !flying_ && !flew_; ++i)
    if (object == static_cast<int>(vehicles[i].object)) vehicle_ = i;
  if (input.toggle_pilot && keyboard_) flying_ = !flying_;
  wrench_ = wrench_of(input);
  sent_ = false;
  return flying_;
}

Status DivePilot::poll(SampleInbox& inbox, double) {
  if (!physics_ || std::exchange(sent_, true)) return {};
  NERITIC_TRY_STATUS(watch_->accept(physics_->shown_snapshot(), {}));
  if (flying_ != flew_ || (flying_ && !told_)) hand_over(inbox);
  flew_ = flying_;
  if (flying_) send(inbox, PayloadKind::kWrench, wrenches_, wrench_);
  return {};
}

int DivePilot::object() const {
  if (!physics_ || physics_->world().vehicles().empty()) return -1;
  return static_cast<int>(physics_->world().vehicles()[vehicle_].object);
}

std::string DivePilot::doing(std::size_t object, hud::Units units) const {
  if (!physics_) return {};
  const auto& vehicles = physics_->world().vehicles();
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    if (vehicles[i].object != object) continue;
    const VehicleState& state = physics_->shown().vehicles()[i];
    const std::string heading = fmt::format(
        "heading {}\u00b0", hud::heading_text(rov::heading_of(state.body.attitude)).view());
    if (flying_ && i == vehicle_)
      return heading + (heard() ? ", piloted" : ", the keys are not heard");
    const auto& mission = vehicles[i].mission;
    if (!mission || mission->waypoint_count() == 0) return heading;
    return heading + fmt::format(", waypoint {} of {}", mission->waypoint_index(state.mission) + 1,
                                 mission->waypoint_count());
  }
  const auto& humans = physics_->world().humans();
  for (std::size_t i = 0; i < humans.size(); ++i) {
    if (humans[i].object != object) continue;
    const diver::GasReading gas =
        diver::read_gas(humans[i].body, physics_->shown().humans()[i].human);
    // As the diver's own instruments round it, to the safe side.
    return fmt::format("{} {} left, breathes {}", hud::pressure_text(gas.tank_pa, units).view(),
                       hud::unit_names(units).pressure, flow_text(gas.ventilation_l_min, units));
  }
  return {};
}

std::vector<std::string> DivePilot::troubles() const {
  std::vector<std::string> out;
  if (!physics_) return out;
  const auto& vehicles = physics_->world().vehicles();
  const auto sources = physics_->inbox().source_names();
  for (std::size_t i = 0; i < vehicles.size(); ++i)
    add_trouble<VehicleGroup>(vehicles[i].name, physics_->shown().vehicles()[i].groups, sources,
                              out);
  const auto& humans = physics_->world().humans();
  for (std::size_t i = 0; i < humans.size(); ++i)
    add_trouble<DiverGroup>(humans[i].name, physics_->shown().humans()[i].groups, sources, out);
  const auto& objects = physics_->world().objects();
  for (std::size_t i = 0; i < objects.size(); ++i)
    add_trouble<ObjectGroup>(objects[i].name, physics_->shown().objects()[i].groups, sources, out);
  if (const auto dropped = physics_->counts().dropped; dropped > 0)
    out.push_back(fmt::format("{} steps dropped", dropped));
  return out;
}

}  // namespace neritic::testbed
