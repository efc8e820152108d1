// The same bits for the same arguments: runs repeated, side by side, and on several threads; and
// what a step costs.
#include <gtest/gtest.h>

#include <thread>

#include "engine/core/hash.hpp"
#include "rov/closed_loop.hpp"
#include "rov/guidance.hpp"
#include "rov/sensor_set.hpp"
#include "tests/rov/random_vehicle.hpp"
#include "tests/support/cpu_time.hpp"
#include "tests/support/support.hpp"

namespace neritic::rov {
namespace {

static_assert(std::is_trivially_copyable_v<State> && std::is_trivially_copyable_v<Inputs> &&
              std::is_trivially_copyable_v<SensorReadings>);

std::uint64_t mission_hash() {
  WaypointFollower follower({{{2, 0, 10}, 0.5}, {{2, 2, 11}, 2.0}, {{0, 0, 10}, -1.0}});
  State start;
  start.position_ned_m.z = 10.0;
  const LoopRun run = fly(
      heavy_vehicle(), default_gains(), start,
      [&](const State& s, double) { return follower.update(s); }, 5.0);
  Hash64 hash;
  for (const State& state : run.states) hash.add(state);
  return hash.value();
}

TEST(RovDeterminism, AMissionHasOneHashOnAHundredRunsAndFourThreads) {
  const std::uint64_t first = mission_hash();
  for (int i = 0; i < 96; ++i) ASSERT_EQ(mission_hash(), first) << i;
  std::array<std::uint64_t, 4> hashes{};
  std::vector<std::thread> threads;
  for (std::uint64_t& hash : hashes) threads.emplace_back([&hash] { hash = mission_hash(); });
  for (std::thread& thread : threads) thread.join();
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, first);
}

TEST(RovDeterminism, AStepDependsOnItsArgumentsAlone) {
  // Two vehicles stepped in turn are as two stepped one after the other.
  Draws draws(1);
  const Vehicle a = random_vehicle(draws), b = random_vehicle(draws);
  const State start = random_state(draws, 1.0);
  State a1 = start, b1 = start, a2 = start, b2 = start;
  for (int i = 0; i < 100; ++i) {
    a1 = step(a, a1, {}, 0.01);
    b1 = step(b, b1, {}, 0.01);
  }
  for (int i = 0; i < 100; ++i) a2 = step(a, a2, {}, 0.01);
  for (int i = 0; i < 100; ++i) b2 = step(b, b2, {}, 0.01);
  EXPECT_EQ(a1.velocity, a2.velocity);
  EXPECT_EQ(b1.position_ned_m, b2.position_ned_m);
}

// One vehicle with control at 48 Hz and all sensors at 240 Hz is to take under 1 % of a core:
// 10 ms a second. With room for slow and busy machines, and for tests built with little
// optimisation.
TEST(RovSpeed, AVehicleWithAllItsSensorsTakesUnderAHundredthOfACore) {
  const Vehicle vehicle = heavy_vehicle();
  const Allocator allocator(vehicle);
  SensorSet sensors;
  sensors.imu = Imu{.rate_hz = 240.0, .gyro = {0.01, 0.01, 0.01}, .accelerometer = {0.1, 0.1, 0.1}};
  sensors.dvl = Dvl{.rate_hz = 240.0};
  sensors.pressure = PressureSensor{.rate_hz = 240.0};
  sensors.compass = Compass{.rate_hz = 240.0};
  sensors.altimeter = Altimeter{.rate_hz = 240.0};
  sensors.usbl = Usbl{.rate_hz = 240.0};
  const ControlGains gains = default_gains();
  const double two_seconds_ms = test::least_cpu_ms(20.0, [&] {
    State state;
    ControlState control;
    Setpoint s = stay(state);
    s.position_ned_m.x = 2.0;
    SensorReadings readings;
    Inputs inputs;
    for (int i = 0; i < 480; ++i) {
      if (i % 5 == 0) inputs = control_inputs(vehicle, allocator, gains, s, state, control);
      state = step(vehicle, state, inputs, 1.0 / 240.0);
      update_readings(sensors, {{}, 1, 2}, vehicle, state, {}, i / 240.0, (i + 1) / 240.0,
                      readings);
    }
    EXPECT_EQ(readings.imu.count, 480u);
  });
  RecordProperty("ms_a_second", fmt::format("{:.3f}", two_seconds_ms / 2.0));
  if (neritic::test::kFast) {
    EXPECT_LT(two_seconds_ms, 20.0);
  }
}

}  // namespace
}  // namespace neritic::rov
