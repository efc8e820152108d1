#include "testbed/world/ros_samples.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/core/ros_frames.hpp"
#include "testbed/samples/unit_rotation.hpp"

namespace neritic::testbed::ros {
namespace {

// The four things done with each field of a payload: listed, written, read or checked. Each
// describe() below names a payload's fields once for all four.
struct Lister {
  std::vector<Field>& fields;
  template <class T>
  void number(const char* name, T&) {
    fields.push_back({name, 1});
  }
  template <class T>
  void choice(const char* name, T& value, T) {
    number(name, value);
  }
  template <class T, class To, class From>
  void vector(const char* name, T&, const To&, const From&) {
    fields.push_back({name, 3});
  }
  template <class T, class To, class From>
  void rotation(const char* name, T&, const To&, const From&) {
    fields.push_back({name, 4});
  }
  template <class T, class Both>
  void angle(const char* name, T&, const Both&) {
    fields.push_back({name, 1});
  }
  template <class T>
  void bits(const char* name, T&, std::uint32_t count) {
    fields.push_back({name, count});
  }
  template <class T>
  void list(const char* name, T& values) {
    fields.push_back({name, static_cast<std::uint32_t>(std::size(values))});
  }
  template <class T>
  void words(const char* name, T& values) {
    list(name, values);
  }
  template <class T, class Both>
  void rotations(const char* name, T& values, const Both&) {
    fields.push_back({name, static_cast<std::uint32_t>(4 * std::size(values))});
  }
};

struct Writer {
  double* at;
  void put(const Vec3& v) { *at++ = v.x, *at++ = v.y, *at++ = v.z; }
  void put(const Quat& q) { *at++ = q.x, *at++ = q.y, *at++ = q.z, *at++ = q.w; }
  template <class T>
  void number(const char*, const T& value) {
    *at++ = static_cast<double>(value);
  }
  template <class T>
  void choice(const char* name, const T& value, T) {
    number(name, value);
  }
  template <class T, class To, class From>
  void vector(const char*, const T& value, const To& to, const From&) {
    put(to(value));
  }
  template <class T, class To, class From>
  void rotation(const char*, const T& value, const To& to, const From&) {
    put(to(value));
  }
  template <class T, class Both>
  void angle(const char*, const T& value, const Both& both) {
    *at++ = both(value);
  }
  template <class T>
  void bits(const char*, const T& value, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) *at++ = static_cast<double>(value >> i & 1);
  }
  template <class T>
  void list(const char*, const T& values) {
    for (const double value : values) *at++ = value;
  }
  template <class T>
  void words(const char*, const T& values) {
    for (const std::uint32_t value : values) *at++ = static_cast<double>(value);
  }
  template <class T, class Both>
  void rotations(const char*, const T& values, const Both& both) {
    for (const Quat& value : values) put(both(value));
  }
};

struct Reader {
  const double* at;
  Vec3 vec3() {
    at += 3;
    return {at[-3], at[-2], at[-1]};
  }
  Quat quat() {
    at += 4;
    const Quat q(at[-1], at[-4], at[-3], at[-2]);
    return is_unit_rotation(q) ? unit_or_identity(q) : q;  // for plausible() to refuse
  }
  template <class T>
  void number(const char*, T& value) {
    const double x = *at++;
    if constexpr (std::is_floating_point_v<T>)
      value = x;
    else
      value = static_cast<T>(static_cast<std::uint64_t>(x > 0.0 ? std::min(x, 9e15) : 0.0));
  }
  // Beyond the last: the first.
  template <class T>
  void choice(const char*, T& value, T last) {
    const double x = *at++;
    value = x >= 0.0 && x <= static_cast<double>(last)
                ? static_cast<T>(static_cast<std::uint64_t>(x))
                : T{};
  }
  template <class T, class To, class From>
  void vector(const char*, T& value, const To&, const From& from) {
    value = from(vec3());
  }
  template <class T, class To, class From>
  void rotation(const char*, T& value, const To&, const From& from) {
    value = from(quat());
  }
  template <class T, class Both>
  void angle(const char*, T& value, const Both& both) {
    value = both(*at++);
  }
  template <class T>
  void bits(const char*, T& value, std::uint32_t count) {
    value = 0;
    for (std::uint32_t i = 0; i < count; ++i) value |= (*at++ != 0.0 ? T{1} : T{0}) << i;
  }
  template <class T>
  void list(const char*, T& values) {
    for (double& value : values) value = *at++;
  }
  template <class T>
  void words(const char*, T& values) {
    for (std::uint32_t& value : values)
      value = static_cast<std::uint32_t>(std::clamp(*at++, 0.0, 4294967295.0));
  }
  template <class T, class Both>
  void rotations(const char*, T& values, const Both& both) {
    for (Quat& value : values) value = both(quat());
  }
};

// Numbers that a Reader would have to bend: the first of them is refused.
struct Checker {
  const double* at;
  std::string_view where;
  Status status;
  void whole(const char* name, double least, double most) {
    const double x = *at++;
    if (!status.ok() || (x >= least && x <= most && x == std::floor(x))) return;
    status = refusal(fmt::format("{}: {}", where, name), fmt::format("{}", x),
                     most == 1.0 ? std::string("0 or 1")
                                 : fmt::format("a whole number from {} to {}", least, most));
  }
  template <class T>
  void number(const char* name, const T&) {
    if constexpr (std::is_floating_point_v<T>)
      ++at;
    else
      whole(name, 0.0, kMostCount);
  }
  template <class T>
  void choice(const char* name, const T&, T last) {
    whole(name, 0.0, static_cast<double>(last));
  }
  template <class T, class To, class From>
  void vector(const char*, const T&, const To&, const From&) {
    at += 3;
  }
  template <class T, class To, class From>
  void rotation(const char*, const T&, const To&, const From&) {
    at += 4;
  }
  template <class T, class Both>
  void angle(const char*, const T&, const Both&) {
    ++at;
  }
  template <class T>
  void bits(const char* name, const T&, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) whole(name, 0.0, 1.0);
  }
  template <class T>
  void list(const char*, const T& values) {
    at += std::size(values);
  }
  template <class T>
  void words(const char* name, const T& values) {
    for (std::size_t i = 0; i < std::size(values); ++i) whole(name, 0.0, 4294967295.0);
  }
  template <class T, class Both>
  void rotations(const char*, const T& values, const Both&) {
    at += 4 * std::size(values);
  }
  static constexpr double kMostCount = 9e15;
};

