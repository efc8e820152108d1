// How far navigation drifts over 20 minutes, against what was measured at sea with such sensors.
#include "tests/rov/navigation_runs.hpp"

namespace neritic::rov {
namespace {

constexpr double kMinutes = 20.0;

// Straight on at 0.5 m/s, facing ahead: no turn takes an error of the heading back.
Setpoint straight(const State& state, double) {
  const Vec3 end(640.0, 480.0, 10.0);
  return at_heading(go_to({}, state, {0, 0, 10}, end, 0.5), std::atan2(end.y, end.x));
}

struct Drift {
  double flown_m = 0.0;
  // After 20 minutes; of the inertial unit alone also after five, as it was published.
  double with_fixes_m = 0.0, with_dvl_m = 0.0, without_dvl_m = 0.0;
  double alone_m = 0.0, alone_five_minutes_m = 0.0;
};

Drift drift_of(std::uint64_t seed) {
  TrueFlight flight(straight, {0, 0, 10});
  const SensorSet all = sensors_of(seed);
  SensorSet with_dvl = all, without_dvl = all;
  with_dvl.usbl.reset();
  without_dvl.usbl.reset();
  without_dvl.dvl.reset();
  NavigationRun fixes(all, seed, flight.state());
  // The same readings to all of them.
  const auto start = [&](const SensorSet& sensors) {
    return start_navigation(navigation_model(sensors), fixes.readings,
                            surveyed_launch(flight.state().position_ned_m, seed, 0), 0.0);
  };
  const NavigationModel dvl_model = navigation_model(with_dvl),
                        no_dvl_model = navigation_model(without_dvl);
  SensorSet inertial;
  inertial.imu = all.imu;
  const NavigationModel alone_model = navigation_model(inertial);
  NavigationState dvl = start(with_dvl), no_dvl = start(without_dvl), alone = start(inertial);
  // A heading to start with, which the inertial unit alone has not.
  alone.attitude = dvl.attitude;
  Drift out;
  const auto error = [&](const NavigationModel& model, const NavigationState& state) {
    return glm::distance(estimate_of(model, state).position_ned_m, flight.state().position_ned_m);
  };
  const int steps = static_cast<int>(60.0 * kMinutes / kRunStep_s);
  for (int k = 1; k <= steps; ++k) {
    const Vec3 before = flight.state().position_ned_m;
    flight.step();
    out.flown_m += glm::distance(before, flight.state().position_ned_m);
    const double t = static_cast<double>(k) * kRunStep_s;
    fixes.step(flight.state(), t);
    update_navigation(dvl_model, fixes.readings, t, dvl);
    update_navigation(no_dvl_model, fixes.readings, t, no_dvl);
    update_navigation(alone_model, fixes.readings, t, alone);
    if (k == steps / 4) out.alone_five_minutes_m = error(alone_model, alone);
  }
  out.with_fixes_m = error(fixes.model(), fixes.state);
  out.with_dvl_m = error(dvl_model, dvl);
  out.without_dvl_m = error(no_dvl_model, no_dvl);
  out.alone_m = error(alone_model, alone);
  return out;
}

// With a DVL: a diver's console with a DVL and a magnetic compass erred by up to 5 % of the track
// with a one-cycle error of its compass, and by less than 1 % without (Hench and Rosman 2010, J.
// Atmos. Oceanic Technol. 27, 1229). Here the compass errs by 1.5 degrees and one cycle of 2.
// Without: a unit of the same class (Xsens MTi-1: 0.007 degrees/s a root hertz, here 0.004) that
// lay still read 3.3 to 41 km of way after 300 s, by axis and compensation (Transactions on
// Aerospace Research 2023, 10.2478/tar-2023-0022, static and rotated).
TEST(RovNavigationDrift, IsThatOfSuchSensorsAtSea) {
  constexpr int kRuns = 2;
  Drift sum;
  double flown_m = 0.0;
  for (std::uint64_t seed = 11; seed < 11 + kRuns; ++seed) {
    const Drift d = drift_of(seed);
    flown_m = d.flown_m;
    const auto add = [&](double Drift::*of) { sum.*of += d.*of * d.*of / kRuns; };
    add(&Drift::with_fixes_m), add(&Drift::with_dvl_m), add(&Drift::without_dvl_m);
    add(&Drift::alone_m), add(&Drift::alone_five_minutes_m);
  }
  const auto rms = [&](const char* name, double square) {
    RecordProperty(name, fmt::format("{:.3g} m", std::sqrt(square)));
    return std::sqrt(square);
  };
  EXPECT_NEAR(flown_m, 600.0, 10.0);
  // For one fix at this distance: 10.5 m.
  EXPECT_LT(rms("imu_dvl_depth_compass_usbl", sum.with_fixes_m), 3.0);
  const double with_dvl_m = rms("imu_dvl_depth_compass", sum.with_dvl_m);
  EXPECT_LT(with_dvl_m, 0.05 * flown_m);
  EXPECT_GT(with_dvl_m, 0.001 * flown_m);  // a ring laser gyro's (Tang et al. 2013, Sensors 13)
  EXPECT_GT(rms("imu_depth_compass", sum.without_dvl_m), 1000.0);
  const double alone_m = rms("imu_alone_300_s", sum.alone_five_minutes_m);
  EXPECT_GT(alone_m, 3.3e3);
  EXPECT_LT(alone_m, 41e3);
  EXPECT_GT(rms("imu_alone", sum.alone_m), alone_m);
}

}  // namespace
}  // namespace neritic::rov
