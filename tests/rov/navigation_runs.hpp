// A flight over a flat bottom by the vehicle's own dynamics, its sensors' readings, and navigation
// by them: what the tests of navigation compare.
#pragma once

#include <gtest/gtest.h>

#include <limits>

#include "rov/closed_loop.hpp"
#include "rov/guidance.hpp"
#include "rov/navigation.hpp"
#include "rov/navigation_water.hpp"
#include "rov/vehicle_file.hpp"
#include "tests/support/support.hpp"

namespace neritic::rov {

inline constexpr double kRunStep_s = 1.0 / 250.0;

struct FlatBottom {
  double depth_m = 15.0;
  static double cast(const void* context, const Vec3& origin, const Vec3& direction, double most) {
    const double distance =
        (static_cast<const FlatBottom*>(context)->depth_m - origin.z) / direction.z;
    return distance > 0.0 && distance <= most ? distance : std::numeric_limits<double>::infinity();
  }
  RayQuery query() const { return {&FlatBottom::cast, this}; }
};

// The vehicle with every sensor, and the noise of such devices.
inline const VehicleFile& survey_file() {
  static const VehicleFile file =
      read_vehicle(test::source_dir() / "assets/vehicles/bluerov2_heavy_survey_dynamics.toml",
                   1028.0)
          .value();
  return file;
}

// A vehicle under control on its true state, one step at a time.
class TrueFlight {
 public:
  explicit TrueFlight(Guide guide, const Vec3& start = {4, 0, 10})
      : file_(survey_file()),
        vehicle_(make_vehicle(file_.parameters).value()),
        allocator_(vehicle_),
        guide_(std::move(guide)) {
    teleport(state_, start, Quat(1.0, 0.0, 0.0, 0.0));
  }
  void step() {
    if (steps_++ % 5 == 0)
      inputs_ = control_inputs(vehicle_, allocator_, file_.gains, guide_(state_, time_s()), state_,
                               control_);
    state_ = rov::step(vehicle_, state_, inputs_, kRunStep_s);
    time_s_ = static_cast<double>(steps_) * kRunStep_s;
  }
  const State& state() const { return state_; }
  const Vehicle& vehicle() const { return vehicle_; }
  double time_s() const { return time_s_; }

 private:
  VehicleFile file_;
  Vehicle vehicle_;
  Allocator allocator_;
  Guide guide_;
  State state_;
  Inputs inputs_;
  ControlState control_;
  std::uint64_t steps_ = 0;
  double time_s_ = 0.0;
};

// Round a circle of 4 m at 0.5 m/s, facing its centre, up and down by a metre.
inline Setpoint round_and_round(const State& state, double time_s) {
  Setpoint s = orbit({}, state, {0, 0, 10}, 4.0, 0.5);
  s.position_ned_m.z = 10.0 + std::sin(0.4 * time_s);
  s.velocity_ned_m_s.z = 0.4 * std::cos(0.4 * time_s);
  return look_at(s, {0, 0, s.position_ned_m.z});
}

// The states of that flight, one a step, flown once.
inline const std::vector<State>& circling(double seconds) {
  static std::vector<State> states;
  const auto wanted = static_cast<std::size_t>(seconds / kRunStep_s) + 1;
  static TrueFlight flight(round_and_round);
  if (states.empty()) states.push_back(flight.state());
  while (states.size() < wanted) {
    flight.step();
    states.push_back(flight.state());
  }
  return states;
}

// Readings of a seed, and the navigation by them. known: the scene's water; else the sensor's.
class NavigationRun {
 public:
  NavigationRun(const SensorSet& sensors, std::uint64_t seed, const State& start,
                const SensorWater& in = {}, const SensorWater* known = nullptr)
      : water(in),
        sensors_(sensors),
        seed_(seed),
        model_(navigation_model(sensors, in.layers != nullptr)) {
    if (known) allow_for_water(*known, 11.0, model_);
    read(start, -1.0, 0.0);
    state = start_navigation(model_, readings, surveyed_launch(start.position_ned_m, seed, 0), 0.0);
  }
  // before: changes readings on their way, as a fault would.
  void step(const State& truth, double time_s,
            const std::function<void(SensorReadings&)>& before = {}) {
    read(truth, time_s - kRunStep_s, time_s);
    SensorReadings told = readings;
    if (before) before(told);
    update_navigation(model_, told, time_s, state);
  }
  // True less estimated.
  Vec3 position_error(const State& truth) const {
    return truth.position_ned_m - estimate_of(model_, state).position_ned_m;
  }
  Vec3 velocity_error(const State& truth) const {
    return truth.attitude * truth.velocity.linear() - estimate_of(model_, state).velocity_ned_m_s;
  }
  Vec3 attitude_error(const State& truth) const {
    const Quat q = truth.attitude * glm::conjugate(state.attitude);
    return (q.w < 0.0 ? -2.0 : 2.0) * Vec3(q.x, q.y, q.z);
  }
  const NavigationModel& model() const { return model_; }

  SensorWater water;
  SensorReadings readings;
  NavigationState state;

 private:
  void read(const State& truth, double from_s, double to_s) {
    static const Vehicle vehicle = make_vehicle(survey_file().parameters).value();
    update_readings(sensors_, {bottom_.query(), seed_, 0, water}, vehicle, truth, {}, from_s, to_s,
                    readings);
  }
  SensorSet sensors_;
  std::uint64_t seed_;
  FlatBottom bottom_;
  NavigationModel model_;
};

// Sea water of this seed.
inline SensorWater water_of(std::uint64_t seed) {
  return {.water_kg_m3 = 1028.0 * (1.0 + 0.003 * random_normal({seed, 98, 0}, 0))};
}

// Errors over their covariance: of the chi-square distribution with three degrees of freedom.
inline double normalized_square(const NavigationState& state, std::size_t place,
                                const Vec3& error) {
  Mat3 p;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      p[j][i] = state.covariance(place + static_cast<std::size_t>(i),
                                 place + static_cast<std::size_t>(j));
  return glm::dot(error, glm::inverse(p) * error);
}

// The sensors of the survey vehicle with this seed's phase of the compass's deviation: magnets lie
// where they lie.
inline SensorSet sensors_of(std::uint64_t seed) {
  SensorSet sensors = survey_file().sensors;
  sensors.compass->deviation_phase_rad = 2.0 * kPi * random_uniform({seed, 99, 0}, 0);
  return sensors;
}

}  // namespace neritic::rov