// The first rotation that is no unit quaternion, and its name.
struct RotationFinder {
  const double* at;
  std::uint64_t left_out;  // bits: rotations that mean nothing, in their order
  std::string name;
  double length = 0.0;
  void one(const std::string& called) {
    at += 4;
    const Quat q(at[-1], at[-4], at[-3], at[-2]);
    const bool means = (left_out & 1) == 0;
    left_out >>= 1;
    if (!name.empty() || !means || is_unit_rotation(q)) return;
    name = called;
    length = std::hypot(std::hypot(q.x, q.y), std::hypot(q.z, q.w));
  }
  template <class T>
  void number(const char*, const T&) {
    ++at;
  }
  template <class T>
  void choice(const char*, const T&, T) {
    ++at;
  }
  template <class T, class To, class From>
  void vector(const char*, const T&, const To&, const From&) {
    at += 3;
  }
  template <class T, class To, class From>
  void rotation(const char* called, const T&, const To&, const From&) {
    one(called);
  }
  template <class T, class Both>
  void angle(const char*, const T&, const Both&) {
    ++at;
  }
  template <class T>
  void bits(const char*, const T&, std::uint32_t count) {
    at += count;
  }
  template <class T>
  void list(const char*, const T& values) {
    at += std::size(values);
  }
  template <class T>
  void words(const char*, const T& values) {
    at += std::size(values);
  }
  template <class T, class Both>
  void rotations(const char* called, const T& values, const Both&) {
    for (std::size_t i = 0; i < std::size(values); ++i)
      one(fmt::format("{} at place {}", called, i));
  }
};

