// A navigation's model of the sensors: where they sit and how they err, from the same
// specification that the sensors' errors are drawn by (sensor_set.hpp). Built once, then only read;
// any thread.
#pragma once

#include <optional>
#include <string>

#include "rov/navigation_filter.hpp"
#include "rov/sensor_set.hpp"

namespace neritic::rov {

struct NavigationModel {
  Imu imu;
  std::optional<Dvl> dvl;
  std::optional<PressureSensor> pressure;
  std::optional<Compass> compass;
  std::optional<Usbl> usbl;
  MotionNoise motion;
  // Variances of the biases before anything was measured.
  std::array<double, kErrors - kFirstBias> bias_variance{};
};

// The sensors that must be added before the vehicle can navigate by them, as the tables of its file
// are named: "[imu], [compass]", "[dvl] or [usbl]". Empty: it can.
std::string missing_for_navigation(const SensorSet& sensors);
// other_sound: the water's speed of sound may be another than DVL and USBL are set to: in a scene
// that names its water. Precondition: nothing is missing.
NavigationModel navigation_model(const SensorSet& sensors, bool other_sound = false);

// The variance of a reading's white noise, discretisation included; and of one metre of depth.
double depth_variance(const PressureSensor& sensor);
double compass_variance(const Compass& compass);
double beam_variance(const Dvl& dvl, double speed_m_s);

}  // namespace neritic::rov
