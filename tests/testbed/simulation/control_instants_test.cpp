// Control acts at its own instants whatever the rate of the physics, and sensors sample at theirs:
// missions against one flown by RK4 in steps of a twentieth of a control period.
#include <cmath>

#include "rov/guidance.hpp"
#include "rov/thrust_priority.hpp"
#include "testbed/simulation/instants.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

constexpr double kEach_s = 3.0;

std::string flight_text(const std::string& physics, const std::string& dynamics,
                        const std::string& keys = "") {
  return fmt::format(R"([physics]
{}
[current]
kind = "uniform"
velocity_m_s = [0.1, 0, 0.15]
[[vehicles]]
name = "rov"
shape = "box"
size_m = [0.57, 0.26, 0.46]
dynamics = "{}"
position_m = [0, -10, 0]
{}
[vehicles.mission]
speed_m_s = 0.5
acceptance_m = 0.3
waypoints = [
  {{ position_m = [0.5, -10, -3] }},
  {{ position_m = [3, -9, -3], heading_deg = 200 }},
  {{ position_m = [3, -9.5, 0] }},
]
)",
                     physics, dynamics, keys);
}

// Where the vehicle is each time that kEach_s has passed, by its own loop: the controller at the
// start of every period, RK4 in between.
std::vector<Vec3> flown_by_periods(const PhysicsWorld& world, double seconds) {
  const PhysicsVehicle& rov = world.vehicles()[0];
  const rov::ControlGains& gains = rov.file.gains;
  const PhysicsState all = world.start();
  rov::State state = rov.start;
  MissionState mission = mission_start(state);
  rov::ControlState control;
  std::vector<Vec3> out;
  const auto periods = static_cast<std::int64_t>(std::llround(seconds / gains.period_s));
  const auto in_each = static_cast<std::int64_t>(std::llround(kEach_s / gains.period_s));
  for (std::int64_t k = 1; k <= periods; ++k) {
    const double time_s = static_cast<double>(k - 1) * gains.period_s;
    const rov::Setpoint setpoint = rov::lean(rov.mission->update(all, state, time_s, mission),
                                             state, gains.period_s, mission.lean_ned_m);
    control.speed_n = mission.speed_n;  // the mission begins it anew on each leg
    rov::Inputs inputs =
        rov::level_inputs(rov.vehicle, rov.kind.allocator, gains, setpoint, state, control);
    mission.speed_n = control.speed_n;
    inputs.current_ned_m_s = rov::ned_from_world(Vec3(0.1, 0.0, 0.15));
    for (int i = 0; i < 20; ++i)
      state = rov::step(rov.vehicle, state, inputs, gains.period_s / 20, rov::Integrator::kRk4);
    if (k % in_each == 0) out.push_back(state.position_ned_m);
  }
  return out;
}

// A BlueROV2 whose pulses are not rounded to microseconds; keys of its file follow.
std::string smooth_vehicle(const test::ScratchFolder& scratch, const std::string& name,
                           const std::string& keys) {
  std::string text = read_text(vehicles_folder() + "/bluerov2_heavy_dynamics.toml").value();
  const auto table = text.find("thrust_table"), lag = text.find("[control]");
  text.replace(lag, std::string("[control]\nrate_hz = 50").size(), keys);
  text.erase(table, text.find("\n[[", table) - table);
  EXPECT_TRUE(write_text(scratch / name, text).ok());
  return (scratch / name).string();
}

TEST(ControlInstants, AMissionIsTheSameWhateverTheRatesOfPhysicsAndControl) {
  const test::ScratchFolder scratch;
  for (const double control_hz : {50.0, 30.0, 100.0 / 3.0}) {
    const std::string vehicle =
        smooth_vehicle(scratch, "rov.toml", fmt::format("[control]\nrate_hz = {}", control_hz));
    const TestDive truth = dive_of(flight_text("", vehicle));
    const std::vector<Vec3> wanted = flown_by_periods(*truth.world, 15.0);
    for (const double rate_hz : {240.0, 100.0, 80.0, 60.0}) {
      TestDive dive = dive_of(flight_text(fmt::format("rate_hz = {}", rate_hz), vehicle));
      double most_m = 0.0;
      for (const Vec3& there : wanted) {
        dive.run(kEach_s);
        most_m = std::max(most_m, glm::distance(dive.vehicle().body.position_ned_m, there));
      }
      EXPECT_LT(most_m, 1e-6) << control_hz << " Hz of control at " << rate_hz;
      EXPECT_EQ(dive.vehicle().mission.arrived, 2u);
    }
  }
}

