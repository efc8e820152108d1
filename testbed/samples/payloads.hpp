// The contents of samples: one small plain struct a kind, which lists its fields
// (engine/sim/fields.hpp) so that it can be checked, logged and replayed. World frame unless said
// otherwise: x east, y up, z south, metres. Body axes are marine: forward, starboard, down (a
// diver's forward points from the hips to the head). Vehicle readings and instrument states are the
// structs of rov/ and diver/, in the axes that those say. Any thread.
#pragma once

#include <array>
#include <cstdint>

#include "diver/segments.hpp"
#include "diver/vitals.hpp"
#include "rov/sensor_set.hpp"
#include "rov/vector6.hpp"
#include "rov/vehicle.hpp"

namespace neritic::testbed {

// Inputs of a diver.

// The measured or wanted posture: parent_from_child of each joint (diver/segments.hpp).
struct BodyJoints {
  diver::JointRotations joints = diver::straight_joints();
  double other_power_w = 0.0;  // work of the body beside what the limbs do to the water

  static void fields(auto&& field, auto& self) {
    field("joints", self.joints);
    field("other_power_w", self.other_power_w);
  }
};

// Left, then right.
struct HandJoints {
  std::array<Quat, 2> wrist{Quat(1.0, 0.0, 0.0, 0.0),
                            Quat(1.0, 0.0, 0.0, 0.0)};  // parent_from_child
  // Thumb to little finger, left hand first: 0 straight. The water does not act on fingers.
  std::array<double, 10> flexion_rad{};

  static void fields(auto&& field, auto& self) {
    field("wrist", self.wrist);
    field("flexion_rad", self.flexion_rad);
  }
};

// Left, then right. Origin at the wrist; axes as a standing person's while the arm hangs at the
// side: x right, y from the fingers to the wrist, z backwards. The arm bends so that the hand is
// there.
struct HandPoses {
  std::array<Pose, 2> world_from_hand{};
  std::uint64_t tracked = 0;  // bit 0 left, bit 1 right: the others' poses mean nothing

  static void fields(auto&& field, auto& self) {
    field("world_from_hand", self.world_from_hand);
    field("tracked", self.tracked);
  }
};

// The middle of the eyes; view axes: x right, y up, z backwards. The neck turns the head so.
struct HeadPose {
  Pose world_from_head;
  std::uint64_t placed =
      0;  // 1: its place counts too, and the spine leans so that the eyes are there

  static void fields(auto&& field, auto& self) {
    field("world_from_head", self.world_from_head);
    field("placed", self.placed);
  }
};

struct Gaze {
  diver::GazeState state;  // directions in the world frame

  static void fields(auto&& field, auto& self) { field("state", self.state); }
};

struct JacketButtons {
  std::uint64_t pressed = 0;  // diver::kInflate, kDeflate, kDump

  static void fields(auto&& field, auto& self) { field("pressed", self.pressed); }
};

struct Breath {
  double ventilation_l_min = 0.0;  // measured, at ambient pressure; 0: by effort
  double bias_m3 = 0.0;            // the breath swings around this much more air than at rest
  std::uint64_t hold = 0;          // 1: held
  diver::BreathState monitor;      // a breath monitor's estimate from the sound

  static void fields(auto&& field, auto& self) {
    field("ventilation_l_min", self.ventilation_l_min);
    field("bias_m3", self.bias_m3);
    field("hold", self.hold);
    field("monitor", self.monitor);
  }
};

struct Heart {
  diver::HeartState state;

  static void fields(auto&& field, auto& self) { field("state", self.state); }
};

// Regulator: which tank is breathed from, 0 is the first of the diver's file.
struct GasSupply {
  std::uint64_t tank = 0;

  static void fields(auto&& field, auto& self) { field("tank", self.tank); }
};

// The regulators of a diver whose scene names them, in place of what the autopilot and the scene
// would do.
enum class SupplyChoice : std::uint64_t { kByItself, kOwn, kDonor };
enum class FlowChoice : std::uint64_t { kByScene, kFlows, kHolds };
struct RegulatorUse {
  SupplyChoice supply = SupplyChoice::kByItself;  // kDonor: as far as the hose reaches
  FlowChoice flow = FlowChoice::kByScene;         // kFlows: of the tank that is breathed from