// The conversions: those of vectors and rotations there and back, those of angles both ways.
constexpr auto same = [](double value) { return value; };
constexpr auto minus = [](double value) { return -value; };
const auto flu = [](const Vec3& v) { return flu_from_marine(v); };
const auto ned = [](const Vec3& v) { return enu_from_ned(v); };
const auto enu = [](const Vec3& v) { return enu_from_world(v); };
const auto world = [](const Vec3& v) { return world_from_enu(v); };
const auto attitude = [](const Quat& q) { return enu_from_body(q); };
const auto body = [](const Quat& q) { return body_from_enu(q); };
const auto joint = [](const Quat& q) { return flu_from_marine(q); };
const auto yaw = [](double heading_rad) { return yaw_from_heading(heading_rad); };

template <class Io, class T>
void pose(Io& io, const char* position, const char* orientation, T& p) {
  io.vector(position, p.position_m, enu, world);
  io.rotation(orientation, p.rotation, attitude, body);
}

// Inputs.
template <class Io>
void describe(Io& io, auto& p, const BodyJoints*) {
  io.rotations("joints", p.joints, joint);
  io.number("other_power_w", p.other_power_w);
}
template <class Io>
void describe(Io& io, auto& p, const HandJoints*) {
  io.rotations("wrists", p.wrist, joint);
  io.list("flexion", p.flexion_rad);
}
template <class Io>
void describe(Io& io, auto& p, const HandPoses*) {
  pose(io, "left_position", "left_orientation", p.world_from_hand[0]);
  pose(io, "right_position", "right_orientation", p.world_from_hand[1]);
  io.bits("tracked", p.tracked, 2);
}
template <class Io>
void describe(Io& io, auto& p, const HeadPose*) {
  pose(io, "position", "orientation", p.world_from_head);
  io.number("placed", p.placed);
}
template <class Io>
void describe(Io& io, auto& p, const Gaze*) {
  io.number("time_s", p.state.time_s);
  io.vector("direction", p.state.direction, enu, world);
  io.choice("class", p.state.now, diver::GazeClass::kSaccade);
  io.number("fixated_s", p.state.fixated_s);
  io.vector("fixation", p.state.fixation, enu, world);
}
template <class Io>
void describe(Io& io, auto& p, const JacketButtons*) {
  io.bits("pressed", p.pressed, 3);
}
template <class Io>
void describe(Io& io, auto& p, const Breath*) {
  io.number("ventilation_l_min", p.ventilation_l_min);
  io.number("bias_m3", p.bias_m3);
  io.number("hold", p.hold);
}
template <class Io>
void describe(Io& io, auto& p, const Heart*) {
  io.number("time_s", p.state.time_s);
  io.number("rate_bpm", p.state.rate_bpm);
  io.choice("quality", p.state.quality, diver::SignalQuality::kGood);
  io.number("beats", p.state.beats);
}
template <class Io>
void describe(Io& io, auto& p, const GasSupply*) {
  io.number("tank", p.tank);
}
template <class Io>
void describe(Io& io, auto& p, const VehicleWrench*) {
  Vec3 force(p.wrench[0], p.wrench[1], p.wrench[2]), torque(p.wrench[3], p.wrench[4], p.wrench[5]);
  io.vector("force", force, flu, flu);
  io.vector("torque", torque, flu, flu);
  if constexpr (std::is_same_v<Io, Reader>) p.wrench = rov::vec6(force, torque);
}
template <class Io>
void describe(Io& io, auto& p, const VehicleSetpoint*) {
  io.vector("position", p.position_m, enu, world);
  io.vector("velocity", p.velocity_m_s, enu, world);
  io.angle("yaw", p.heading_rad, yaw);
}
template <class Io>
void describe(Io& io, auto& p, const VehicleVelocity*) {
  io.vector("linear", p.velocity_m_s, flu, flu);
  io.angle("yaw_rate", p.yaw_rate_rad_s, minus);
}
template <class Io>
void describe(Io& io, auto& p, const VehicleThrusters*) {
  io.list("force_n", p.force_n);
}
template <class Io>
void describe(Io& io, auto& p, const ThrusterFault*) {
  io.bits("failed", p.failed, rov::kMaxThrusters);
}
template <class Io>
void describe(Io& io, auto& p, const ObjectPose*) {
  pose(io, "position", "orientation", p.world_from_object);
  io.vector("linear_velocity", p.velocity_m_s, enu, world);
  io.vector("angular_velocity", p.angular_velocity_rad_s, enu, world);
  io.number("measured", p.measured);
}
template <class Io>
void describe(Io& io, auto& p, const ModemSend*) {
  io.number("to", p.to);
  io.number("bytes", p.bytes);
  io.words("words", p.words);
}
void describe(auto&, auto&, const Event*) {}

