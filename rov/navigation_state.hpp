// A vehicle's knowledge of its motion: the state of an error-state Kalman filter (Solà 2017,
// "Quaternion kinematics for the error-state Kalman filter", arXiv:1711.02508), with its covariance
// and a tally of each aid's readings. World axes north, east, down; body axes forward, starboard,
// down. Plain bytes, all of them finite: a part of a simulation's state. Any thread.
#pragma once

#include <array>
#include <cstdint>

#include "rov/inertial_sensors.hpp"

namespace neritic::rov {

// Places in the error state. The attitude's error is a rotation in world axes (Solà, section 7):
// R = exp([e]x) R_estimated. The errors of velocity, position and biases are true less estimated.
enum ErrorPlace : std::size_t {
  kAttitudeError = 0,      // rad
  kVelocityError = 3,      // of the inertial unit over ground, m/s
  kPositionError = 6,      // of the inertial unit, m
  kFirstBias = 9,          // from here on: NavigationState::bias
  kAccelerometerBias = 9,  // body axes, m/s^2
  kGyroBias = 12,          // body axes, rad/s
  kBeamBias = 15,          // of the DVL's four beams, m/s
  kPressureBias = 19,      // of the depth, m
  kPressureScale = 20,  // of the depth: the water is lighter or heavier than the sensor's setting
  kCompassBias = 21,    // rad: A + B sin(heading) + C cos(heading)
  kUsblBias = 24,       // range, m; across the line of sight, level and upwards, rad
  kBeamScale = 27,      // of the DVL's speeds, and of USBL ranges: sound is faster or slower
  kRangeScale = 28,     // than the instrument is set to
  kErrors = 29,
};

// A symmetric matrix of kErrors rows: its upper triangle, row by row.
struct Covariance {
  static constexpr std::size_t kCount = kErrors * (kErrors + 1) / 2;
  std::array<double, kCount> upper{};

  double operator()(std::size_t i, std::size_t j) const {
    return i <= j ? upper[place(i, j)] : upper[place(j, i)];
  }
  void set(std::size_t i, std::size_t j, double value) {
    upper[i <= j ? place(i, j) : place(j, i)] = value;
  }
  static void fields(auto&& field, auto& self) { field("upper", self.upper); }

 private:
  // Precondition: i <= j.
  static constexpr std::size_t place(std::size_t i, std::size_t j) {
    return i * (2 * kErrors - i - 1) / 2 + j;
  }
};

// The sensors whose readings correct the motion that the inertial unit measures.
enum class Aid : std::size_t { kBeam0, kBeam1, kBeam2, kBeam3, kPressure, kCompass, kUsbl };
inline constexpr std::size_t kAids = 7;

struct AidTally {
  std::uint64_t accepted = 0;
  std::uint64_t rejected = 0;           // by the outlier test
  std::uint64_t refused = 0;            // not finite
  std::uint64_t readmitted = 0;         // accepted in spite of the test, after many rejections
  std::uint64_t rejected_in_a_row = 0;  // now
  // Normalized innovation squared of the last reading tested (Bar-Shalom 2001, section 5.4).
  double nis = 0.0;
  double accepted_s = 0.0;  // time of the last reading accepted

  static void fields(auto&& field, auto& self) {
    field("accepted", self.accepted);
    field("rejected", self.rejected);
    field("refused", self.refused);
    field("readmitted", self.readmitted);
    field("rejected_in_a_row", self.rejected_in_a_row);
    field("nis", self.nis);
    field("accepted_s", self.accepted_s);
  }
};

struct NavigationState {
  double time_s = 0.0;  // of attitude, velocity and position
  Quat attitude{1.0, 0.0, 0.0, 0.0};
  Vec3 velocity_ned_m_s{0.0};  // of the inertial unit, over ground
  Vec3 position_ned_m{0.0};    // of the inertial unit
  std::array<double, kErrors - kFirstBias> bias{};
  Covariance covariance;
  // The motion since the covariance's time: its duration, and the specific force added up.
  double pending_s = 0.0;
  Vec3 pending_ned_m_s{0.0};
  // The inertial unit's last good reading, body axes, when it was made, and how many were refused.
  ImuReading imu;
  double imu_s = 0.0;
  std::uint64_t imu_refused = 0;
  // How many times it was lost and began anew, and when it last did.
  std::uint64_t begun_anew = 0;
  double begun_anew_s = 0.0;
  std::array<AidTally, kAids> aids;
  // Number of each sensor's last reading that was taken in.
  std::uint64_t imu_used = 0, dvl_used = 0, pressure_used = 0, compass_used = 0, usbl_used = 0;

  const AidTally& of(Aid aid) const { return aids[static_cast<std::size_t>(aid)]; }
  Vec3 bias3(std::size_t place) const {
    const std::size_t i = place - kFirstBias;
    return {bias[i], bias[i + 1], bias[i + 2]};
  }
  // Standard deviations of three errors.
  Vec3 sigma3(std::size_t place) const {
    const auto sigma = [&](std::size_t i) { return std::sqrt(covariance(i, i)); };
    return {sigma(place), sigma(place + 1), sigma(place + 2)};
  }

  static void fields(auto&& field, auto& self) {
    field("time_s", self.time_s);
    field("attitude", self.attitude);
    field("velocity_ned_m_s", self.velocity_ned_m_s);
    field("position_ned_m", self.position_ned_m);
    field("bias", self.bias);
    field("covariance", self.covariance);
    field("pending_s", self.pending_s);
    field("pending_ned_m_s", self.pending_ned_m_s);
    field("imu", self.imu);
    field("imu_s", self.imu_s);
    field("imu_refused", self.imu_refused);
    field("begun_anew", self.begun_anew);
    field("begun_anew_s", self.begun_anew_s);
    field("aids", self.aids);
    field("imu_used", self.imu_used);
    field("dvl_used", self.dvl_used);
    field("pressure_used", self.pressure_used);
    field("compass_used", self.compass_used);
    field("usbl_used", self.usbl_used);
  }
};

}  // namespace neritic::rov