  static void fields(auto&& field, auto& self) {
    field("supply", self.supply);
    field("flow", self.flow);
  }
};

// A vehicle's gripper or a diver's hands, where the scene names them.
enum class GripChoice : std::uint64_t {
  kByItself,  // a gripper keeps what it has; hands take what a gripper holds out
  kOpen,
  kClose,  // holds what comes into reach
};
struct GripUse {
  GripChoice choice = GripChoice::kByItself;

  static void fields(auto&& field, auto& self) { field("choice", self.choice); }
};

// Inputs of a vehicle.

// Body axes, N and N m, as far as the thrusters have room for it. Depth and heading are held while
// the wrench leaves them alone.
struct VehicleWrench {
  rov::Vec6 wrench;

  static void fields(auto&& field, auto& self) { field("wrench", self.wrench); }
};

// Where the vehicle is to be, level.
struct VehicleSetpoint {
  Vec3 position_m{0.0};
  Vec3 velocity_m_s{0.0};    // of the setpoint itself
  double heading_rad = 0.0;  // from north (-z) towards east (+x)

  static void fields(auto&& field, auto& self) {
    field("position_m", self.position_m);
    field("velocity_m_s", self.velocity_m_s);
    field("heading_rad", self.heading_rad);
  }
};

// How fast the vehicle is to move over ground, level: forward, starboard, down of its heading,
// which turns at yaw_rate_rad_s from north towards east.
struct VehicleVelocity {
  Vec3 velocity_m_s{0.0};
  double yaw_rate_rad_s = 0.0;

  static void fields(auto&& field, auto& self) {
    field("velocity_m_s", self.velocity_m_s);
    field("yaw_rate_rad_s", self.yaw_rate_rad_s);
  }
};

// The force that each thruster is to give along its direction, in the order of the vehicle's file;
// beyond its limits it gives what it can. Nothing is held beside it.
struct VehicleThrusters {
  std::array<double, rov::kMaxThrusters> force_n{};

  static void fields(auto&& field, auto& self) { field("force_n", self.force_n); }
};

struct ThrusterFault {
  std::uint64_t failed = 0;  // bit i: the file's thruster i + 1

  static void fields(auto&& field, auto& self) { field("failed", self.failed); }
};

// Input of an object that devices move: what a motion capture, a boat's receiver or a program
// measures.
struct ObjectPose {
  Pose world_from_object;  // unit rotation
  // Motion of the object's origin, world axes; valid only if `measured` is 1. Else they follow from
  // poses.
  Vec3 velocity_m_s{0.0}, angular_velocity_rad_s{0.0};
  std::uint64_t measured = 0;

  static void fields(auto&& field, auto& self) {
    field("world_from_object", self.world_from_object);
    field("velocity_m_s", self.velocity_m_s);
    field("angular_velocity_rad_s", self.angular_velocity_rad_s);
    field("measured", self.measured);
  }
};

// A message that a modem is to send, up to kModemBytes.
inline constexpr std::size_t kModemBytes = 64;
struct ModemSend {
  std::uint64_t to = 0;  // number of a modem from 1 on, in the order of the world; 0: to all
  std::uint64_t bytes = 0;
  std::array<std::uint32_t, kModemBytes / 4> words{};  // little-endian

  static void fields(auto&& field, auto& self) {
    field("to", self.to);
    field("bytes", self.bytes);
    field("words", self.words);
  }
};

// Something that happens once.
enum class EventKind : std::uint64_t {
  kSetAuthority,  // `group` is from now on under `authority`, a live one of `source`
};
struct Event {
  EventKind kind = EventKind::kSetAuthority;
  std::uint64_t group = 0;      // of the stream's owner (authority.hpp): DiverGroup, ...
  std::uint64_t authority = 0;  // Authority
  std::uint64_t source = 0;
  double hold_s = 0.0;  // of a new authority: how long it may be silent; 0: as it was