// Rounded to steps of 60 Hz an inertial unit of 200 Hz would lose two samples of three.
TEST(ControlInstants, SensorsSampleAtTheirOwnTimesWhateverTheRateOfThePhysics) {
  const test::ScratchFolder scratch;
  const std::string vehicle = smooth_vehicle(
      scratch, "rov.toml",
      "[imu]\nrate_hz = 200\n[dvl]\nrate_hz = 7\n[pressure]\nrate_hz = 30\n[compass]\n"
      "rate_hz = 33\n[usbl]\nrate_hz = 0.9\n[control]\nrate_hz = 50");
  const std::string floor =
      "[[objects]]\nclass = 'seabed'\nshape = 'plane'\nsize_m = [90, 90]\nposition_m = [0, -14, "
      "0]\n";
  const auto flown = [&](double rate_hz) {
    TestDive dive = dive_of(flight_text(fmt::format("rate_hz = {}", rate_hz), vehicle) + floor);
    dive.run(8.0);
    return dive;
  };
  const TestDive truth = flown(1000.0);
  const rov::SensorReadings& wanted = truth.state().readings()[0];
  EXPECT_EQ(wanted.imu.count, 1601u);
  EXPECT_EQ(wanted.usbl.count, 8u);
  for (const double rate_hz : {240.0, 100.0, 60.0}) {
    const TestDive dive = flown(rate_hz);
    const rov::SensorReadings& read = dive.state().readings()[0];
    EXPECT_EQ(read.imu.count, wanted.imu.count);
    EXPECT_EQ(read.dvl.count, wanted.dvl.count);
    EXPECT_EQ(read.usbl.count, wanted.usbl.count);
    EXPECT_LT(
        glm::distance(read.imu.value.specific_force_m_s2, wanted.imu.value.specific_force_m_s2),
        1e-5)
        << rate_hz;
    EXPECT_LT(glm::distance(read.dvl.value.velocity_m_s, wanted.dvl.value.velocity_m_s), 1e-6);
    EXPECT_NEAR(read.heading_rad.value, wanted.heading_rad.value, 1e-6);
    // Its own estimate, and the one of a run from the true start.
    EXPECT_LT(glm::distance(dive.world->estimate(dive.state(), 0)->position_ned_m,
                            truth.world->estimate(truth.state(), 0)->position_ned_m),
              2e-6)
        << rate_hz;
    EXPECT_LT(glm::distance(dive.pose().position_m, truth.pose().position_m), 2e-6) << rate_hz;
  }
}

// At any two rates each instant is found once, from the one before.
TEST(ControlInstants, EveryInstantIsInOneStep) {
  for (const double rate_hz : {50.0, 33.3, 1000.0, 0.7, 59.9999, 240.0})
    for (const double step_s : {1.0 / 240.0, 1.0 / 60.0, 0.01, 1.0 / 77.7}) {
      const Instants instants(rate_hz, step_s);
      std::uint64_t found = 0;
      for (std::uint64_t step = 0; step < 2000; ++step)
        for (double at = 0.0; at < 1.0; at = instants.next(step, at)) {
          if (instants.at(step, at)) ++found;
          const double index = (static_cast<double>(step) + at) * step_s * rate_hz;
          EXPECT_EQ(instants.at(step, at),
                    std::abs(index - std::round(index)) < 3e-8 * step_s * rate_hz + 1e-12);
        }
      const double all = 2000.0 * step_s * rate_hz;
      EXPECT_EQ(found, static_cast<std::uint64_t>(std::ceil(all - 1e-6)))
          << rate_hz << " " << step_s;
    }
}

}  // namespace
}  // namespace neritic::testbed
