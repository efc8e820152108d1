#include "diver/swimmer.hpp"

#include <algorithm>
#include <cmath>

#include "diver/swimmer_constants.hpp"

namespace neritic::diver {
namespace {

using namespace swimming;

void follow(double& value, double wanted, double lag_s, double dt_s) {
  value += (wanted - value) * -std::expm1(-dt_s / lag_s);
}

// The value without its part that beats at that frequency. Trapezoidal state-variable filter
// (Zavalishin 2012, "The Art of VA Filter Design", 4.5): steady values pass whole.
double between_beats(BeatNotch& notch, double value, double hz, double dt_s) {
  constexpr double kDamping = 0.5;  // wide: beats change their pace
  const double g = std::tan(std::min(kPi * hz * dt_s, 1.2));
  const double first =
      (notch.first + g * (value - notch.second)) / (1.0 + g * (g + 2.0 * kDamping));
  const double second = notch.second + g * first;
  notch.first = 2.0 * first - notch.first;
  notch.second = 2.0 * second - notch.second;
  return value - 2.0 * kDamping * first;
}

// How hard to kick for that speed, within what the person has left: power goes with the cube of
// beats. Beats slower than kSlowestBeat_hz are smaller instead.
void pace(const Body& body, const SwimmerSettings& settings, double speed_m_s, double wanted_m_s,
          bool kicks, const LifeState& life, SwimmerState& swimmer, double dt_s) {
  const double error = wanted_m_s - speed_m_s;
  const auto needed_hz = [&] {
    return (wanted_m_s + 0.3 * error + 0.15 * swimmer.speed_sum) / kMetresABeat;
  };
  // Legs that rest already are not to rest for longer by what is remembered.
  if (kicks && (error > 0.0 || needed_hz() > 0.0))
    swimmer.speed_sum = std::clamp(swimmer.speed_sum + error * dt_s, -3.0, 3.0);
  const double kick_w = metabolic_power_w(life.limb_power_w, life.moving_power_w);
  const double strong_hz =
      std::max(swimmer.frequency_hz, 0.1) *
      std::cbrt(strongest_power_w(body.fitness, life.spent_j) / std::max(kick_w, 1.0));
  const double wanted_hz = std::clamp(needed_hz(), kSlowestBeat_hz, settings.most_frequency_hz);
  const double size = std::clamp(needed_hz() / kSlowestBeat_hz, 0.0, 1.0);
  follow(swimmer.effort, kicks ? size : 0.0, 1.0, dt_s);
  const double asked_hz = std::min(wanted_hz, strong_hz);
  follow(swimmer.frequency_hz, asked_hz, 1.0, dt_s);
  swimmer.phase_rad =
      std::fmod(swimmer.phase_rad + 2.0 * kPi * swimmer.frequency_hz * dt_s, 2.0 * kPi);
}

// Litres of excess lift of jacket and suit, with the lungs in the middle of a quiet breath. People
// feel it by the breath and the fin strokes that hold them in place.
double lifted_l(const Body& body, const HumanState& state) {
  const double weight_m3 = net_weight_n(body, state) / (body.water_kg_m3 * kGravity_m_s2);
  return 1e3 * (middle_of_quiet_breath(body) - state.life.lungs.volume_m3 - weight_m3);
}

bool can_fill(const Body& body, const HumanState& state) {
  return tank_pressure(body, state.life.tanks, 0) > kFillsJacket_pa;
}

bool is_awash(const HumanState& state) {
  return state.root.position_ned_m.z < kAwash_m;
}

// The gas in jacket and suit expands on the way up and shrinks on the way down, most near the
// surface. A diver who changes depth lets gas out, or in, at the same pace, so that the fins alone
// make the rate. A button is held until the lift is right, at most for kVent_s.
void hold_neutral(const Body& body, const HumanState& state, bool at_valve, bool steered,
                  SwimmerState& swimmer, HumanInputs& inputs) {
  swimmer.lift_sum = std::clamp(swimmer.lift_sum, -kChangeSum_l_s, kChangeSum_l_s);
  const bool rises = swimmer.rises > 0.0;
  // The change of lift that the way causes: an excess going up, a lack going down.
  const double brought_l = rises ? lifted_l(body, state) : -lifted_l(body, state);
  const bool goes_on = swimmer.button_s < 0.0;
  const LiftBand band = steered ? kSteeredBand : LiftBand{};
  const bool usual = goes_on ? brought_l > band.usual_to_l
                             : brought_l > kUsualAt_l && swimmer.button_s > kUsualWait_s;
  const bool unusual = goes_on ? brought_l < band.unusual_to_l
                               : brought_l < band.unusual_at_l && swimmer.button_s > band.wait_s;
  // Partly out of the water a body has less lift than it needs below: a person who steers fills no
  // jacket there, and empties it to go down.
  const bool awash = steered && is_awash(state);
  const bool too_light = awash ? !rises : rises ? usual : unusual;
  const bool lets_out = too_light && state.life.jacket_moles > kEmptyJacket_mol;
  const bool lets_in = (rises ? unusual : usual) && !awash && can_fill(body, state);
  if (!lets_out && !lets_in)
    swimmer.button_s = std::max(swimmer.button_s, 0.0);
  else if (!goes_on)
    swimmer.button_s = -kVent_s;
  inputs.buttons = lets_in ? kInflate : lets_out && at_valve ? kDump : 0;
}

// Rises and sinks by breath first, by the jacket where breath does not do.
void balance(const Body& body, double sink_too_much_m_s, bool steered, const HumanState& state,
             SwimmerState& swimmer, double dt_s, HumanInputs& inputs) {
  const bool at_valve = gas_at_dump(body, state.life.jacket_moles, thorax_place(body, state));
  // A diver who has to point the nose down to stay down is too light.
  const double rests = swimmer.rests;
  const double usual_l = 1.6 * sink_too_much_m_s + 0.1 * swimmer.climb_sum;
  const double want_l =
      steered ? kSteeredBreath_l_s * sink_too_much_m_s : (1.0 + kHoverBreath * rests) * usual_l;
  swimmer.lift_sum = std::clamp(swimmer.lift_sum + usual_l * dt_s, -12.0, 12.0);
  const double breath_m3 = std::clamp(1e-3 * (want_l + 0.08 * swimmer.lift_sum),
                                      steered ? -kSteeredOut_m3 : -kMostBreathBias_m3,
                                      steered ? kSteeredIn_m3 : kMostBreathBias_m3);
  follow(swimmer.breath_bias_m3, breath_m3, steered ? kSteeredLag_s : kBreathLag_s, dt_s);
  inputs.breath_bias_m3 = swimmer.breath_bias_m3;
  swimmer.button_s += dt_s;
  if (swimmer.rises != 0.0) return hold_neutral(body, state, at_valve, steered, swimmer, inputs);
  const double lifted = lifted_l(body, state);
  if (swimmer.button_s > kWait_s && std::abs(lifted) > kBreathHolds_l)
    swimmer.lift_sum =
        std::copysign(std::max(std::abs(swimmer.lift_sum), 1.01 * kSure_l_s), -lifted);
  const bool more = swimmer.lift_sum > 0.0;
  const double press_s = more ? kPress_s : kVentPress_s;
  if (swimmer.button_s < -press_s && (more || at_valve)) swimmer.button_s = -press_s;
  inputs.buttons = 0;
  if (swimmer.button_s < 0.0) {
    if (swimmer.button_s >= -press_s) inputs.buttons = more ? kInflate : kDump;
  } else if (swimmer.button_s > kWait_s && std::abs(swimmer.lift_sum) > kSure_l_s) {
    // There is nothing to let out of an empty jacket.
    if (more ? can_fill(body, state) : state.life.jacket_moles > kEmptyJacket_mol)
      swimmer.button_s = more ? -kPress_s : -kVent_s;
    swimmer.lift_sum *= 0.6;
  }
}

// Over ground, without the to and fro of waves.
Vec3 steady_velocity(const HumanState& state) {
  return state.root.attitude * state.root.velocity.linear() - state.held.waves_ned_m_s;
}

// The level part of the current without waves.
struct Drift {
  double x_m_s = 0.0, y_m_s = 0.0, m_s = 0.0;
};
Drift drift_of(const HumanState& state) {
  const Vec3 current = steady_current_ned_m_s(state.held);
  return {current.x, current.y, std::hypot(current.x, current.y)};
}
bool is_current(const Drift& drift) {
  return drift.m_s > kStill_m_s;
}

// Where the head is to point: to the goal, some way into a current from the side.
double wanted_heading(const SwimGoal& goal, const HumanState& state, double heading_rad) {
  const Vec3 way = goal.target_ned_m - state.root.position_ned_m;
  const double level = std::hypot(way.x, way.y);
  if (level < 0.1) return heading_rad;
  const Drift drift = drift_of(state);
  const double aside =
      (drift.y_m_s * way.x - drift.x_m_s * way.y) / level;  // to starboard of the way
  const double crab = std::asin(std::clamp(aside / std::max(goal.speed_m_s, 0.1), -0.7, 0.7));
  return std::atan2(way.y, way.x) - crab;
}

// Where the head of a hovering diver points in a current: into it, and so far to a side that the
// place comes nearer.
double into_current(const SwimGoal& goal, const HumanState& state) {
  const Vec3 way = goal.target_ned_m - state.root.position_ned_m;
  const Vec3 velocity = steady_velocity(state);
  const Drift drift = drift_of(state);
  const double x = -drift.x_m_s / drift.m_s, y = -drift.y_m_s / drift.m_s;
  const double aside_m = x * way.y - y * way.x, aside_m_s = x * velocity.y - y * velocity.x;
  const double crab_rad =
      (kAsideMetre * aside_m - kAsideSpeed_s * aside_m_s) / std::max(drift.m_s, kLeastDrift_m_s);
  return std::atan2(y, x) + std::clamp(crab_rad, -kMostCrab_rad, kMostCrab_rad);
}

// Whether a diver is too deep and has nothing that lifts him but his fins.
bool sinks_away(const Body& body, const HumanState& state, double below_m, SwimmerState& swimmer) {
  const bool lifted = body.jacket.capacity_m3 > 0.0 && can_fill(body, state);
  if (swimmer.goes_back != kKicksUp && (lifted || below_m < kSunk_m)) return false;
  swimmer.goes_back = below_m > kHardlyOff_m ? kKicksUp : 0;
  return swimmer.goes_back == kKicksUp;
}

// How fast a hovering diver swims against a current to stay, or to come back; not at all, once far
// enough upstream. In a slow current the kick waits until the head has come round.
double against_current_m_s(const SwimGoal& goal, const HumanState& state) {
  const Vec3 way = goal.target_ned_m - state.root.position_ned_m;
  const Drift drift = drift_of(state);
  const double upstream_m = -(way.x * drift.x_m_s + way.y * drift.y_m_s) / drift.m_s;
  const double off_rad = into_current(goal, state) - attitude_of(state.root.attitude).heading_rad;
  const double share =
      drift.m_s < kSlowCurrent_m_s ? std::clamp(2.0 * std::cos(off_rad) - 0.5, 0.0, 1.0) : 1.0;
  const double gain_m_s = std::min(kGainMetre_1_s * upstream_m, kMostGain_m_s);
  return share * std::clamp(drift.m_s + gain_m_s, 0.0, kMostAgainst_m_s);
}

// The goal of a hovering diver: to rest; to swim back once drifted off, or once tilted by more than
// posture corrects, since fins right a body that has way. In a current, to swim against it.
SwimGoal hover_goal(const Body& body, SwimGoal goal, const HumanState& state,
                    SwimmerState& swimmer) {
  const Vec3 way = goal.target_ned_m - state.root.position_ned_m;
  if (sinks_away(body, state, -way.z, swimmer)) {
    goal.speed_m_s = kKickUp_m_s;
    return goal;
  }
  const double off_m = std::hypot(way.x, way.y);
  const double tilt_rad = std::abs(attitude_of(state.root.attitude).pitch_rad);
  if (tilt_rad > kTilted_rad)
    swimmer.goes_back = kRightsHimself;
  else if (off_m > kAdrift_m && swimmer.goes_back == 0)
    swimmer.goes_back = kGoesBack;
  // Level again, righting is done: so fast, a diver would circle around a near place for ever.
  const bool there = off_m < kNear_m || swimmer.goes_back == kRightsHimself;
  if (there && tilt_rad < 0.5 * kTilted_rad) swimmer.goes_back = 0;
  const Drift drift = drift_of(state);
  if (swimmer.goes_back == kRightsHimself) {
    const double against_m_s =
        is_current(drift) ? drift.m_s + kRighting.each_metre_1_s * off_m : 0.0;
    if (tilt_rad <= kSteep_rad)
      goal.speed_m_s = std::min(kRighting.speed_m_s + against_m_s, kRighting.most_m_s);
  } else if (is_current(drift)) {
    goal.speed_m_s = against_current_m_s(goal, state);
  } else if (swimmer.goes_back == kGoesBack) {
    goal.speed_m_s = kBack_m_s;
  }
  return goal;
}

// Whether a body with little way stands, or hangs head down, so far off its course that fins would
// carry it up, or down, for metres before the water had turned it.
bool stands_off(const SwimGoal& goal, const HumanState& state, const SwimmerState& swimmer) {
  const Vec3 way = goal.target_ned_m - state.root.position_ned_m;
  const double climb_rad = std::atan2(-way.z, std::hypot(way.x, way.y));
  const double pitch_rad = attitude_of(state.root.attitude).pitch_rad;
  const bool goes_on = swimmer.goes_back == kRightsHimself;
  if (!goes_on && swimmer.rests < 0.5) return false;
  const double least_rad = goes_on ? kSteep_rad : kUpright_rad;
  return std::min(std::abs(pitch_rad), std::abs(pitch_rad - climb_rad)) > least_rad;
}

// Metres a second down to that depth. A place well above or below is approached at a rate that
// grows slowly.
double wanted_sink(double deeper_m, const std::optional<double>& climb_m_s, bool swims,
                   SwimmerState& swimmer, double dt_s) {
  if (climb_m_s) {
    swimmer.rises = *climb_m_s == 0.0 ? 0.0 : std::copysign(1.0, *climb_m_s);
    if (swimmer.rises == 0.0) swimmer.button_s = std::max(swimmer.button_s, 0.0);
    return -*climb_m_s;
  }
  const double to_go_m = std::copysign(1.0, -swimmer.rises) * deeper_m;
  if (swimmer.rises != 0.0 && to_go_m < kHardlyOff_m) {
    swimmer.rises = 0.0;
    swimmer.button_s = std::max(swimmer.button_s, 0.0);  // lets go of what was held on the way
  } else if (swimmer.rises == 0.0 && std::abs(deeper_m) > kWellOff_m) {
    swimmer.rises = std::copysign(kChangeBegin, -deeper_m);
  }
  double most_rise_m_s = kMostSink_m_s, most_sink_m_s = kMostSink_m_s;
  if (swimmer.rises != 0.0)
    follow(swimmer.rises, std::copysign(1.0, swimmer.rises), kChangeLag_s, dt_s);
  if (swimmer.rises > 0.0) most_rise_m_s = kMostRise_m_s * swimmer.rises;
  if (swimmer.rises < 0.0) most_sink_m_s *= -swimmer.rises;
  return std::clamp((swims ? 0.1 : 0.2) * deeper_m, -most_rise_m_s, most_sink_m_s);
}

// The hands of a hovering diver rest, turn him, or hold the place.
enum class Hands { kRest, kTurn, kHold };

// Moves the hands. kTurn turns the diver by turn_rad; kHold pushes ahead or back, and turns the
// diver until the place lies ahead or behind, whichever is nearer.
void scull(const SwimGoal& goal, const HumanState& state, Hands hands, double turn_rad,
           SwimmerState& swimmer, double dt_s) {
  const auto [heading, pitch, roll] = attitude_of(state.root.attitude);
  const Vec3 way = goal.target_ned_m - state.root.position_ned_m;
  const Vec3 velocity = steady_velocity(state);
  const double c = std::cos(heading), s = std::sin(heading);
  const double ahead_m = c * way.x + s * way.y, aside_m = c * way.y - s * way.x;
  if (hands == Hands::kHold)
    turn_rad = std::abs(aside_m) > kAside_m
                   ? std::atan2(std::copysign(aside_m, aside_m * ahead_m), std::abs(ahead_m))
                   : 0.0;
  const double turn =
      std::clamp(kScullTurn * turn_rad - kScullTurning_s * state.root.velocity[5], -1.0, 1.0);
  // Hands below the body pitch it.
  const double level = std::clamp(1.0 - 2.0 * std::abs(pitch) / kTilted_rad, 0.0, 1.0);
  const double most = level * (1.0 - 0.5 * std::abs(turn));
  const double push =
      hands == Hands::kHold
          ? std::clamp(kScullMetre * ahead_m - kScullSpeed_s * (c * velocity.x + s * velocity.y),
                       -most, most)
          : 0.0;
  const auto amplitude = [&](double share) {
    if (hands == Hands::kRest) return 0.0;
    const double stroke = std::clamp(share, -1.0, 1.0);
    return std::copysign(std::sqrt(std::abs(stroke)), stroke) * kScull_rad;  // drag: its square
  };
  follow(swimmer.sculls, hands == Hands::kRest ? 0.0 : 1.0, kScullsLag_s, dt_s);
  follow(swimmer.scull_left_rad, amplitude(push + turn), kSteeringLag_s, dt_s);
  follow(swimmer.scull_right_rad, amplitude(push - turn), kSteeringLag_s, dt_s);
  swimmer.scull_phase_rad =
      std::fmod(swimmer.scull_phase_rad + 2.0 * kPi / kScull_s * dt_s, 2.0 * kPi);
}

// 1 to -1 in the stroke, back to 1 in the rest of a turn.
double stroke_at(double phase_rad) {
  const double share = phase_rad / (2.0 * kPi);
  return share < kStroke ? std::cos(kPi * share / kStroke)
                         : -std::cos(kPi * (share - kStroke) / (1.0 - kStroke));
}

// 1: little way, legs do not steer; 0: way enough.
double slow(const SwimmerState& swimmer) {
  return std::min(1.0, 2.5 * swimmer.rests);
}

// Spine and legs, for the head to come round by turn (to starboard) and nose_up, without rolling.
void steer(double turn, double nose_up, double roll_rad, const Vec6& velocity,
           SwimmerState& swimmer, double dt_s) {
  // Without way there is no flow over the legs that rights the body: pitch is firmer then.
  const double rests = swimmer.rests;
  // Rolling with each beat is the kick's: legs that worked against it would take from its thrust.
  const double hz = std::max(swimmer.frequency_hz, 0.25);
  const auto felt = [&](BeatNotch& notch, double value) {  // legs that rest do not beat
    return std::lerp(between_beats(notch, value, hz, dt_s), value, rests);
  };
  const double roll = felt(swimmer.roll, roll_rad);
  const double roll_rate = felt(swimmer.roll_rate, velocity[3]);
  const double pitch_rate = velocity[4];
  const double yaw_rate = velocity[5];
  const double yaw = std::clamp(1.5 * std::clamp(turn, -0.5, 0.5) - 2.0 * yaw_rate, -1.0, 1.0);
  // A diver with little way and the nose up turns by leaning: the legs that lift it lean along.
  const double leans =
      slow(swimmer) * std::clamp(-2.0 * swimmer.lift_rad / kMostLift_rad, 0.0, 1.0);
  swimmer.roll_sum = rests * std::clamp(swimmer.roll_sum + roll * dt_s, -1.0, 1.0);
  // Legs right the less the slower they are: the gain goes with the inverse square of the way of a
  // beat, from 1 at 0.6 m/s to 4 at 0.3. Swimmer.WithoutAJacketDoesNotRollOver holds it.
  const double way_m_s = kMetresABeat * hz;
  const double firm = std::lerp(std::clamp(0.36 / (way_m_s * way_m_s), 1.0, 4.0), 1.0, rests);
  const double tilt = std::clamp(2.0 * firm * (roll - leans * yaw * kMostBank_rad) +
                                     std::sqrt(firm) * roll_rate + 0.5 * swimmer.roll_sum,
                                 -1.0, 1.0);
  // A resting diver corrects the roll by bending to a side, which moves trunk and legs apart.
  const double aside = tilt * std::max(leans, slow(swimmer));
  const double turns = yaw * (1.0 - leans);
  const double bend = turns + aside * (1.0 - std::abs(turns));
  follow(swimmer.bend_rad, bend * kMostBend_rad, kSteeringLag_s, dt_s);
  follow(swimmer.legs_aside_rad, aside * kMostAside_rad, kSteeringLag_s, dt_s);
  follow(swimmer.left_more, yaw * kMostLeftMore * (1.0 + rests), kSteeringLag_s, dt_s);
  swimmer.pitch_sum = std::clamp(swimmer.pitch_sum + nose_up * dt_s, -2.5, 2.5);
  const double pitch = (2.5 + 3.5 * rests) * nose_up - (3.0 + 3.0 * rests) * pitch_rate +
                       (0.15 + 0.35 * rests) * swimmer.pitch_sum;
  follow(swimmer.lift_rad, std::clamp(-pitch, -1.0, 1.0) * kMostLift_rad, kSteeringLag_s, dt_s);
  // The kick that rights has straight knees.
  const double bends = swimmer.goes_back == kRightsHimself ? 0.0 : kHoverKnees * rests;
  follow(swimmer.knees_rad, bends * std::max(-swimmer.lift_rad, 0.0), kKneesLag_s, dt_s);
  const double treads = std::clamp((std::abs(pitch) - kTreads) / (1.0 - kTreads), 0.0, 1.0);
  follow(swimmer.tread, rests * treads, kSteeringLag_s, dt_s);
  swimmer.tread_phase_rad =
      std::fmod(swimmer.tread_phase_rad + 2.0 * kPi * kTread_hz * dt_s, 2.0 * kPi);
  const double most_twist_rad = std::lerp(kMostTwist_rad, kMostSlowTwist_rad, (firm - 1.0) / 3.0);
  follow(swimmer.twist_rad, -tilt * most_twist_rad, kSteeringLag_s, dt_s);
}

JointRotations posture_for(const Body& body, const SwimmerSettings& settings,
                           const SwimmerState& swimmer) {
  const double rests = swimmer.rests;
  JointAngles joints = streamlined(body);
  FlutterKick kick = settings.kick;
  kick.amplitude_m *= swimmer.effort;
  kick.lift_rad = swimmer.lift_rad;
  kick.twist_rad = swimmer.twist_rad;
  kick.left_more = swimmer.left_more;
  set_flutter(joints, body, kick, swimmer.phase_rad);
  for (const Segment spine : {kAbdomen, kThorax}) {
    joints[joint_of(spine)].y =
        -(0.25 + (kHoverBend - 0.25) * rests) * swimmer.lift_rad - rests * swimmer.stoop_rad;
    joints[joint_of(spine)].z = 0.5 * swimmer.bend_rad;
  }
  for (const Segment leg : {kLeftUpperLeg, kRightUpperLeg}) {
    joints[joint_of(leg)].y -= rests * swimmer.stoop_rad;
    // Not all of it with way: it turns.
    joints[joint_of(leg)].z = -std::min(1.0, 1.8 * rests) * swimmer.legs_aside_rad;
  }
  // Drag goes with the square of the beat.
  const double tread_rad =
      kTread_rad * std::sqrt(swimmer.tread) * std::sin(swimmer.tread_phase_rad);
  joints[joint_of(kLeftLowerLeg)].y += tread_rad;
  joints[joint_of(kRightLowerLeg)].y -= tread_rad;
  for (const Segment shin : {kLeftLowerLeg, kRightLowerLeg})
    joints[joint_of(shin)].y -= rests * swimmer.knees_rad;
  for (const Segment arm : {kLeftUpperArm, kRightUpperArm})
    joints[joint_of(arm)].y = kHoverArms * rests * std::max(swimmer.lift_rad, 0.0);
  const double stroke = stroke_at(swimmer.scull_phase_rad);
  // Forearms hang down, wherever the upper arms point.
  const double hangs_rad = std::max(0.5 * kPi - joints[joint_of(kLeftUpperArm)].y, 0.0);
  joints[joint_of(kLeftForearm)].y =
      std::max(swimmer.sculls * hangs_rad + swimmer.scull_left_rad * stroke, 0.0);
  joints[joint_of(kRightForearm)].y =
      std::max(swimmer.sculls * hangs_rad + swimmer.scull_right_rad * stroke, 0.0);
  joints[joint_of(kHead)].z = 0.8 * swimmer.bend_rad;
  return rotations_of(joints);
}

}  // namespace

HumanAttitude attitude_of(const Quat& q) {
  return {std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z)),
          std::asin(std::clamp(2.0 * (q.w * q.y - q.z * q.x), -1.0, 1.0)),
          std::atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))};
}