  static void fields(auto&& field, auto& self) {
    field("kind", self.kind);
    field("group", self.group);
    field("authority", self.authority);
    field("source", self.source);
    field("hold_s", self.hold_s);
  }
};

// Readings of a vehicle. A compass says an angle only.
struct CompassReading {
  double heading_rad = 0.0;  // magnetic, 0 to 2 pi from north towards east

  static void fields(auto&& field, auto& self) { field("heading_rad", self.heading_rad); }
};

// A step in which a vehicle or a diver touched something: the nearest thing where the step ended.
enum class CollisionWith : std::uint64_t {
  kNothing,  // nothing is within 0.05 m any more
  kSolid,    // an object of the scene that stands still
  kVehicle,
  kDiver,
};
struct CollisionReading {
  CollisionWith with = CollisionWith::kNothing;
  std::uint64_t other = 0;  // instance label of an object; number of a vehicle or diver
  Vec3 point_m{0.0};
  Vec3 normal{0.0};       // unit, from the other thing to this body
  double depth_m = 0.0;   // of one in the other; 0: they only touch
  Vec3 impulse_n_s{0.0};  // of all that stands still on the body, over the step; with kSolid only

  static void fields(auto&& field, auto& self) {
    field("with", self.with);
    field("other", self.other);
    field("point_m", self.point_m);
    field("normal", self.normal);
    field("depth_m", self.depth_m);
    field("impulse_n_s", self.impulse_n_s);
  }
};

// The fate of a message at a modem: at its sender, or at one that it was for.
enum class ModemEvent : std::uint64_t {
  kSent,
  kRefused,   // it was sending, had too much on the way, or the message was too long
  kReceived,  // and lost, by the cause:
  kTooWeak,
  kNoisy,
  kCollided,
  kWasSending,
};
enum class ModemKind : std::uint64_t {
  kMessage,
  kRequest,  // of a modem that ranges, and its answer
  kAnswer,
};
struct ModemReading {
  ModemEvent event = ModemEvent::kSent;
  ModemKind kind = ModemKind::kMessage;
  std::uint64_t from = 0, to = 0;  // as of ModemSend
  std::uint64_t number = 0;        // of its sender's messages, from 0
  std::uint64_t bytes = 0;
  std::array<std::uint32_t, kModemBytes / 4> words{};  // of one that was sent or came
  // Its first sound, here and there, on the scene's clock: their difference is the travel.
  double sent_s = 0.0, heard_s = 0.0;
  double snr_db = 0.0;  // of one that came

  static void fields(auto&& field, auto& self) {
    field("event", self.event);
    field("message_kind", self.kind);
    field("from", self.from);
    field("to", self.to);
    field("number", self.number);
    field("bytes", self.bytes);
    field("words", self.words);
    field("sent_s", self.sent_s);
    field("heard_s", self.heard_s);
    field("snr_db", self.snr_db);
  }
};

// Outputs of a diver.
struct DiverMotion {
  Pose world_from_body;                        // model axes: starboard, up, back
  Vec3 velocity_m_s{0.0}, angular_rad_s{0.0};  // over ground, body axes
  Vec3 gaze{0.0};                              // unit
  double heart_bpm = 0.0, breath_bpm = 0.0, ventilation_l_min = 0.0;
  double tank_pa = 0.0, jacket_m3 = 0.0, lungs_m3 = 0.0;
  std::uint64_t tank = 0, buttons = 0;  // breathed from, from 0; pressed, as in JacketButtons

