#include "rov/navigation_model.hpp"

namespace neritic::rov {
namespace {

// Errors of exact sensors: motion between samples is not linear. So no sensor has a variance of 0.
constexpr double kLeastGyro = 2e-5;           // rad/s a root hertz
constexpr double kLeastAccelerometer = 3e-4;  // m/s^2 a root hertz
constexpr double kLeastDepth_m = 3e-4, kLeastSpeed_m_s = 3e-4, kLeastHeading_rad = 3e-4;

// The density of sea water near the surface, over the one that the pressure sensor is set to: from
// 1017 to 1030 kg/m^3 (EOS-80, salinity 25 to 37 and 0 to 25 degrees).
constexpr double kWaterShare = 0.003;
// The speed of sound over the one that an instrument is set to: from 1440 to 1545 m/s (Mackenzie
// 1981, 25 to 37 psu, 0 to 30 degrees, to 100 m) about 1500.
constexpr double kSoundShare = 0.02;

double square(double x) {
  return x * x;
}

double pa_per_m(const PressureSensor& sensor) {
  return sensor.water_kg_m3 * sensor.gravity_m_s2;
}

// For `count` biases from `place` on: their variance at first, and what it gathers a second.
void add_biases(NavigationModel& model, std::size_t place, std::size_t count, const Noise& noise,
                double unit = 1.0) {
  for (std::size_t i = place - kFirstBias; i < place - kFirstBias + count; ++i) {
    model.bias_variance[i] = square(unit * noise.bias);
    model.motion.walk[i] = square(unit * noise.walk);
  }
}

}  // namespace

std::string missing_for_navigation(const SensorSet& sensors) {
  std::string missing;
  const auto need = [&](bool there, const char* what) {
    if (!there) missing += (missing.empty() ? "" : ", ") + std::string(what);
  };
  need(sensors.imu.has_value(), "[imu]");
  need(sensors.pressure.has_value(), "[pressure]");
  need(sensors.compass.has_value(), "[compass]");
  need(sensors.dvl || sensors.usbl, "[dvl] or [usbl]");
  return missing;
}

NavigationModel navigation_model(const SensorSet& sensors, bool other_sound) {
  NERITIC_CHECK(sensors.imu.has_value(), "navigation without an inertial unit");
  NavigationModel out;
  out.imu = *sensors.imu;
  out.dvl = sensors.dvl;
  out.pressure = sensors.pressure;
  out.compass = sensors.compass;
  out.usbl = sensors.usbl;
  // White noise of a sample stands for the time of a sample: variance times the period.
  out.motion.gyro = square(out.imu.gyro.white) / out.imu.rate_hz + square(kLeastGyro);
  out.motion.accelerometer =
      square(out.imu.accelerometer.white) / out.imu.rate_hz + square(kLeastAccelerometer);
  add_biases(out, kAccelerometerBias, 3, out.imu.accelerometer);
  add_biases(out, kGyroBias, 3, out.imu.gyro);
  if (out.dvl) add_biases(out, kBeamBias, 4, out.dvl->noise);
  if (out.dvl && out.dvl->sound_m_s && other_sound)
    out.bias_variance[kBeamScale - kFirstBias] = square(kSoundShare);
  if (out.pressure) {
    add_biases(out, kPressureBias, 1, out.pressure->noise, 1.0 / pa_per_m(*out.pressure));
    out.bias_variance[kPressureScale - kFirstBias] = square(kWaterShare);
  }
  if (out.compass) {
    add_biases(out, kCompassBias, 1, out.compass->noise);
    // B and C of the deviation: its amplitude at an unknown phase.
    for (std::size_t i = 1; i <= 2; ++i)
      out.bias_variance[kCompassBias - kFirstBias + i] = square(out.compass->deviation_rad) / 2.0;
  }
  if (out.usbl) {
    add_biases(out, kUsblBias, 1, out.usbl->range_noise);
    add_biases(out, kUsblBias + 1, 2, out.usbl->direction_noise);
    if (other_sound) out.bias_variance[kRangeScale - kFirstBias] = square(kSoundShare);
  }
  return out;
}

double depth_variance(const PressureSensor& sensor) {
  const double unit = 1.0 / pa_per_m(sensor);
  return square(unit * sensor.noise.white) + square(unit * sensor.resolution_pa) / 12.0 +
         square(kLeastDepth_m);
}

double compass_variance(const Compass& compass) {
  return square(compass.noise.white) + square(kLeastHeading_rad);
}

double beam_variance(const Dvl& dvl, double speed_m_s) {
  return square(dvl.noise.white) + square(dvl.noise_share * speed_m_s) + square(kLeastSpeed_m_s);
}

}  // namespace neritic::rov
