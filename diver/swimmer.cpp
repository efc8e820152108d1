#include "diver/swimmer.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

// What a kick gives for each beat a second with full gear, m; the rest is learned while swimming.
constexpr double kMetresABeat = 0.52;
constexpr double kMostLift_rad = radians(18.0), kMostTwist_rad = radians(14.0);
constexpr double kMostLeftMore = 0.5;
constexpr double kMostBend_rad = radians(18.0), kMostAside_rad = radians(25.0);
// Nobody swims for minutes with more: a person's limit, not the water's.
constexpr double kMostKick_w = 300.0;
constexpr double kMostPitch_rad = radians(30.0);
constexpr double kMostSink_m_s = 0.15;  // 9 m a minute
// Who is to change depth by so much holds the jacket neutral on the way, until so near; and begins
// with that share of the rate, for which pitch and jacket have seconds to come. Up it goes more
// slowly than the 9 m a minute that is taught (30 feet: NOAA Diving Manual).
constexpr double kMostRise_m_s = 0.12, kChangeBegin = 0.2, kChangeLag_s = 12.0;
constexpr double kWellOff_m = 1.3, kHardlyOff_m = 0.2;
// The pitch holds that rate so much more firmly than a depth. Sharp turns would bring the head up.
constexpr double kChangeFirm = 2.0, kChangeTurn_rad = 0.2;
constexpr double kMostBreathBias_m3 = 0.6e-3;
// So fast through the water legs steer; slower, posture does.
constexpr double kWay_m_s = 0.25;
// To that side at most who turns by leaning.
constexpr double kMostBank_rad = radians(20.0);
// A place farther round than this lies behind.
constexpr double kBehind_rad = radians(140.0);
// Who hovers bends the back as far as this in each of two joints: that shifts the jacket's gas,
// which else runs to the higher end and turns the diver on his head.
constexpr double kHoverBend = 1.0;  // of the legs' lift; 0.25 while swimming
// And the arms, to the front: their weight lowers the head.
constexpr double kHoverArms = 4.0;  // of the legs' lift towards the belly
// Where that is hardly enough, shins beat in turn, so far and so often: fins that move hold on to
// the water, which slows tilting, and push a little.
constexpr double kTread_rad = radians(5.0), kTread_hz = 1.0;
// Up to that share of what steering may ask for, posture alone holds the pitch.
constexpr double kTreads = 0.3;
// Who hovers has no fins to hold the depth: breath answers so much more.
constexpr double kHoverBreath = 1.5;
// Who hovers swims back to the place from so far away, or righting from such a tilt, and rests
// again from so near.
constexpr double kAdrift_m = 3.0, kNear_m = 0.7, kTilted_rad = radians(20.0);
// Steeper than this a kick would carry him up or down: who hovers stoops, so far in each of two
// joints of the back, the legs behind him, until he is less so.
constexpr double kSteep_rad = radians(25.0), kStoop_rad = radians(17.0), kStoopLag_s = 0.7;
// More than kStill_m_s is a current: aims so far upstream of the place.
constexpr double kStill_m_s = 0.06, kAimAhead_m = 4.0;
// So fast in still water, and so much faster for each metre off the place. Back to the place no
// faster than who keeps beside can follow. Who rights himself needs way.
struct WayBack {
  double speed_m_s, each_metre_1_s, most_m_s;
};
constexpr WayBack kBack{0.15, 0.01, 0.5}, kRighting{0.35, 0.15, 0.8};
constexpr std::uint64_t kGoesBack = 1, kRightsHimself = 2;
// Nobody moves a joint from one side to the other within less, nor breathes otherwise.
constexpr double kSteeringLag_s = 0.4, kBreathLag_s = 0.7;
// Buttons are pressed for a moment, after so much want of breath, and then waited for.
constexpr double kPress_s = 0.25, kWait_s = 3.0, kSure_l_s = 4.0;
// So much too much or too little lift is most of what breath can hold: a button is pressed without
// waiting for the want to add up.
constexpr double kBreathHolds_l = 0.5;
// Who rises lets gas out where so much too much lifts, down to so much, and in where so much is
// missing; who sinks the other way round. Breath holds the rest: so much want of it is remembered.
constexpr double kUsualAt_l = 0.2, kUsualTo_l = 0.0, kUsualWait_s = 2.0;
constexpr double kUnusualAt_l = -0.8, kUnusualTo_l = -0.5;
constexpr double kChangeSum_l_s = 2.0;
// Jackets that hold fewer moles are empty; tanks below that pressure fill none.
constexpr double kEmptyJacket_mol = 1e-3, kFillsJacket_pa = 5e5;
// Gas leaves at the higher end of the trunk: the head goes up for that, at most so long.
constexpr double kVent_s = 6.0, kVentPress_s = 0.08, kVentPitch_rad = radians(14.0);