  static void fields(auto&& field, auto& self) {
    field("world_from_body", self.world_from_body);
    field("velocity_m_s", self.velocity_m_s);
    field("angular_rad_s", self.angular_rad_s);
    field("gaze", self.gaze);
    field("heart_bpm", self.heart_bpm);
    field("breath_bpm", self.breath_bpm);
    field("ventilation_l_min", self.ventilation_l_min);
    field("tank_pa", self.tank_pa);
    field("jacket_m3", self.jacket_m3);
    field("lungs_m3", self.lungs_m3);
    field("tank", self.tank);
    field("buttons", self.buttons);
  }
};

// The display of a dive computer; -1 where there is no limit or no end.
struct ComputerReading {
  double depth_m = 0.0, ceiling_m = 0.0, stop_m = 0.0;
  double no_stop_min = 0.0, stop_min = 0.0, to_surface_min = 0.0;
  double po2_bar = 0.0, ascent_m_min = 0.0, cns_percent = 0.0;
  std::uint64_t gas = 0, alarm = 0;  // diver::AscentAlarm

  static void fields(auto&& field, auto& self) {
    field("depth_m", self.depth_m);
    field("ceiling_m", self.ceiling_m);
    field("stop_m", self.stop_m);
    field("no_stop_min", self.no_stop_min);
    field("stop_min", self.stop_min);
    field("to_surface_min", self.to_surface_min);
    field("po2_bar", self.po2_bar);
    field("ascent_m_min", self.ascent_m_min);
    field("cns_percent", self.cns_percent);
    field("gas", self.gas);
    field("alarm", self.alarm);
  }
};

// How far a value of a person's state can be relied on.
enum class ValueQuality : std::uint64_t {
  kMissing,   // not known; it is 0
  kLost,      // its source was never heard or fell silent: what the model of a diver has instead
  kModelled,  // no source is named: of the model
  kPoor,      // measured, but not to be relied on: of a poor signal, or between two things
  kGood,      // measured
};

// The state of a person that a robot acts on, as the published system feeds it to its ROV: gaze,
// breath, heart rate variability, ascent rate, gas, depth; each value with its quality. Depth,
// ascent and gas are those of the diver's computer and gauge.
struct HumanReading {
  std::uint64_t gaze_object =
      0;                         // number of the scene's object, from 1 on; 0: nothing is looked at
  double gaze_off_rad = 0.0;     // of the line of sight from it, or from the nearest thing
  double gaze_distance_m = 0.0;  // from the eyes to that
  double breath_bpm = 0.0, heart_bpm = 0.0;
  double sdnn_ms = 0.0, rmssd_ms = 0.0;  // of the heart's last five minutes
  double depth_m = 0.0, ascent_m_min = 0.0, gas_pa = 0.0;
  ValueQuality gaze_quality = ValueQuality::kMissing, breath_quality = ValueQuality::kMissing,
               heart_quality = ValueQuality::kMissing, variability_quality = ValueQuality::kMissing;

  static void fields(auto&& field, auto& self) {
    field("gaze_object", self.gaze_object);
    field("gaze_off_rad", self.gaze_off_rad);
    field("gaze_distance_m", self.gaze_distance_m);
    field("breath_bpm", self.breath_bpm);
    field("heart_bpm", self.heart_bpm);
    field("sdnn_ms", self.sdnn_ms);
    field("rmssd_ms", self.rmssd_ms);
    field("depth_m", self.depth_m);
    field("ascent_m_min", self.ascent_m_min);
    field("gas_pa", self.gas_pa);
    field("gaze_quality", self.gaze_quality);
    field("breath_quality", self.breath_quality);
    field("heart_quality", self.heart_quality);
    field("variability_quality", self.variability_quality);
  }
};

// The condition of a diver whose scene names it (diver/condition.hpp). A model, not a measurement.
struct ConditionReading {
  double alveolar_mmhg = 0.0, saturation = 0.0;  // of oxygen
  // Share of the time of useful consciousness that has passed; of the dose of oxygen that this
  // diver bears; of people who had convulsed by that dose.
  double hypoxia = 0.0, oxygen = 0.0, oxygen_risk = 0.0;
  double co2_mmhg = 0.0, narcotic_depth_m = 0.0;
  double core_c = 0.0, skin_c = 0.0, shiver_w = 0.0;
  double slowing = 1.0, strength = 1.0;  // times as long, share of the work
  std::uint64_t lost = 0;                // diver::kHypoxia, ...: takes consciousness away; 0: awake
  double lost_s = 0.0;

