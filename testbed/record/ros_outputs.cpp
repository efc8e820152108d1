#include "testbed/record/ros_outputs.hpp"

#include <cmath>

#include "engine/core/ros_frames.hpp"
#include "engine/recording/cdr.hpp"
#include "engine/recording/ros_types.hpp"
#include "testbed/samples/recording_names.hpp"
#include "testbed/samples/sample_log.hpp"
#include "testbed/simulation/periods.hpp"

namespace neritic::testbed {
namespace {

using recording::CdrWriter;

constexpr const char* kWorldFrame = "map";

// Zeros: the covariance is not known.
void unknown(CdrWriter& cdr, int numbers) {
  for (int i = 0; i < numbers; ++i) cdr.number(0.0);
}

std::string base_of(const std::string& name) {
  return topic_of(name).substr(1) + "/base_link";
}

std::uint64_t stamp(std::int64_t ns) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
}

// Sensor axes forward, starboard, down.
void put_imu(CdrWriter& cdr, const rov::ImuReading& reading) {
  cdr.quaternion(Quat(1.0, 0.0, 0.0, 0.0));
  cdr.number(-1.0);  // it says no orientation
  unknown(cdr, 8);
  cdr.vector(ros::flu_from_marine(reading.angular_rad_s));
  unknown(cdr, 9);
  cdr.vector(ros::flu_from_marine(reading.specific_force_m_s2));
  unknown(cdr, 9);
}

// Its axes in the message: x forward, z where it looks, as the sensor's own.
void put_dvl(CdrWriter& cdr, const rov::Dvl& dvl, const rov::DvlReading& reading) {
  constexpr std::uint8_t kBottom = 1, kPiston = 0;
  const Vec3& v = reading.velocity_m_s;
  cdr.number(kBottom);
  cdr.number(kPiston);
  cdr.vector(v);
  cdr.number(-1.0);
  unknown(cdr, 8);
  cdr.number(reading.altitude_m);
  cdr.number(std::atan2(v.y, v.x));
  cdr.number(std::hypot(v.x, v.y));
  cdr.number(static_cast<std::uint8_t>(std::popcount(reading.heard & 0xfu)));
  cdr.number(static_cast<float>(reading.sound_m_s));
  cdr.number(static_cast<std::uint8_t>(1));
  cdr.number(static_cast<std::uint8_t>(1));
  for (std::size_t i = 0; i < 4; ++i) cdr.vector(rov::dvl_beam(dvl, i));
  for (std::size_t i = 0; i < 4; ++i) cdr.number(reading.range_m[i]);
  for (std::size_t i = 0; i < 4; ++i) cdr.number(-1.0f);
  for (std::size_t i = 0; i < 4; ++i) cdr.number(reading.hears(i) ? 1.0f : 0.0f);
  for (std::size_t i = 0; i < 4; ++i) cdr.number(static_cast<float>(reading.speed_m_s[i]));
  for (std::size_t i = 0; i < 4; ++i) cdr.number(-1.0f);
}

void put_range(CdrWriter& cdr, const rov::Altimeter& altimeter,
               const rov::AltimeterReading& reading) {
  constexpr std::uint8_t kUltrasound = 0;
  cdr.number(kUltrasound);
  cdr.number(0.0f);  // the opening angle is not modelled
  cdr.number(static_cast<float>(altimeter.least_m));
  cdr.number(static_cast<float>(altimeter.most_m));
  // REP 117: infinity where nothing is detected.
  cdr.number(reading.heard != 0 ? static_cast<float>(reading.distance_m)
                                : std::numeric_limits<float>::infinity());
}

// NaN: not measured, as the message's definition asks. Discharging current is negative there.
void put_battery(CdrWriter& cdr, const rov::Battery& battery, const BatteryReading& reading) {
  constexpr std::uint8_t kDischarging = 2, kGood = 1, kDead = 3, kLithiumIon = 2;
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const double capacity_ah = rov::capacity_ah(battery);
  cdr.number(static_cast<float>(reading.voltage_v));
  cdr.number(kUnknown);
  cdr.number(static_cast<float>(-reading.current_a));
  cdr.number(static_cast<float>(reading.charge * capacity_ah));
  cdr.number(static_cast<float>(capacity_ah));
  cdr.number(static_cast<float>(capacity_ah));
  cdr.number(static_cast<float>(reading.charge));
  cdr.number(kDischarging);
  cdr.number(reading.empty != 0 ? kDead : kGood);
  cdr.number(kLithiumIon);
  cdr.number(static_cast<std::uint8_t>(1));
  cdr.count(0);
  cdr.count(0);
  cdr.text("");
  cdr.text("");
}

}  // namespace

std::uint16_t RosOutputs::channel(const std::string& topic, const char* type,
                                  const std::string& stream) {
  if (const auto at = channels_.find(topic); at != channels_.end()) return at->second;
  auto schema = schemas_.find(type);
  if (schema == schemas_.end())
    schema = schemas_.emplace(type, out_.add_schema(recording::ros_schema(type))).first;
  const std::uint16_t id =
      out_.add_channel({schema->second, topic, "cdr", {{kStreamKey, stream}, {kWayKey, kOut}}});
  channels_.emplace(topic, id);
  return id;
}

void RosOutputs::write(const std::string& topic, const char* type, const std::string& stream,
                       std::uint64_t sequence, std::int64_t log_ns, std::int64_t stamp_ns,
                       const std::string& bytes) {
  out_.message({channel(topic, type, stream), static_cast<std::uint32_t>(sequence), stamp(log_ns),
                stamp(stamp_ns), std::as_bytes(std::span(bytes))});
}