// Readings.
template <class Io>
void describe(Io& io, auto& p, const rov::ImuReading*) {
  io.vector("angular_velocity", p.angular_rad_s, flu, flu);
  io.vector("linear_acceleration", p.specific_force_m_s2, flu, flu);
}
template <class Io>
void describe(Io& io, auto& p, const rov::DvlReading*) {
  io.vector("velocity", p.velocity_m_s, flu, flu);
  io.number("altitude_m", p.altitude_m);
  io.list("range_m", p.range_m);
  io.list("beam_velocity", p.speed_m_s);
  io.number("sound_speed_m_s", p.sound_m_s);
  io.bits("heard", p.heard, 4);
}
template <class Io>
void describe(Io& io, auto& p, const rov::PressureReading*) {
  io.number("pressure_pa", p.pressure_pa);
  io.number("depth_m", p.depth_m);
}
template <class Io>
void describe(Io& io, auto& p, const CompassReading*) {
  io.angle("yaw", p.heading_rad, yaw);
}
template <class Io>
void describe(Io& io, auto& p, const rov::AltimeterReading*) {
  io.number("distance_m", p.distance_m);
  io.number("heard", p.heard);
}
template <class Io>
void describe(Io& io, auto& p, const rov::UsblReading*) {
  io.number("heard", p.heard);
  io.number("range_m", p.range_m);
  io.angle("azimuth", p.bearing_rad, yaw);
  io.angle("elevation", p.elevation_rad, minus);
  io.vector("position", p.position_ned_m, ned, ned);
  io.number("travel_s", p.travel_s);
}
template <class Io>
void describe(Io& io, auto& p, const CollisionReading*) {
  io.choice("with", p.with, CollisionWith::kDiver);
  io.number("other", p.other);
  io.vector("point", p.point_m, enu, world);
  io.vector("normal", p.normal, enu, world);
  io.number("depth_m", p.depth_m);
  io.vector("impulse", p.impulse_n_s, enu, world);
}
template <class Io>
void describe(Io& io, auto& p, const ModemReading*) {
  io.choice("event", p.event, ModemEvent::kWasSending);
  io.choice("message_kind", p.kind, ModemKind::kAnswer);
  io.number("sender", p.from);
  io.number("to", p.to);
  io.number("number", p.number);
  io.number("bytes", p.bytes);
  io.words("words", p.words);
  io.number("sent", p.sent_s);
  io.number("heard", p.heard_s);
  io.number("snr_db", p.snr_db);
}
template <class Io>
void describe(Io& io, auto& p, const RegulatorUse*) {
  io.choice("supply", p.supply, SupplyChoice::kDonor);
  io.choice("flow", p.flow, FlowChoice::kHolds);
}
template <class Io>
void describe(Io& io, auto& p, const GripUse*) {
  io.choice("choice", p.choice, GripChoice::kClose);
}
template <class Io>
void describe(Io& io, auto& p, const GripReading*) {
  io.number("held", p.held);
  io.vector("position", p.position_m, enu, world);
  io.vector("velocity", p.velocity_m_s, enu, world);
  io.number("load_n", p.load_n);
  io.number("nearest_m", p.nearest_m);
  io.number("grabs", p.grabs);
  io.number("drops", p.drops);
}
template <class Io>
void describe(Io& io, auto& p, const TetherReading*) {
  io.vector("pull", p.pull_n, enu, world);
  io.number("tension_n", p.tension_n);
  io.number("top_n", p.top_n);
  io.number("most_n", p.most_n);
  io.number("length_m", p.length_m);
  io.number("straight_m", p.straight_m);
  io.number("touching", p.touching);
}
template <class Io>
void describe(Io& io, auto& p, const BatteryReading*) {
  io.number("voltage", p.voltage_v);
  io.number("current", p.current_a);
  io.number("charge", p.charge);
  io.number("left_s", p.left_s);
  io.number("empty", p.empty);
}
template <class Io>
void describe(Io& io, auto& p, const HumanReading*) {
  io.number("gaze_object", p.gaze_object);
  io.number("gaze_off", p.gaze_off_rad);
  io.number("gaze_distance_m", p.gaze_distance_m);
  io.number("breath_bpm", p.breath_bpm);
  io.number("heart_bpm", p.heart_bpm);
  io.number("sdnn_ms", p.sdnn_ms);
  io.number("rmssd_ms", p.rmssd_ms);
  io.number("depth_m", p.depth_m);
  io.number("ascent_m_min", p.ascent_m_min);
  io.number("gas_pa", p.gas_pa);
  io.choice("gaze_quality", p.gaze_quality, ValueQuality::kGood);
  io.choice("breath_quality", p.breath_quality, ValueQuality::kGood);
  io.choice("heart_quality", p.heart_quality, ValueQuality::kGood);
  io.choice("variability_quality", p.variability_quality, ValueQuality::kGood);
}
template <class Io>
void describe(Io& io, auto& p, const ConditionReading*) {
  io.number("alveolar_mmhg", p.alveolar_mmhg);
  io.number("saturation", p.saturation);
  io.number("hypoxia", p.hypoxia);
  io.number("oxygen", p.oxygen);
  io.number("oxygen_risk", p.oxygen_risk);
  io.number("co2_mmhg", p.co2_mmhg);
  io.number("narcotic_depth_m", p.narcotic_depth_m);
  io.number("core_c", p.core_c);
  io.number("skin_c", p.skin_c);
  io.number("shiver_w", p.shiver_w);
  io.number("slowing", p.slowing);
  io.number("strength", p.strength);
  io.number("lost", p.lost);
  io.number("lost_s", p.lost_s);
}
template <class Io>
void describe(Io& io, auto& p, const SupplyReading*) {
  io.number("donor", p.donor);
  io.number("fed", p.fed);
  io.number("breathed_pa", p.breathed_pa);
  io.number("donor_m", p.donor_m);
  io.number("taken_l", p.taken_l);
  io.number("blown_l", p.blown_l);
  io.number("flow_l_min", p.flow_l_min);
  io.number("torn", p.torn);
}
template <class Io>
void describe(Io& io, auto& p, const DiverMotion*) {
  pose(io, "position", "orientation", p.world_from_body);
  io.vector("linear_velocity", p.velocity_m_s, flu, flu);
  io.vector("angular_velocity", p.angular_rad_s, flu, flu);
  io.vector("gaze", p.gaze, enu, world);
  io.number("heart_bpm", p.heart_bpm);
  io.number("breath_bpm", p.breath_bpm);
  io.number("ventilation_l_min", p.ventilation_l_min);
  io.number("tank_pa", p.tank_pa);
  io.number("jacket_m3", p.jacket_m3);
  io.number("lungs_m3", p.lungs_m3);
  io.number("tank", p.tank);
  io.bits("buttons", p.buttons, 3);
}
template <class Io>
void describe(Io& io, auto& p, const ComputerReading*) {
  io.number("depth_m", p.depth_m);
  io.number("ceiling_m", p.ceiling_m);
  io.number("stop_m", p.stop_m);
  io.number("no_stop_min", p.no_stop_min);
  io.number("stop_min", p.stop_min);
  io.number("to_surface_min", p.to_surface_min);
  io.number("po2_bar", p.po2_bar);
  io.number("ascent_m_min", p.ascent_m_min);
  io.number("cns_percent", p.cns_percent);
  io.number("gas", p.gas);
  io.number("alarm", p.alarm);
}

}  // namespace

