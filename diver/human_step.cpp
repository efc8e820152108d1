#include "diver/human_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace neritic::diver {
namespace {

constexpr double kMostCurrent_m_s = 100.0;
constexpr double kMostDistance_m = 1e9;
constexpr double kMostPower_w = 1e4;
constexpr double kMostVentilation = 400.0;  // l/min
constexpr double kMostBias_m3 = 5e-3;
constexpr double kLongestStep_s = 10.0;
constexpr double kReserve_pa = 50e5;
// Effort is what limbs did over so long.
constexpr double kPowerLag_s = 2.0;

bool within(double value, double most) {  // NaN fails
  return std::abs(value) <= most;
}
bool within(const Vec3& v, double most) {
  return within(v.x, most) && within(v.y, most) && within(v.z, most);
}

template <class T>
void take(bool good, const T& value, T& held, std::uint64_t& refused) {
  if (good)
    held = value;
  else
    ++refused;
}

// A rotation that is nearly one becomes one.
bool take_rotation(const Quat& q, Quat& held) {
  const double length = glm::length(q);
  if (!(length > 0.5 && length < 2.0)) return false;
  held = q / length;
  return true;
}

void take_inputs(const HumanInputs& in, HumanState& state) {
  HumanInputs& held = state.held;
  std::uint64_t& refused = state.refused_inputs;
  for (std::size_t i = 0; i < kJoints; ++i)
    if (!take_rotation(in.joints[i], held.joints[i])) ++refused;
  for (const auto velocity : {&HumanInputs::current_ned_m_s, &HumanInputs::waves_ned_m_s})
    take(within(in.*velocity, kMostCurrent_m_s), in.*velocity, held.*velocity, refused);
  for (const auto acceleration :
       {&HumanInputs::current_change_ned_m_s2, &HumanInputs::water_acceleration_ned_m_s2})
    take(within(in.*acceleration, kMostWaterAcceleration_m_s2), in.*acceleration,
         held.*acceleration, refused);
  take(in.other_power_w >= 0.0 && in.other_power_w <= kMostPower_w, in.other_power_w,
       held.other_power_w, refused);
  take(in.ventilation_l_min >= 0.0 && in.ventilation_l_min <= kMostVentilation,
       in.ventilation_l_min, held.ventilation_l_min, refused);
  take(within(in.breath_bias_m3, kMostBias_m3), in.breath_bias_m3, held.breath_bias_m3, refused);
  take(in.hold_breath <= 1, in.hold_breath, held.hold_breath, refused);
  take(in.buttons <= kAllButtons, in.buttons, held.buttons, refused);
  take(in.tank < kMaxTanks, in.tank, held.tank, refused);
  refused += static_cast<std::uint64_t>(take_instruments(in.instruments, held.instruments));
}

// Eyes look ahead: out of the face.
Vec3 face_ned(const HumanState& state) {
  Quat q = state.root.attitude;
  for (const Segment segment : {kAbdomen, kThorax, kHead})
    q = q * state.limbs.rotation[joint_of(segment)];
  return glm::normalize(q * Vec3(0.0, 0.0, 1.0));
}

const GasMix& breathed_mix(const Body& body, const HumanState& state) {
  return state.held.tank < body.tank_count ? body.tanks[state.held.tank].mix : kAir;
}

// Litres and breaths a minute; none while the breath is held, or nothing comes to breathe.
struct Breathing {
  double minute_l = 0.0, breaths_min = 0.0;
};
Breathing breathing_of(const Body& body, const HumanState& state, double ambient_pa) {
  if (state.held.hold_breath != 0 || state.life.lungs.unfed_s > 0.0) return {};
  const double minute_l = state.held.ventilation_l_min > 0.0
                              ? state.held.ventilation_l_min
                              : ventilation_l_min(body, state.life.lungs.oxygen_l_min,
                                                  breathed_mix(body, state), ambient_pa);
  return {minute_l, 1e-3 * minute_l / tidal_volume(body, minute_l)};
}

void live(const Body& body, HumanState& state, double dt_s,
          const BorrowedTank* borrowed = nullptr) {
  VitalInputs in;
  in.oxygen_l_min = state.life.lungs.oxygen_l_min;
  in.most_oxygen_l_min = body.fitness.most_oxygen_l_min;
  in.mix = borrowed ? borrowed->place.mix : breathed_mix(body, state);
  in.ambient_pa = pressure_at(body, state.root.position_ned_m.z);
  in.surface_pa = body.surface_pa;
  in.cns_percent = state.life.computer.oxygen.cns_percent;
  const Breathing breathing = breathing_of(body, state, in.ambient_pa);
  in.ventilation_l_min = breathing.minute_l;
  in.breath_bpm = breathing.breaths_min;
  in.face_ned = face_ned(state);
  step_vitals(state.held.instruments, in, dt_s, state.life.vitals);
}

// into_s: of the step, when this part of it begins.
void substep(const Body& body, HumanState& state, double into_s, double dt_s,
             BorrowedTank* borrowed) {
  const HumanInputs& in = state.held;
  LifeState& life = state.life;
  // Gas where the body is now, then motion with that gas.
  const double ambient_pa = pressure_at(body, state.root.position_ned_m.z);
  BreathInputs breath;
  const double effort_w =
      metabolic_power_w(life.limb_power_w + in.other_power_w, life.moving_power_w);
  life.spent_j = spent_after(body.fitness, life.spent_j, effort_w, dt_s);
  breath.oxygen_demand_l_min = oxygen_demand_l_min(body.fitness, effort_w, life.spent_j);
  breath.ventilation_l_min = in.ventilation_l_min;
  breath.bias_m3 = in.breath_bias_m3;
  breath.hold = in.hold_breath != 0;
  breath.tank = in.tank;
  step_lungs(body, life.lungs, life.tanks, breath, ambient_pa, dt_s, borrowed);
  step_jacket(body, life.jacket_moles, life.tanks, in.buttons, thorax_place(body, state), dt_s);

  const LimbState before = state.limbs;
  state.far_joints += static_cast<std::uint64_t>(follow_limbs(state.limbs, in.joints, dt_s));
  const LimbWork work = move_root(body, state.root, before, state.limbs, gas_load(body, state),
                                  {in.current_ned_m_s + into_s * in.current_change_ned_m_s2,
                                   in.current_change_ned_m_s2, in.water_acceleration_ned_m_s2},
                                  dt_s);
  // Muscles that brake take no work back.
  const double power_w = std::clamp(work.power_w, 0.0, kMostPower_w);
  life.limb_work_j += power_w * dt_s;
  const double follows = -std::expm1(-dt_s / kPowerLag_s);
  life.limb_power_w += (power_w - life.limb_power_w) * follows;
  const double moving_w = std::min(work.moving_w, kMostPower_w);
  life.moving_power_w += (moving_w - life.moving_power_w) * follows;
}

}  // namespace

