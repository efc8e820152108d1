#include "rov/sensor_file.hpp"

namespace neritic::rov {
namespace {

constexpr double kMostRate = 1e4;  // Hz

double rate_of(const CaseField& field, double fallback) {
  return field["rate_hz"].number(fallback, 1e-3, kMostRate);
}

// { white = , bias = , walk = }, times what a unit of the file is here.
Noise noise_of(const CaseField& field, double unit = 1.0) {
  constexpr std::string_view kKeys[] = {"white", "bias", "walk"};
  field.allow(kKeys);
  return {unit * field["white"].number(0.0, 0.0, 1e9), unit * field["bias"].number(0.0, 0.0, 1e9),
          unit * field["walk"].number(0.0, 0.0, 1e9)};
}

// By which an instrument converts travel times; as in the sea, in fresh water or in other liquids.
std::optional<double> sound_of(const CaseField& field) {
  if (!field["sound_m_s"].present()) return std::nullopt;
  return field["sound_m_s"].number(1500.0, 100.0, 10000.0);
}

Quat turn(double degrees_about, const Vec3& axis) {
  return glm::angleAxis(radians(degrees_about), axis);
}

// Yaw about down, then pitch about starboard, then roll about forward.
Mount mount_of(const CaseField& field) {
  const auto angle = [&](const char* key) { return field[key].number(0.0, -360.0, 360.0); };
  return {field["position_m"].vec3(Vec3(0.0)), turn(angle("yaw_deg"), {0, 0, 1}) *
                                                   turn(angle("pitch_deg"), {0, 1, 0}) *
                                                   turn(angle("roll_deg"), {1, 0, 0})};
}

Imu read_imu_table(const CaseField& field, double gravity_m_s2) {
  constexpr std::string_view kKeys[] = {"position_m",         "yaw_deg",     "pitch_deg",
                                        "roll_deg",           "rate_hz",     "gyro_deg_s",
                                        "accelerometer_m_s2", "gravity_m_s2"};
  field.allow(kKeys);
  Imu imu;
  imu.mount = mount_of(field);
  imu.rate_hz = rate_of(field, imu.rate_hz);
  imu.gyro = noise_of(field["gyro_deg_s"], radians(1.0));
  imu.accelerometer = noise_of(field["accelerometer_m_s2"]);
  imu.gravity_m_s2 = field["gravity_m_s2"].number(gravity_m_s2, 0.0, 100.0);
  return imu;
}

Dvl read_dvl_table(const CaseField& field) {
  constexpr std::string_view kKeys[] = {"position_m", "yaw_deg",     "pitch_deg",      "roll_deg",
                                        "rate_hz",    "lean_deg",    "first_beam_deg", "range_m",
                                        "noise_m_s",  "noise_share", "range_noise_m",  "sound_m_s"};
  field.allow(kKeys);
  Dvl dvl;
  dvl.mount = mount_of(field);
  dvl.rate_hz = rate_of(field, dvl.rate_hz);
  dvl.lean_rad = radians(field["lean_deg"].number(degrees(dvl.lean_rad), 1.0, 80.0));
  dvl.first_beam_rad =
      radians(field["first_beam_deg"].number(degrees(dvl.first_beam_rad), -360.0, 360.0));
  if (const auto range = field["range_m"].numbers(2); !range.empty()) {
    dvl.least_m = range[0];
    dvl.most_m = range[1];
    if (!(range[0] >= 0.0 && range[1] > range[0])) field["range_m"].refuse("[least, most]");
  }
  dvl.noise = noise_of(field["noise_m_s"]);
  dvl.noise_share = field["noise_share"].number(0.0, 0.0, 1.0);
  dvl.range_noise = noise_of(field["range_noise_m"]);
  dvl.sound_m_s = sound_of(field);
  return dvl;
}

PressureSensor read_pressure_table(const CaseField& field, double gravity_m_s2) {
  constexpr std::string_view kKeys[] = {"position_m", "rate_hz",     "noise_pa",    "resolution_pa",
                                        "surface_pa", "water_kg_m3", "gravity_m_s2"};
  field.allow(kKeys);
  PressureSensor p;
  p.mount.position_m = field["position_m"].vec3(Vec3(0.0));
  p.rate_hz = rate_of(field, p.rate_hz);
  p.noise = noise_of(field["noise_pa"]);
  p.resolution_pa = field["resolution_pa"].number(0.0, 0.0, 1e6);
  if (field["surface_pa"].present()) p.surface_pa = field["surface_pa"].number(0.0, 0.0, 1e6);
  p.water_kg_m3 = field["water_kg_m3"].number(p.water_kg_m3, 1.0, 2000.0);
  p.gravity_m_s2 = field["gravity_m_s2"].number(gravity_m_s2, 0.1, 100.0);
  return p;
}

Compass read_compass_table(const CaseField& field) {
  constexpr std::string_view kKeys[] = {"rate_hz", "noise_deg", "declination_deg", "deviation_deg",
                                        "deviation_phase_deg"};
  field.allow(kKeys);
  const auto angle = [&](const char* key) {
    return radians(field[key].number(0.0, -360.0, 360.0));
  };
  Compass compass;
  compass.rate_hz = rate_of(field, compass.rate_hz);
  compass.noise = noise_of(field["noise_deg"], radians(1.0));
  compass.declination_rad = angle("declination_deg");
  compass.deviation_rad = angle("deviation_deg");
  compass.deviation_phase_rad = angle("deviation_phase_deg");
  return compass;
}

Altimeter read_altimeter_table(const CaseField& field) {
  constexpr std::string_view kKeys[] = {"position_m", "yaw_deg",     "pitch_deg",
                                        "roll_deg",   "rate_hz",     "range_m",
                                        "noise_m",    "noise_share", "sound_m_s"};
  field.allow(kKeys);
  Altimeter altimeter;
  altimeter.mount = mount_of(field);
  altimeter.rate_hz = rate_of(field, altimeter.rate_hz);
  if (const auto range = field["range_m"].numbers(2); !range.empty()) {
    altimeter.least_m = range[0];
    altimeter.most_m = range[1];
    if (!(range[0] >= 0.0 && range[1] > range[0])) field["range_m"].refuse("[least, most]");
  }
  altimeter.noise = noise_of(field["noise_m"]);
  altimeter.noise_share = field["noise_share"].number(0.0, 0.0, 1.0);
  altimeter.sound_m_s = sound_of(field);
  return altimeter;
}

Usbl read_usbl_table(const CaseField& field) {
  constexpr std::string_view kKeys[] = {"transceiver_ned_m",   "beacon_m",  "rate_hz",
                                        "sound_m_s",           "most_m",    "range_noise_m",
                                        "direction_noise_deg", "lost_share"};
  field.allow(kKeys);
  Usbl usbl;
  usbl.transceiver_ned_m = field["transceiver_ned_m"].vec3(Vec3(0.0));
  usbl.beacon_m = field["beacon_m"].vec3(Vec3(0.0));
  usbl.rate_hz = rate_of(field, usbl.rate_hz);
  usbl.sound_m_s = sound_of(field).value_or(usbl.sound_m_s);
  usbl.most_m = field["most_m"].number(usbl.most_m, 0.0, 1e5);
  usbl.range_noise = noise_of(field["range_noise_m"]);
  usbl.direction_noise = noise_of(field["direction_noise_deg"], radians(1.0));
  usbl.lost_share = field["lost_share"].number(0.0, 0.0, 1.0);
  return usbl;
}

}  // namespace

SensorSet read_sensors(const CaseField& vehicle, double gravity_m_s2) {
  SensorSet out;
  if (vehicle["imu"].present()) out.imu = read_imu_table(vehicle["imu"], gravity_m_s2);
  if (vehicle["dvl"].present()) out.dvl = read_dvl_table(vehicle["dvl"]);
  if (vehicle["pressure"].present())
    out.pressure = read_pressure_table(vehicle["pressure"], gravity_m_s2);
  if (vehicle["compass"].present()) out.compass = read_compass_table(vehicle["compass"]);
  if (vehicle["altimeter"].present()) out.altimeter = read_altimeter_table(vehicle["altimeter"]);
  if (vehicle["usbl"].present()) out.usbl = read_usbl_table(vehicle["usbl"]);
  return out;
}

}  // namespace neritic::rov