void swim(const Body& body, const SwimmerSettings& settings, const SwimGoal& asked,
          const HumanState& state, SwimmerState& swimmer, double dt_s, HumanInputs& inputs) {
  const bool hovers =
      asked.speed_m_s <= settings.gliding_speed_m_s || stands_off(asked, state, swimmer);
  if (!hovers) swimmer.goes_back = 0;
  const SwimGoal goal =
      hovers ? hover_goal(body, {asked.target_ned_m, 0.0}, state, swimmer) : asked;
  const HumanAttitude attitude = attitude_of(state.root.attitude);
  const Vec3 velocity_ned = state.root.attitude * state.root.velocity.linear();
  const Vec3 ahead_ned = state.root.attitude * Vec3(1.0, 0.0, 0.0);
  const double ahead_m_s = glm::dot(velocity_ned - state.held.current_ned_m_s, ahead_ned);
  const Drift drift = drift_of(state);
  const bool against = hovers && is_current(drift) && swimmer.goes_back != kKicksUp &&
                       swimmer.goes_back != kRightsHimself;
  const bool slowly = against && drift.m_s < kSlowCurrent_m_s;
  const bool swims = against || goal.speed_m_s > settings.gliding_speed_m_s;
  const bool steered = asked.climb_m_s.has_value();
  const double deeper_m = goal.target_ned_m.z - state.root.position_ned_m.z;
  const double sink_m_s = wanted_sink(deeper_m, asked.climb_m_s, swims, swimmer, dt_s);
  const double too_much_m_s = steady_velocity(state).z - sink_m_s;
  swimmer.climb_sum = swims ? std::clamp(swimmer.climb_sum + too_much_m_s * dt_s, -3.0, 3.0) : 0.0;
  const double way = std::clamp(ahead_m_s / kWay_m_s, 0.0, 1.0);
  follow(swimmer.rests, 1.0 - swimmer.effort * way, 0.5, dt_s);
  pace(body, settings, ahead_m_s, goal.speed_m_s, swims, state.life, swimmer, dt_s);
  balance(body, too_much_m_s, steered, state, swimmer, dt_s, inputs);

  double turn = 0.0, pitch = 0.0;
  if (swims) {
    const double wanted =
        against ? into_current(goal, state) : wanted_heading(goal, state, attitude.heading_rad);
    turn = std::remainder(wanted - attitude.heading_rad, 2.0 * kPi);
    // Right behind: on round the same side, whichever is the nearer just now.
    if (std::abs(turn) < kBehind_rad || swimmer.turn_side == 0.0)
      swimmer.turn_side = std::copysign(1.0, turn);
    turn = std::copysign(turn, swimmer.turn_side);
    const bool changes = swimmer.rises != 0.0;
    if (changes && !steered) turn = std::clamp(turn, -kChangeTurn_rad, kChangeTurn_rad);
    const double firm = steered ? kSteeredFirm : changes ? kChangeFirm : 1.0;
    const double climb_m_s =
        -sink_m_s + firm * 0.3 * too_much_m_s + firm * 0.04 * swimmer.climb_sum;
    pitch = std::clamp(climb_m_s / std::max(goal.speed_m_s, 0.2), -kMostPitch_rad, kMostPitch_rad);
    // Legs that pitch a body without way push it the wrong way first.
    if (steered) pitch *= std::lerp(kSteeredRestPitch, 1.0, way);
    // With so little way breath holds the depth.
    if (slowly)
      pitch *= std::clamp((goal.speed_m_s - settings.gliding_speed_m_s) / kLevelWay_m_s, 0.0, 1.0);
  }
  const bool level = std::abs(attitude.pitch_rad) < kTilted_rad;
  const Hands hands = !hovers || !level                            ? Hands::kRest
                      : !swims                                     ? Hands::kHold
                      : slowly && std::abs(turn) > kOffHeading_rad ? Hands::kTurn
                                                                   : Hands::kRest;
  scull(goal, state, hands, turn, swimmer, dt_s);
  const bool fills = (inputs.buttons & kInflate) != 0;
  const bool vents = swimmer.button_s < 0.0 && swimmer.lift_sum < 0.0 && !fills;
  // On a way that a person steers the pitch is enough for a valve, but at the surface.
  const bool climbs = steered && swimmer.rises != 0.0 && !is_awash(state);
  if (vents && !climbs) pitch = std::max(pitch, kVentPitch_rad);
  // Head up, with the back bent against it, no valve of the jacket is high enough: the back
  // goes straight, and the valve at the shoulder lets the gas out.
  const bool straightens = vents && attitude.pitch_rad > kTilted_rad;
  if (straightens) {
    pitch = attitude.pitch_rad;
    swimmer.pitch_sum = 0.0;
  }
  const double upright = (std::abs(attitude.pitch_rad) - kTilted_rad) / (kSteep_rad - kTilted_rad);
  const double stoops =
      hovers && !straightens && attitude.pitch_rad > 0.0 ? std::clamp(upright, 0.0, 1.0) : 0.0;
  follow(swimmer.stoop_rad, stoops * kStoop_rad, kStoopLag_s, dt_s);
  // A standing diver has no roll.
  const double roll_rad = attitude.roll_rad * std::cos(attitude.pitch_rad);
  steer(turn, pitch - attitude.pitch_rad, roll_rad, state.root.velocity, swimmer, dt_s);
  inputs.joints = posture_for(body, settings, swimmer);
}

}  // namespace neritic::diver