void follow(double& value, double wanted, double lag_s, double dt_s) {
  value += (wanted - value) * -std::expm1(-dt_s / lag_s);
}

// The value without what of it beats at that frequency. Trapezoidal state-variable filter
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

// How hard to kick for that speed, within what legs give: their power goes with the cube of beats.
void pace(const SwimmerSettings& settings, double speed_m_s, double wanted_m_s, double power_w,
          SwimmerState& swimmer, double dt_s) {
  const bool kicks = wanted_m_s > settings.gliding_speed_m_s;
  follow(swimmer.effort, kicks ? 1.0 : 0.0, 1.0, dt_s);
  const double error = wanted_m_s - speed_m_s;
  if (kicks) swimmer.speed_sum = std::clamp(swimmer.speed_sum + error * dt_s, -3.0, 3.0);
  const double strong_hz =
      std::max(swimmer.frequency_hz, 0.1) * std::cbrt(kMostKick_w / std::max(power_w, 1.0));
  const double wanted_hz =
      std::clamp((wanted_m_s + 0.3 * error + 0.15 * swimmer.speed_sum) / kMetresABeat, 0.25,
                 settings.most_frequency_hz);
  const double asked_hz = std::min(wanted_hz, strong_hz);
  follow(swimmer.frequency_hz, asked_hz, 1.0, dt_s);
  swimmer.phase_rad =
      std::fmod(swimmer.phase_rad + 2.0 * kPi * swimmer.frequency_hz * dt_s, 2.0 * kPi);
}

// Litres by which the diver floats in the middle of a quiet breath: what jacket and suit lift too
// much. People feel it by what breath and fins have to hold.
double lifted_l(const Body& body, const HumanState& state) {
  const double weight_m3 = net_weight_n(body, state) / (body.water_kg_m3 * kGravity_m_s2);
  return 1e3 * (middle_of_quiet_breath(body) - state.life.lungs.volume_m3 - weight_m3);
}

bool can_fill(const Body& body, const HumanState& state) {
  return tank_pressure(body, state.life.tanks, 0) > kFillsJacket_pa;
}

// What jacket and suit hold grows on the way up and shrinks on the way down, the faster the
// shallower: who changes depth lets gas out, or in, as it does, so that fins alone make the rate. A
// button is held until enough is out or in, or let go at kVent_s.
void hold_neutral(const Body& body, const HumanState& state, bool at_valve, SwimmerState& swimmer,
                  HumanInputs& inputs) {
  swimmer.lift_sum = std::clamp(swimmer.lift_sum, -kChangeSum_l_s, kChangeSum_l_s);
  const bool rises = swimmer.rises > 0.0;
  // What the way brings: too much lift going up, too little going down.
  const double brought_l = rises ? lifted_l(body, state) : -lifted_l(body, state);
  const bool goes_on = swimmer.button_s < 0.0;
  const bool usual =
      goes_on ? brought_l > kUsualTo_l : brought_l > kUsualAt_l && swimmer.button_s > kUsualWait_s;
  const bool unusual =
      goes_on ? brought_l < kUnusualTo_l : brought_l < kUnusualAt_l && swimmer.button_s > kWait_s;
  const bool lets_out = (rises ? usual : unusual) && state.life.jacket_moles > kEmptyJacket_mol;
  const bool lets_in = (rises ? unusual : usual) && can_fill(body, state);
  if (!lets_out && !lets_in)
    swimmer.button_s = std::max(swimmer.button_s, 0.0);
  else if (!goes_on)
    swimmer.button_s = -kVent_s;
  inputs.buttons = lets_in ? kInflate : lets_out && at_valve ? kDump : 0;
}

