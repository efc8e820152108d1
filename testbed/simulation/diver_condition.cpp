#include "testbed/simulation/diver_condition.hpp"

#include <algorithm>
#include <cmath>

#include "diver/oxygen_exposure.hpp"
#include "engine/core/random.hpp"

namespace neritic::testbed {
namespace {

constexpr std::uint64_t kToleranceStream = 0x746f6c65726e6365ull;  // of random numbers
// From the hips to the mouth, of the height (de Leva 1996: hips to vertex 0.47, vertex to mouth
// 0.09 of it).
constexpr double kMouthShare = 0.38;
// The open valve of a second stage whose lever sticks, where a client asks for a free flow.
constexpr double kOpenValve_m2 = 10e-6;

Vec3 mouth_ned_m(const PhysicsHuman& human, const HumanPhysics& state) {
  const diver::RootState& root = state.human.root;
  return root.position_ned_m + root.attitude * Vec3(kMouthShare * human.body.height_m, 0.0, 0.0);
}

double mouths_apart_m(std::span<const PhysicsHuman> humans, std::size_t a, std::size_t b,
                      const PhysicsState& state) {
  return glm::distance(mouth_ned_m(humans[a], state.humans()[a]),
                       mouth_ned_m(humans[b], state.humans()[b]));
}

double ambient_pa(const PhysicsHuman& human, const HumanPhysics& state) {
  return diver::pressure_at(human.body, state.human.root.position_ned_m.z);
}

// Whether none of the diver's own tanks gives a full breath.
bool all_empty(const PhysicsHuman& human, const HumanPhysics& state) {
  const double least_pa = ambient_pa(human, state) + diver::kWeakTank_pa;
  for (std::size_t i = 0; i < human.body.tank_count; ++i)
    if (diver::tank_pressure(human.body, state.human.life.tanks, i) >= least_pa) return false;
  return true;
}

double litres_of(double moles) {
  return moles * diver::kGasConstant * diver::kTankTemperature_k / 1e5 * 1e3;
}

diver::ConditionInputs inputs_of(const PhysicsHuman& human, const diver::GasMix* borrowed,
                                 double shiver_w, const HumanPhysics& state) {
  const diver::HumanState& now = state.human;
  const diver::LifeState& life = now.life;
  const std::uint64_t tank = now.held.tank;
  const diver::GasMix mix = borrowed                       ? *borrowed
                            : tank < human.body.tank_count ? human.body.tanks[tank].mix
                                                           : diver::kAir;
  const double ambient = ambient_pa(human, state);
  const bool breathes = now.held.hold_breath == 0 && life.lungs.unfed_s == 0.0;
  diver::ConditionInputs in;
  in.breath.inspired_share = mix.oxygen;
  in.breath.ambient_pa = ambient;
  in.breath.oxygen_l_min = life.lungs.oxygen_l_min;
  in.breath.lungs_m3 = breathes ? diver::middle_of_quiet_breath(human.body) : life.lungs.volume_m3;
  if (breathes)
    in.breath.ventilation_l_min =
        now.held.ventilation_l_min > 0.0
            ? now.held.ventilation_l_min
            : diver::ventilation_l_min(human.body, life.lungs.oxygen_l_min, mix, ambient);
  // Shivering is part of the uptake where it acts; the heat balance adds it itself.
  const double uptake_w = life.lungs.oxygen_l_min / 60.0 * diver::kJoulePerLitre;
  const double resting_w = diver::kRestingOxygen_l_min / 60.0 * diver::kJoulePerLitre;
  in.heat.heat_w = std::max(resting_w, uptake_w - life.limb_power_w - shiver_w);
  in.heat.ventilation_l_min = in.breath.ventilation_l_min;
  in.heat.gas_density_kg_m3 = diver::gas_density_g_l(mix, 1e-5 * ambient);
  in.heat.ambient_pa = ambient;
  in.heat.surface_pa = human.body.surface_pa;
  in.heat.speed_m_s =
      glm::length(now.root.attitude * now.root.velocity.linear() - now.held.current_ned_m_s);
  in.co2_mmhg = life.vitals.risk.co2_mmhg;
  in.narcotic_depth_m = life.vitals.risk.narcotic_depth_m;
  return in;
}

// In water as warm as its layers have it at the diver's depth.
diver::ConditionSettings settings_at(const PhysicsHuman& human, const HumanPhysics& diver) {
  diver::ConditionSettings settings = human.condition->settings;
  if (human.body.layers && !human.condition->own_water)
    settings.cold.water_c =
        human.body.layers->column().at(diver.human.root.position_ned_m.z).temperature_c;
  return settings;
}

}  // namespace

PhysicsCondition physics_condition(const scene::Condition& said, const diver::DiverFile& file) {
  PhysicsCondition out;
  out.acts = said.acts;
  diver::ConditionSettings& settings = out.settings;
  if (!said.effects.empty()) settings.effects = 0;
  for (const std::string& name : said.effects)
    for (std::size_t bit = 0; bit < diver::kEffects; ++bit)
      if (name == diver::name_of_effect(bit)) settings.effects |= std::uint64_t{1} << bit;
  const diver::BodyParameters& body = file.parameters;
  settings.cold.water_c = said.water_c.value_or(settings.cold.water_c);
  out.own_water = said.water_c.has_value();
  settings.cold.mass_kg = body.build.mass_kg;
  settings.cold.height_m = body.build.height_m;
  settings.cold.suit_m = body.gear.suit ? body.gear.suit->thickness_m : 0.0;
  settings.cold.fat_share = said.fat_share;
  settings.oxygen_tolerance = said.oxygen_tolerance.value_or(0.0);
  return out;
}

Result<PhysicsRegulator> physics_regulator(const scene::Regulator& said, const diver::Body& body) {
  for (std::size_t i = 0; i < said.free_flows.size(); ++i)
    if (said.free_flows[i].tank >= body.tank_count)
      return bad_input("regulator.free_flow[{}].tank: found {}; accepted: below {}, its tanks", i,
                       said.free_flows[i].tank, body.tank_count);
  PhysicsRegulator out;
  out.donor_tank = said.donor_tank;
  out.hose_m = said.hose_m;
  out.reaction_s = said.reaction_s;
  out.free_flows = said.free_flows;
  return out;
}

double drawn_tolerance(std::uint64_t seed, std::size_t human) {
  return random_normal({seed, kToleranceStream, human}, 0);
}

void start_condition(const PhysicsHuman& human, PhysicsState& state, const HumanPhysics& start) {
  if (!human.condition) return;
  // Put there from the surface this moment, where it breathed air.
  diver::ConditionInputs in = inputs_of(human, nullptr, 0.0, start);
  in.breath.inspired_share = diver::kAir.oxygen;
  in.breath.ambient_pa = human.body.surface_pa;
  state.conditions()[human.condition->place] = diver::rested(settings_at(human, start), in);
}

Ability ability_of(const PhysicsHuman& human, const PhysicsState& before) {
  if (!human.condition || !human.condition->acts) return {};
  const diver::ConditionState& state = before.conditions()[human.condition->place];
  return {state.lost == 0, diver::holds_breath(state), state.slowing,
          state.strength,  state.cold.shiver_w,        state.slack};
}

namespace {

// Whether another breathes from that regulator; of two who took it in the same step the first.
bool taken(std::span<const PhysicsHuman> humans, std::size_t index, bool has_it,
           const PhysicsState& before) {
  const PhysicsRegulator& wanted = *humans[index].regulator;
  const std::size_t rivals = has_it ? index : humans.size();
  for (std::size_t k = 0; k < rivals; ++k) {
    const auto& other = humans[k].regulator;
    if (k != index && other && other->donor == wanted.donor &&
        other->donor_tank == wanted.donor_tank && before.regulators()[other->place].donor != 0)
      return true;
  }
  return false;
}

}  // namespace

std::optional<diver::BorrowedTank> borrow(std::span<const PhysicsHuman> humans, std::size_t index,
                                          const Ability& able, const PhysicsInputs& inputs,
                                          const PhysicsState& before, double dt_s,
                                          PhysicsState& after) {
  const PhysicsHuman& human = humans[index];
  if (!human.regulator || !human.regulator->donor) return std::nullopt;
  const PhysicsRegulator& regulator = *human.regulator;
  const std::size_t donor = *regulator.donor;
  RegulatorState& state = after.regulators()[regulator.place];
  const SupplyChoice choice = inputs.regulators()[regulator.place].use.supply;
  const bool reaches = mouths_apart_m(humans, index, donor, before) <= regulator.hose_m;
  const bool wants = choice == SupplyChoice::kDonor ||
                     (choice == SupplyChoice::kByItself &&
                      (state.donor != 0 || all_empty(human, before.humans()[index])));
  if (state.donor != 0 && !reaches) ++state.torn;
  const bool another = taken(humans, index, state.donor != 0, before);
  if (!wants || !reaches || another) state.donor = 0;
  const bool reaches_for = wants && reaches && !another && state.donor == 0 && able.conscious;
  state.wanted_s = reaches_for ? state.wanted_s + dt_s : 0.0;
  // A client's hands are as quick as the client.
  const double takes_s = choice == SupplyChoice::kDonor ? 0.0 : regulator.reaction_s * able.slowing;
  if (reaches_for && state.wanted_s >= takes_s) {
    state.donor = donor + 1;
    state.wanted_s = 0.0;
  }
  if (state.donor == 0) return std::nullopt;
  return diver::BorrowedTank{humans[donor].body.tanks[regulator.donor_tank],
                             before.humans()[donor].human.life.tanks.moles[regulator.donor_tank]};
}

void blow_off(const PhysicsHuman& human, const PhysicsInputs& inputs, const sim::StepTime& time,
              PhysicsState& after, HumanPhysics& diver) {
  const PhysicsRegulator& regulator = *human.regulator;
  const double back_pa = ambient_pa(human, diver), now_s = time.time_s();
  const auto flow = [&](std::size_t tank, double area_m2) {
    return diver::flow_from(human.body, diver.human.life.tanks, tank, area_m2, back_pa,
                            time.step_s);
  };
  double moles = 0.0;
  switch (inputs.regulators()[regulator.place].use.flow) {
    case FlowChoice::kFlows:
      moles = flow(diver.human.held.tank, kOpenValve_m2);
      break;
    case FlowChoice::kHolds:
      break;
    case FlowChoice::kByScene:
      for (const scene::FreeFlow& said : regulator.free_flows)
        if (now_s >= said.at_s && now_s < said.until_s) moles += flow(said.tank, said.area_m2);
  }
  RegulatorState& state = after.regulators()[regulator.place];
  state.flow_moles_s = moles / time.step_s;
  state.blown_moles += moles;
}

void step_condition(const PhysicsHuman& human, const diver::GasMix* borrowed, double dt_s,
                    PhysicsState& after, const HumanPhysics& diver) {
  const PhysicsCondition& condition = *human.condition;
  diver::ConditionState& state = after.conditions()[condition.place];
  const double shiver_w = condition.acts ? state.cold.shiver_w : 0.0;
  diver::step_condition(settings_at(human, diver), inputs_of(human, borrowed, shiver_w, diver),
                        dt_s, state);
}

void settle_gas(std::span<const PhysicsHuman> humans, std::size_t index, double taken_moles,
                PhysicsState& after) {
  if (!(taken_moles > 0.0)) return;
  const PhysicsRegulator& regulator = *humans[index].regulator;
  double& moles = after.humans()[*regulator.donor].human.life.tanks.moles[regulator.donor_tank];
  moles = std::max(0.0, moles - taken_moles);
  after.regulators()[regulator.place].taken_moles += taken_moles;
}

ConditionReading condition_reading(const PhysicsHuman& human, const PhysicsState& state,
                                   const HumanPhysics& diver) {
  const PhysicsCondition& condition = *human.condition;
  const diver::ConditionState& now = state.conditions()[condition.place];
  const diver::RiskProxies& risk = diver.human.life.vitals.risk;
  return {.alveolar_mmhg = now.hypoxia.pressure_mmhg,
          .saturation = now.hypoxia.saturation,
          .hypoxia = now.hypoxia.dose,
          .oxygen = now.oxygen_dose / diver::oxygen_limit(condition.settings.oxygen_tolerance),
          .oxygen_risk = diver::oxygen_risk(now.oxygen_dose),
          .co2_mmhg = risk.co2_mmhg,
          .narcotic_depth_m = risk.narcotic_depth_m,
          .core_c = now.cold.core_c,
          .skin_c = now.cold.skin_c,
          .shiver_w = now.cold.shiver_w,
          .slowing = now.slowing,
          .strength = now.strength,
          .lost = now.lost,
          .lost_s = now.lost_s};
}

SupplyReading supply_reading(std::span<const PhysicsHuman> humans, std::size_t index,
                             const PhysicsState& state) {
  const PhysicsHuman& human = humans[index];
  const PhysicsRegulator& regulator = *human.regulator;
  const RegulatorState& now = state.regulators()[regulator.place];
  const diver::LifeState& life = state.humans()[index].human.life;
  SupplyReading out;
  out.donor = now.donor;
  out.fed = life.lungs.unfed_s == 0.0 ? 1 : 0;
  out.breathed_pa =
      now.donor != 0
          ? diver::tank_pressure(humans[now.donor - 1].body,
                                 state.humans()[now.donor - 1].human.life.tanks,
                                 regulator.donor_tank)
          : diver::tank_pressure(human.body, life.tanks, state.humans()[index].human.held.tank);
  if (regulator.donor) out.donor_m = mouths_apart_m(humans, index, *regulator.donor, state);
  out.taken_l = litres_of(now.taken_moles);
  out.blown_l = litres_of(now.blown_moles);
  out.flow_l_min = 60.0 * litres_of(now.flow_moles_s);
  out.torn = now.torn;
  return out;
}

}  // namespace neritic::testbed
