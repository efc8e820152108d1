#include "testbed/instruments/instrument_data.hpp"

#include <algorithm>
#include <cmath>

#include "diver/frames.hpp"
#include "diver/kinematics.hpp"
#include "diver/reach.hpp"
#include "engine/core/text.hpp"
#include "hud/numbers.hpp"
#include "testbed/samples/authority_words.hpp"
#include "testbed/simulation/diver_condition.hpp"
#include "testbed/simulation/human_readings.hpp"

namespace neritic::testbed {
namespace {

void read_computer(const PhysicsHuman& human, const HumanPhysics& state, hud::DiveData& out) {
  const diver::AscentGas ascent = gas_for_ascent(human, state);
  const diver::DiveComputerView& view = ascent.view;
  const diver::DiveComputerState& computer = state.human.life.computer;
  const diver::DiveComputerSettings& settings = human.computer->settings();
  const diver::DecoEnvironment& environment = settings.conventions.environment;
  out.surface_bar = environment.surface_bar;
  out.bar_per_m = environment.bar_per_m;
  out.dive_min = computer.dive_min;
  out.depth_m = computer.last.depth_m;
  out.deepest_m = computer.deepest_m;
  out.ceiling_m = view.ceiling_m;
  out.no_stop_min = view.no_stop_min;
  out.stop_m = view.stop_m;
  out.stop_min = view.stop_min;
  out.to_surface_min = view.to_surface_min;
  out.ascent_m_min = view.ascent_m_min;
  out.ascent_limits = settings.ascent;
  out.ascent_alarm = view.alarm;
  out.ceiling_violated = view.ceiling_violated;
  out.po2_bar = view.po2_bar;
  out.cns_percent = computer.oxygen.cns_percent;
  out.surface_gradient = view.surface_gradient;
  out.needed_l = ascent.needed_l;
  out.available_l = ascent.there_l;
  const double ambient_bar = environment.pressure_bar(computer.last.depth_m);
  const diver::Buehlmann model = settings.conventions.model();
  for (std::size_t i = 0; i < out.tissues.size(); ++i)
    out.tissues[i] = hud::tissue_bar(model, computer.tissues, i, ambient_bar);
}

// Whether a tank gives a full breath of a gas with enough oxygen here, and no more than most_bar.
bool can_be_breathed(const diver::Body& body, const diver::HumanState& state, std::size_t tank,
                     double most_bar = diver::kMostOxygen_bar) {
  const double ambient_pa = diver::pressure_at(body, state.root.position_ned_m.z);
  const double oxygen_bar = 1e-5 * ambient_pa * body.tanks[tank].mix.oxygen;
  // A diver in a mountain lake is used to its air, as in diver/gas_switch.cpp.
  const double used_to = std::min(body.surface_pa / diver::kSurfacePressure_pa, 1.0);
  return oxygen_bar >= used_to * diver::kLeastOxygen_bar && oxygen_bar <= most_bar &&
         diver::tank_pressure(body, state.life.tanks, tank) >= ambient_pa + diver::kWeakTank_pa;
}

void read_gas(const PhysicsHuman& human, const HumanPhysics& state, hud::DiveData& out) {
  const diver::GasReading gas = diver::read_gas(human.body, state.human);
  const std::size_t tank = state.human.held.tank;
  if (tank < human.body.tank_count) {
    out.gas_known = true;
    out.gas = human.body.tanks[tank].mix;
  }
  const bool bottom_gas = tank == 0;
  out.oxygen_limit_bar = bottom_gas ? hud::kBottomOxygen_bar : hud::kDecoOxygen_bar;
  out.mod_po2_bar = bottom_gas ? hud::kBottomOxygen_bar : diver::kMostOxygen_bar;
  out.tank_pa = gas.tank_pa;
  out.gas_min = gas.remaining_s / 60.0;
  out.out_of_gas = state.human.life.lungs.unfed_s > 0.0;
  for (std::size_t i = 0; i < human.body.tank_count; ++i) {
    if (i == tank) continue;
    const double limit_bar = i == 0 ? hud::kBottomOxygen_bar : diver::kMostOxygen_bar;
    out.other_gas = out.other_gas || can_be_breathed(human.body, state.human, i);
    out.leaner_gas = out.leaner_gas || (human.body.tanks[i].mix.oxygen < out.gas.oxygen &&
                                        can_be_breathed(human.body, state.human, i, limit_bar));
  }
}

void read_body(const PhysicsHuman& human, const HumanPhysics& state, hud::DiveData& out) {
  const diver::HumanState& diver = state.human;
  if (human.body.jacket.capacity_m3 > 0.0) {
    out.jacket_full_m3 = human.body.jacket.capacity_m3;
    out.jacket_m3 = diver::read_gas(human.body, diver).jacket_m3;
    out.lift_n = human.body.density_kg_m3(diver.root.position_ned_m.z) * diver::kGravity_m_s2 *
                 out.jacket_m3;
    out.buttons = diver.held.buttons;
  }
  out.net_weight_n = diver::net_weight_n(human.body, diver);
  out.heading_rad = diver_heading_rad(diver.root.attitude);
  out.heart_bpm = diver.life.vitals.heart_bpm;
  out.breath_bpm = diver.life.vitals.breath_bpm;
  out.lungs_m3 = diver.life.lungs.volume_m3;
}

void read_condition(const PhysicsHuman& human, const HumanPhysics& state, const PhysicsState& all,
                    hud::DiveData& out) {
  const ConditionReading now = condition_reading(human, all, state);
  const auto models = [&](std::uint64_t bit) {
    return (human.condition->settings.effects & bit) != 0;
  };
  if (models(diver::kHypoxia)) out.saturation = now.saturation;
  if (models(diver::kCarbonDioxide)) out.co2_mmhg = now.co2_mmhg;
  if (models(diver::kNarcosis)) out.narcotic_depth_m = now.narcotic_depth_m;
  if (models(diver::kOxygenToxicity)) out.oxygen_dose = now.oxygen;
  if (models(diver::kCold)) out.core_c = now.core_c;
  out.slowing = now.slowing;
  out.strength = now.strength;
  out.unconscious = now.lost != 0;
}

// A message's bytes as words: UTF-8 without control characters; nothing where they are none.
std::optional<hud::LongText> words_of(const sonar::ModemMessage& message) {
  static_assert(sizeof message.words == 64);
  std::array<char, 64> bytes{};
  const std::size_t count = std::min<std::size_t>(message.bytes, bytes.size());
  for (std::size_t i = 0; i < count; ++i)
    bytes[i] = static_cast<char>(message.words[i / 8] >> (8 * (i % 8)));
  const std::string_view text(bytes.data(), count);
  if (text.empty() || printable(text, bytes.size()) != text) return std::nullopt;
  return hud::LongText(text);
}

// The newest that the modem received and still knows.
void read_message(const PhysicsWorld& world, std::size_t diver,
                  const sim::Snapshot<PhysicsState>& snapshot, hud::DiveData& out) {
  const Modems& modems = world.modems();
  const auto own = modems.find(OwnerSort::kDiver, static_cast<std::uint32_t>(diver));
  if (!own) return;
  const sonar::ModemState& state = snapshot.state.modems()[*own];
  const std::uint64_t all = state.counts.all();
  const std::uint64_t kept = std::min<std::uint64_t>(all, sonar::ModemState::kKept);
  for (std::uint64_t k = all; k > all - kept; --k) {
    const sonar::ModemReport& report = state.reports[(k - 1) % sonar::ModemState::kKept];
    if (report.event != sonar::ModemEvent::kReceived ||
        report.message.kind != sonar::ModemKind::kMessage ||
        report.message.from >= modems.all().size())
      continue;
    const auto words = words_of(report.message);
    if (!words) continue;  // for a program
    out.message = *words;
    out.message_from = std::string_view(modems.all()[report.message.from].name);
    out.message_age_s = snapshot.time_s - report.at_s;
    return;
  }
}

hud::Health health_of(GroupPhase phase) {
  switch (phase) {
    case GroupPhase::kWaiting:
      return hud::Health::kWaiting;
    case GroupPhase::kLost:
      return hud::Health::kLost;
    default:
      return hud::Health::kGood;
  }
}

}  // namespace

hud::DiveData instrument_data(const PhysicsWorld& world, std::size_t diver,
                              const sim::Snapshot<PhysicsState>& snapshot) {
  const PhysicsHuman& human = world.humans()[diver];
  const HumanPhysics& state = snapshot.state.humans()[diver];
  hud::DiveData out;
  out.time_s = snapshot.time_s;
  read_computer(human, state, out);
  read_gas(human, state, out);
  read_body(human, state, out);
  if (human.condition) read_condition(human, state, snapshot.state, out);
  read_message(world, diver, snapshot, out);
  return out;
}

std::vector<hud::StreamHealth> stream_health(const HumanPhysics& diver,
                                             const std::vector<std::string>& sources) {
  std::vector<hud::StreamHealth> out;
  for (std::size_t i = 0; i < diver.groups.size(); ++i) {
    const GroupState& group = diver.groups[i];
    if (group.authority != Authority::kLive && group.unheeded == 0) continue;
    const std::string trouble = trouble_words(group, sources);
    out.push_back({std::string_view(name_of(static_cast<DiverGroup>(i))),
                   std::string_view(trouble.empty() ? authority_words(group, sources) : trouble),
                   health_of(group.phase)});
  }
  return out;
}

void add_links(const HumanPhysics& diver, const std::vector<DeviceHealth>& devices,
               const std::vector<std::string>& sources, std::vector<hud::StreamHealth>& streams) {
  for (std::size_t i = 0; i < diver.groups.size(); ++i) {
    const GroupState& group = diver.groups[i];
    if (group.phase != GroupPhase::kLive || group.source >= sources.size()) continue;
    const auto device = std::ranges::find(devices, sources[group.source], &DeviceHealth::name);
    if (device == devices.end()) continue;
    for (hud::StreamHealth& stream : streams)
      if (stream.name == hud::FixedText(std::string_view(name_of(static_cast<DiverGroup>(i)))))
        stream.note = std::string_view(link_words(*device));
  }
}

double diver_heading_rad(const Quat& ned_from_body) {
  const Vec3 head = ned_from_body * Vec3(1.0, 0.0, 0.0),
             belly = ned_from_body * Vec3(0.0, 0.0, 1.0);
  const Vec3 ahead = head - head.z * belly;
  const double heading = std::atan2(ahead.y, ahead.x);
  return heading < 0.0 ? heading + 2.0 * kPi : heading;
}

DiverGauge gauge_of(const PhysicsHuman& human, const HumanPhysics& state) {
  const double bar_per_m = human.computer->settings().conventions.environment.bar_per_m;
  return {hud::standard_depth_m(state.human.life.computer.last.depth_m, bar_per_m),
          diver_heading_rad(state.human.root.attitude)};
}

Pose world_from_wrist(const PhysicsHuman& human, const HumanPhysics& state, bool right) {
  const diver::RootState& root = state.human.root;
  const Pose hand = diver::body_from_hand(
      diver::posture_of(human.body, state.human.limbs.rotation, state.human.limbs.rate), right);
  return diver::standing_pose(root.position_ned_m + root.attitude * hand.position_m,
                              root.attitude * hand.rotation);
}

// The model's nodes have parallel axes while its arms are spread: a drawn hand is turned against
// the body's by that angle (diver/frames.hpp, standing_joints).
Pose world_from_drawn_wrist(const PhysicsHuman& human, const scene::MotionSource& motion,
                            double time_s) {
  const Pose drawn = motion.world_from_joint(human.object, human.nodes[diver::kLeftHand], time_s);
  const double spread_rad = diver::side_of(diver::kLeftHand) * human.arms_spread_rad;
  return {drawn.position_m,
          glm::normalize(drawn.rotation * glm::angleAxis(spread_rad, Vec3(0.0, 0.0, 1.0)))};
}

}  // namespace neritic::testbed