// Rises and sinks by breath first, by the jacket where breath does not do.
void balance(const Body& body, double sink_too_much_m_s, const HumanState& state,
             SwimmerState& swimmer, double dt_s, HumanInputs& inputs) {
  const bool at_valve = gas_at_dump(body, state.life.jacket_moles, thorax_place(body, state));
  // Who has to point the nose down to stay down is too light.
  const double rests = swimmer.rests;
  const double usual_l = 1.6 * sink_too_much_m_s + 0.1 * swimmer.climb_sum;
  const double want_l = (1.0 + kHoverBreath * rests) * usual_l;
  swimmer.lift_sum = std::clamp(swimmer.lift_sum + usual_l * dt_s, -12.0, 12.0);
  const double breath_m3 = std::clamp(1e-3 * (want_l + 0.08 * swimmer.lift_sum),
                                      -kMostBreathBias_m3, kMostBreathBias_m3);
  follow(swimmer.breath_bias_m3, breath_m3, kBreathLag_s, dt_s);
  inputs.breath_bias_m3 = swimmer.breath_bias_m3;
  swimmer.button_s += dt_s;
  if (swimmer.rises != 0.0) return hold_neutral(body, state, at_valve, swimmer, inputs);
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

// Where the head is to point: to the goal, some way into a current from the side.
double wanted_heading(const SwimGoal& goal, const HumanState& state, double heading_rad) {
  const Vec3 way = goal.target_ned_m - state.root.position_ned_m;
  const double level = std::hypot(way.x, way.y);
  if (level < 0.1) return heading_rad;
  const Vec3 drift = state.held.current_ned_m_s;
  const double aside = (-drift.x * way.y + drift.y * way.x) / level;  // to starboard of the way
  const double crab = std::asin(std::clamp(aside / std::max(goal.speed_m_s, 0.1), -0.7, 0.7));
  return std::atan2(way.y, way.x) - crab;
}

// The goal of who hovers: rest, and the way back once drifted off, or tilted more than a posture
// rights: fins right a body that has way. In a current the head stays into it.
SwimGoal hover_goal(SwimGoal goal, const HumanState& state, SwimmerState& swimmer) {
  const Vec3 way = goal.target_ned_m - state.root.position_ned_m;
  const Vec3& drift = state.held.current_ned_m_s;
  const double drift_m_s = std::hypot(drift.x, drift.y);
  const bool current = drift_m_s > kStill_m_s;
  double off_m = std::hypot(way.x, way.y), near_m = kNear_m;
  if (current) {
    const Vec3 against = Vec3(-drift.x, -drift.y, 0.0) / drift_m_s;
    const double aside_m = std::abs(way.x * against.y - way.y * against.x);
    off_m = way.x * against.x + way.y * against.y + aside_m;
    near_m = -kNear_m;  // somewhat upstream
    goal.target_ned_m += kAimAhead_m * against;
  }
  const double tilt_rad = std::abs(attitude_of(state.root.attitude).pitch_rad);
  if (tilt_rad > kTilted_rad)
    swimmer.goes_back = kRightsHimself;
  else if (off_m > kAdrift_m && swimmer.goes_back == 0)
    swimmer.goes_back = kGoesBack;
  if (off_m < near_m && tilt_rad < 0.5 * kTilted_rad) swimmer.goes_back = 0;
  const bool steep = swimmer.goes_back == kRightsHimself && tilt_rad > kSteep_rad;
  if (swimmer.goes_back == 0 || steep) return goal;
  const WayBack& way_back = swimmer.goes_back == kRightsHimself ? kRighting : kBack;
  const double upstream_m_s =
      current ? drift_m_s + way_back.each_metre_1_s * std::max(off_m, 0.0) : 0.0;
  goal.speed_m_s = std::min(way_back.speed_m_s + upstream_m_s, way_back.most_m_s);
  return goal;
}

// Metres a second down to that depth. A place well above or below is come to at a rate of its own,
// in which the swimmer comes slowly.
double wanted_sink(double deeper_m, bool swims, SwimmerState& swimmer, double dt_s) {
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

// 1: little way, legs do not steer; 0: way enough.
double slow(const SwimmerState& swimmer) {
  return std::min(1.0, 2.5 * swimmer.rests);
}

// Spine and legs, for the head to come round by turn (to starboard) and nose_up, without rolling.
void steer(double turn, double nose_up, double roll_rad, const Vec6& velocity,
           SwimmerState& swimmer, double dt_s) {
  // Without way there is no flow over the legs that rights the body: firmer then.
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
  // Who has little way and holds his nose up turns by leaning: what holds it up leans along.
  const double leans =
      slow(swimmer) * std::clamp(-2.0 * swimmer.lift_rad / kMostLift_rad, 0.0, 1.0);
  swimmer.roll_sum = rests * std::clamp(swimmer.roll_sum + roll * dt_s, -1.0, 1.0);
  const double tilt = std::clamp(
      2.0 * (roll - leans * yaw * kMostBank_rad) + 1.0 * roll_rate + 0.5 * swimmer.roll_sum, -1.0,
      1.0);
  // Who rests holds the roll by bending to a side: trunk and legs are no longer under each other.
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
  const double treads = std::clamp((std::abs(pitch) - kTreads) / (1.0 - kTreads), 0.0, 1.0);
  follow(swimmer.tread, rests * treads, kSteeringLag_s, dt_s);
  swimmer.tread_phase_rad =
      std::fmod(swimmer.tread_phase_rad + 2.0 * kPi * kTread_hz * dt_s, 2.0 * kPi);
  follow(swimmer.twist_rad, -tilt * kMostTwist_rad, kSteeringLag_s, dt_s);
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
  for (const Segment arm : {kLeftUpperArm, kRightUpperArm})
    joints[joint_of(arm)].y = kHoverArms * rests * std::max(swimmer.lift_rad, 0.0);
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
  const bool hovers = asked.speed_m_s <= settings.gliding_speed_m_s;
  if (!hovers) swimmer.goes_back = 0;
  const SwimGoal goal = hovers ? hover_goal(asked, state, swimmer) : asked;
  const HumanAttitude attitude = attitude_of(state.root.attitude);
  const Vec3 velocity_ned = state.root.attitude * state.root.velocity.linear();
  const Vec3 ahead_ned = state.root.attitude * Vec3(1.0, 0.0, 0.0);
  const double ahead_m_s = glm::dot(velocity_ned - state.held.current_ned_m_s, ahead_ned);
  const bool swims = goal.speed_m_s > settings.gliding_speed_m_s;
  const double deeper_m = goal.target_ned_m.z - state.root.position_ned_m.z;
  const double sink_m_s = wanted_sink(deeper_m, swims, swimmer, dt_s);
  const double too_much_m_s = velocity_ned.z - sink_m_s;
  swimmer.climb_sum = swims ? std::clamp(swimmer.climb_sum + too_much_m_s * dt_s, -3.0, 3.0) : 0.0;
  const double way = std::clamp(ahead_m_s / kWay_m_s, 0.0, 1.0);
  follow(swimmer.rests, 1.0 - swimmer.effort * way, 0.5, dt_s);
  pace(settings, ahead_m_s, goal.speed_m_s, state.life.limb_power_w, swimmer, dt_s);
  balance(body, too_much_m_s, state, swimmer, dt_s, inputs);

  double turn = 0.0, pitch = 0.0;
  if (swims) {
    turn = std::remainder(wanted_heading(goal, state, attitude.heading_rad) - attitude.heading_rad,
                          2.0 * kPi);
    // Right behind: on round the same side, whichever is the nearer just now.
    if (std::abs(turn) < kBehind_rad || swimmer.turn_side == 0.0)
      swimmer.turn_side = std::copysign(1.0, turn);
    turn = std::copysign(turn, swimmer.turn_side);
    const bool changes = swimmer.rises != 0.0;
    if (changes) turn = std::clamp(turn, -kChangeTurn_rad, kChangeTurn_rad);
    const double firm = changes ? kChangeFirm : 1.0;
    const double climb_m_s =
        -sink_m_s + firm * 0.3 * too_much_m_s + firm * 0.04 * swimmer.climb_sum;
    pitch = std::clamp(climb_m_s / std::max(goal.speed_m_s, 0.2), -kMostPitch_rad, kMostPitch_rad);
  }
  const bool fills = (inputs.buttons & kInflate) != 0;
  if (swimmer.button_s < 0.0 && swimmer.lift_sum < 0.0 && !fills)
    pitch = std::max(pitch, kVentPitch_rad);
  const double upright = (std::abs(attitude.pitch_rad) - kTilted_rad) / (kSteep_rad - kTilted_rad);
  const double stoops = hovers && attitude.pitch_rad > 0.0 ? std::clamp(upright, 0.0, 1.0) : 0.0;
  follow(swimmer.stoop_rad, stoops * kStoop_rad, kStoopLag_s, dt_s);
  // Of who stands there is no roll.
  const double roll_rad = attitude.roll_rad * std::cos(attitude.pitch_rad);
  steer(turn, pitch - attitude.pitch_rad, roll_rad, state.root.velocity, swimmer, dt_s);
  inputs.joints = posture_for(body, settings, swimmer);
}

}  // namespace neritic::diver