HumanState step(const Body& body, const HumanState& state, const HumanInputs& inputs, double dt_s,
                double longest_substep_s, BorrowedTank* borrowed) {
  HumanState next = state;
  take_inputs(inputs, next);
  if (!(dt_s > 0.0 && dt_s <= kLongestStep_s)) {
    ++next.refused_inputs;
    return next;
  }
  // A step that is as long as a substep, but for rounding, is one.
  const double count = std::ceil(dt_s / longest_substep_s - 1e-9);
  for (int i = 0; i < static_cast<int>(count); ++i)
    substep(body, next, i * (dt_s / count), dt_s / count, borrowed);
  live(body, next, dt_s, borrowed);
  return next;
}

HumanState start_at(const Body& body, const Vec3& position_ned_m, const Quat& ned_from_body,
                    const JointRotations& joints) {
  HumanState state;
  teleport(state, position_ned_m, ned_from_body);
  state.limbs.rotation = state.held.joints = joints;
  state.life.tanks = full_tanks(body);
  state.life.lungs.volume_m3 = middle_of_quiet_breath(body);
  state.life.lungs.phase_rad = 0.5 * kPi;  // half full, breathing in
  const double missing_m3 = net_weight_n(body, state) / (body.water_kg_m3 * kGravity_m_s2);
  if (missing_m3 > 0.0)
    state.life.jacket_moles = jacket_moles(body, missing_m3, thorax_place(body, state));
  live(body, state, std::numeric_limits<double>::infinity());  // has been there for long
  return state;
}

bool teleport(HumanState& state, const Vec3& position_ned_m, const Quat& ned_from_body) {
  if (!within(position_ned_m, kMostDistance_m)) return false;
  if (!take_rotation(ned_from_body, state.root.attitude)) return false;
  state.root.position_ned_m = position_ned_m;
  state.root.velocity = {};
  return true;
}

GasLoad gas_load(const Body& body, const HumanState& state) {
  GasLoad load;
  load.lungs_m3 = state.life.lungs.volume_m3;
  if (state.life.jacket_moles > 0.0) {
    const JacketGas gas = jacket_gas(body, state.life.jacket_moles, thorax_place(body, state));
    load.jacket_m3 = gas.volume_m3;
    load.jacket_at_m = gas.centre_m;
  }
  for (std::size_t i = 0; i < body.tank_count; ++i)
    load.tank_kg[i] = state.life.tanks.moles[i] * molar_mass(body.tanks[i].mix);
  return load;
}

ThoraxPlace thorax_place(const Body& body, const HumanState& state) {
  // Only the spine is between the hips and the thorax.
  const Quat abdomen = state.limbs.rotation[joint_of(kAbdomen)];
  const Quat thorax = abdomen * state.limbs.rotation[joint_of(kThorax)];
  const Vec3 at = body.segments[kAbdomen].joint_m + abdomen * body.segments[kThorax].joint_m;
  const Quat& root = state.root.attitude;
  return {glm::conjugate(root * thorax) * Vec3(0.0, 0.0, -1.0),
          state.root.position_ned_m.z + (root * at).z};
}

double net_weight_n(const Body& body, const HumanState& state) {
  const Immersion immersion{glm::conjugate(state.root.attitude) * Vec3(0.0, 0.0, 1.0),
                            state.root.position_ned_m.z};
  const StaticForces still = static_forces(body, posture_of(body, state.limbs.rotation, {}), {},
                                           immersion, gas_load(body, state));
  return glm::dot(still.wrench.linear(), immersion.down);
}

GasReading read_gas(const Body& body, const HumanState& state) {
  GasReading out;
  const std::size_t tank = state.held.tank;
  out.ambient_pa = pressure_at(body, state.root.position_ned_m.z);
  out.tank_pa = tank_pressure(body, state.life.tanks, tank);
  const Breathing breathing = breathing_of(body, state, out.ambient_pa);
  out.ventilation_l_min = breathing.minute_l;
  out.breaths_min = breathing.breaths_min;
  out.remaining_s =
      remaining_s(body, state.life.tanks, tank, out.ventilation_l_min, out.ambient_pa, kReserve_pa);
  out.jacket_m3 = jacket_gas(body, state.life.jacket_moles, thorax_place(body, state)).volume_m3;
  return out;
}

}  // namespace neritic::diver