  static void fields(auto&& field, auto& self) {
    field("alveolar_mmhg", self.alveolar_mmhg);
    field("saturation", self.saturation);
    field("hypoxia", self.hypoxia);
    field("oxygen", self.oxygen);
    field("oxygen_risk", self.oxygen_risk);
    field("co2_mmhg", self.co2_mmhg);
    field("narcotic_depth_m", self.narcotic_depth_m);
    field("core_c", self.core_c);
    field("skin_c", self.skin_c);
    field("shiver_w", self.shiver_w);
    field("slowing", self.slowing);
    field("strength", self.strength);
    field("lost", self.lost);
    field("lost_s", self.lost_s);
  }
};

// A gripper or a hand.
struct GripReading {
  std::uint64_t held = 0;   // number of the object among those that move without physics of their
                            // own, from 1 on; 0: nothing
  Vec3 position_m{0.0};     // of the grip
  Vec3 velocity_m_s{0.0};   // over ground
  double load_n = 0.0;      // that what it holds pulls with, over some 20 ms
  double nearest_m = -1.0;  // from the grip to the nearest thing
  std::uint64_t grabs = 0, drops = 0;  // so far; a thing taken over is no drop

  static void fields(auto&& field, auto& self) {
    field("held", self.held);
    field("position_m", self.position_m);
    field("velocity_m_s", self.velocity_m_s);
    field("load_n", self.load_n);
    field("nearest_m", self.nearest_m);
    field("grabs", self.grabs);
    field("drops", self.drops);
  }
};

// A vehicle's tether, where the scene names one.
struct TetherReading {
  Vec3 pull_n{0.0};                  // on the vehicle, world axes
  double tension_n = 0.0;            // of the line at the vehicle
  double top_n = 0.0, most_n = 0.0;  // at its top; where it is tautest
  double length_m = 0.0;             // paid out
  double straight_m = 0.0;           // from its top to the vehicle
  std::uint64_t touching = 0;        // segments that press on something solid

  static void fields(auto&& field, auto& self) {
    field("pull_n", self.pull_n);
    field("tension_n", self.tension_n);
    field("top_n", self.top_n);
    field("most_n", self.most_n);
    field("length_m", self.length_m);
    field("straight_m", self.straight_m);
    field("touching", self.touching);
  }
};

// The battery of a vehicle whose file names one.
struct BatteryReading {
  double voltage_v = 0.0, current_a = 0.0;  // at its terminals; positive: it is drawn from
  double charge = 0.0;                      // of 1
  double left_s = 0.0;                      // at the power of now
  std::uint64_t empty = 0;                  // 1: no thruster has power

  static void fields(auto&& field, auto& self) {
    field("voltage_v", self.voltage_v);
    field("current_a", self.current_a);
    field("charge", self.charge);
    field("left_s", self.left_s);
    field("empty", self.empty);
  }
};

// The supply that a diver breathes from, if the scene names regulators. Litres at 1 bar.
struct SupplyReading {
  std::uint64_t donor = 0;   // number of the diver whose gas it is, from 1 on; 0: its own
  std::uint64_t fed = 1;     // 0: nothing comes
  double breathed_pa = 0.0;  // in the tank that is breathed from
  double donor_m = -1.0;     // between both mouths; -1: no donor
  double taken_l = 0.0;      // from the donor, so far
  double blown_l = 0.0;      // off by a free flow, so far
  double flow_l_min = 0.0;   // of it, now
  std::uint64_t torn = 0;    // how often the hose was too short

  static void fields(auto&& field, auto& self) {
    field("donor", self.donor);
    field("fed", self.fed);
    field("breathed_pa", self.breathed_pa);
    field("donor_m", self.donor_m);
    field("taken_l", self.taken_l);
    field("blown_l", self.blown_l);
    field("flow_l_min", self.flow_l_min);
    field("torn", self.torn);
  }
};

}  // namespace neritic::testbed