void RosOutputs::odometry(const std::string& name, const Pose& world_from_model,
                          const Vec3& linear_flu, const Vec3& angular_flu, std::int64_t now_ns) {
  std::string bytes;
  CdrWriter cdr(bytes);
  cdr.header(now_ns, kWorldFrame);
  cdr.text(base_of(name));
  cdr.vector(ros::enu_from_world(world_from_model.position_m));
  cdr.quaternion(ros::enu_from_body(world_from_model.rotation));
  unknown(cdr, 36);
  cdr.vector(linear_flu);
  cdr.vector(angular_flu);
  unknown(cdr, 36);
  write(topic_of(name) + "/odometry", "nav_msgs/msg/Odometry", name + "/odometry", odometries_ - 1,
        now_ns, now_ns, bytes);
}

void RosOutputs::step(const sim::Snapshot<PhysicsState>& snapshot) {
  const double period_s = std::max(1.0 / kOdometry_hz, world_.step_s());
  const std::uint64_t due = periods_at(snapshot.step, world_.step_s(), period_s) + 1;
  if (due == odometries_) return;
  odometries_ = due;
  const auto now_ns = static_cast<std::int64_t>(std::llround(snapshot.time_s * 1e9));
  const PhysicsState& state = snapshot.state;
  for (std::size_t i = 0; i < world_.vehicles().size(); ++i) {
    const rov::State& body = state.vehicles()[i].body;
    odometry(world_.vehicles()[i].name, world_pose(body.position_ned_m, body.attitude),
             ros::flu_from_marine(body.velocity.linear()),
             ros::flu_from_marine(body.velocity.angular()), now_ns);
  }
  for (std::size_t i = 0; i < world_.objects().size(); ++i) {
    const ObjectState& object = state.objects()[i];
    if (object.placed == 0) continue;
    const Quat model_from_world = glm::conjugate(object.motion.pose.rotation);
    odometry(world_.objects()[i].name, object.motion.pose,
             ros::flu_from_body(model_from_world * object.motion.velocity_m_s),
             ros::flu_from_body(model_from_world * object.motion.angular_velocity_rad_s), now_ns);
  }
}

bool RosOutputs::output(const Sample& sample, std::int64_t log_ns, std::int64_t stamp_ns) {
  const Stream& stream = world_.streams()[sample.header.stream];
  const std::string topic = topic_of(stream.name), owner = topic.substr(1, topic.rfind('/') - 1);
  std::string bytes;
  CdrWriter cdr(bytes);
  const auto send = [&](const std::string& to, const char* type) {
    write(to, type, stream.name, sample.header.sequence, log_ns, stamp_ns, bytes);
  };
  if (stream.sort == OwnerSort::kDiver) {
    if (const auto* motion = std::get_if<DiverMotion>(&sample.payload)) {
      const std::string name = stream.name.substr(0, stream.name.rfind('/'));
      odometry(name, motion->world_from_body, ros::flu_from_marine(motion->velocity_m_s),
               ros::flu_from_marine(motion->angular_rad_s), stamp_ns);
    }
    return false;
  }
  if (stream.sort != OwnerSort::kVehicle) return false;
  const rov::SensorSet& sensors = world_.vehicles()[stream.owner].file.sensors;
  if (const auto* imu = std::get_if<rov::ImuReading>(&sample.payload)) {
    cdr.header(stamp_ns, owner + "/imu_link");
    put_imu(cdr, *imu);
    send(topic, "sensor_msgs/msg/Imu");
    return true;
  }
  if (const auto* dvl = std::get_if<rov::DvlReading>(&sample.payload)) {
    cdr.header(stamp_ns, owner + "/dvl_link");
    put_dvl(cdr, *sensors.dvl, *dvl);
    send(topic, "marine_acoustic_msgs/msg/Dvl");
    return true;
  }
  if (const auto* altimeter = std::get_if<rov::AltimeterReading>(&sample.payload)) {
    cdr.header(stamp_ns, owner + "/altimeter_link");
    put_range(cdr, *sensors.altimeter, *altimeter);
    send(topic, "sensor_msgs/msg/Range");
    return true;
  }
  // These say more than the message of ROS: they have a message of our own beside it.
  if (const auto* pressure = std::get_if<rov::PressureReading>(&sample.payload)) {
    cdr.header(stamp_ns, owner + "/pressure_link");
    cdr.number(pressure->pressure_pa);
    cdr.number(0.0);
    send(topic_of(owner) + "/fluid_pressure", "sensor_msgs/msg/FluidPressure");
  }
  if (const auto* battery = std::get_if<BatteryReading>(&sample.payload)) {
    cdr.header(stamp_ns, owner + "/base_link");
    put_battery(cdr, *world_.vehicles()[stream.owner].file.parameters.battery, *battery);
    send(topic_of(owner) + "/battery_state", "sensor_msgs/msg/BatteryState");
  }
  if (const auto* usbl = std::get_if<rov::UsblReading>(&sample.payload); usbl && usbl->heard != 0) {
    cdr.header(stamp_ns, kWorldFrame);
    cdr.vector(ros::enu_from_ned(usbl->position_ned_m));
    send(topic_of(owner) + "/usbl_position", "geometry_msgs/msg/PointStamped");
  }
  return false;
}

}  // namespace neritic::testbed