std::vector<Field> fields_of(PayloadKind kind) {
  std::vector<Field> fields;
  Lister lister{fields};
  Payload payload = empty_payload(kind);
  std::visit([&](auto& p) { describe(lister, p, &p); }, payload);
  return fields;
}

std::size_t value_count(PayloadKind kind) {
  std::size_t count = 0;
  for (const Field& field : fields_of(kind)) count += field.count;
  return count;
}

std::size_t write_values(const Payload& payload, std::span<double> out) {
  Writer writer{out.data()};
  std::visit([&](const auto& p) { describe(writer, p, &p); }, payload);
  return static_cast<std::size_t>(writer.at - out.data());
}

Payload read_values(PayloadKind kind, std::span<const double> values) {
  Payload payload = empty_payload(kind);
  Reader reader{values.data()};
  std::visit([&](auto& p) { describe(reader, p, &p); }, payload);
  return payload;
}

Status check_values(PayloadKind kind, std::span<const double> values, std::string_view where) {
  const Payload payload = empty_payload(kind);
  Checker checker{values.data(), where, {}};
  std::visit([&](const auto& p) { describe(checker, p, &p); }, payload);
  return checker.status;
}

Error implausible(PayloadKind kind, std::span<const double> values, std::string_view where) {
  const Payload payload = read_values(kind, values);
  const auto* hands = std::get_if<HandPoses>(&payload);
  RotationFinder finder{values.data(), hands ? ~hands->tracked : 0, {}};
  std::visit([&](const auto& p) { describe(finder, p, &p); }, payload);
  if (!finder.name.empty())
    return refusal(fmt::format("{}: {}", where, finder.name),
                   fmt::format("a quaternion of length {:.4g}", finder.length),
                   "x y z w of length 1, within 0.001");
  return refusal(where, "numbers beyond what can be",
                 fmt::format("places to {} km, speeds to {} m/s, forces to {} N", kFarthest_m / 1e3,
                             kFastest, kStrongest));
}

std::string frame_of(PayloadKind kind, const std::string& owner) {
  switch (kind) {
    case PayloadKind::kImu:
    case PayloadKind::kDvl:
    case PayloadKind::kPressure:
    case PayloadKind::kAltimeter:
      return owner + "/" + std::string(name_of(kind));
    case PayloadKind::kUsbl:
    case PayloadKind::kCompass:
    case PayloadKind::kCollision:
    case PayloadKind::kGripper:
    case PayloadKind::kTether:
    case PayloadKind::kMotion:
    case PayloadKind::kSetpoint:
    case PayloadKind::kObjectPose:
    case PayloadKind::kHeadPose:
    case PayloadKind::kHandPoses:
    case PayloadKind::kGaze:
      return "world";
    default:
      return owner;
  }
}

}  // namespace neritic::testbed::ros
