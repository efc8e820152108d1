// Vehicle sensors without noise against what they measure, and their noise against its statistics.
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "rov/bluerov2.hpp"
#include "rov/controller.hpp"
#include "rov/navigation_filter.hpp"
#include "rov/sensor_set.hpp"
#include "rov/step.hpp"
#include "tests/rov/random_vehicle.hpp"

namespace neritic::rov {
namespace {

// A flat bottom at a depth.
struct Bottom {
  double depth_m;
  static double cast(const void* context, const Vec3& origin, const Vec3& direction, double most) {
    const double distance = (static_cast<const Bottom*>(context)->depth_m - origin.z) / direction.z;
    return distance > 0.0 && distance <= most ? distance : std::numeric_limits<double>::infinity();
  }
  RayQuery query() const { return {&Bottom::cast, this}; }
};

TEST(RovSensor, ImuAtRestFeelsGravityAlone) {
  VehicleParameters p = bluerov2_heavy();
  p.buoyancy_n = p.weight_n;
  State state;
  state.attitude = glm::angleAxis(kPi / 2.0, Vec3(1, 0, 0));  // rolled to starboard
  p.buoyancy_centre_m = Vec3(0.0);
  const ImuReading read = read_imu({}, make_vehicle(p).value(), state, {}, {}, 0);
  EXPECT_LT(glm::length(read.specific_force_m_s2 - Vec3(0.0, -9.82, 0.0)), 1e-12);
  EXPECT_EQ(read.angular_rad_s, Vec3(0.0));
}

TEST(RovSensor, ImuIsTheSecondDerivativeOfItsPlace) {
  // Against differences of the flown path of a point off the origin, in a sensor turned about.
  const Vehicle vehicle = heavy_vehicle();
  Imu imu;
  imu.mount = {{0.3, -0.2, 0.1}, glm::angleAxis(0.7, glm::normalize(Vec3(1, 2, 3)))};
  Draws draws(5);
  State state = random_state(draws, 0.5);
  Inputs inputs;
  inputs.wrench = {{10, -5, 8, 0.5, 1, -2}};
  inputs.current_ned_m_s = {0.3, -0.2, 0.1};
  const double h = 1e-4;
  const auto place = [&](const State& s) {
    return s.position_ned_m + s.attitude * imu.mount.position_m;
  };
  State before = step(vehicle, state, inputs, h), now = step(vehicle, before, inputs, h),
        after = step(vehicle, now, inputs, h);
  const Vec3 acceleration = (place(after) - 2.0 * place(now) + place(before)) / (h * h);
  const Quat sensor_from_ned = glm::conjugate(imu.mount.rotation) * glm::conjugate(now.attitude);
  const Vec3 expected = sensor_from_ned * (acceleration - Vec3(0.0, 0.0, 9.82));
  const ImuReading read = read_imu(imu, vehicle, now, {}, {}, 0);
  EXPECT_LT(glm::length(read.specific_force_m_s2 - expected), 1e-4);
  EXPECT_LT(glm::length(imu.mount.rotation * read.angular_rad_s - now.velocity.angular()), 1e-12);
}

// Jolts between samples, and within a step: the readings add up to the turn and to the change of
// velocity, whatever the unit's rate is to the steps'.
TEST(RovSensor, ImuReadingsAddUpToTheMotionThroughJolts) {
  const Vehicle vehicle = heavy_vehicle();
  for (const double rate_hz : {37.0, 60.0, 120.0, 200.0, 240.0, 1000.0}) {
    SensorSet sensors;
    sensors.imu = Imu{.rate_hz = rate_hz};
    sensors.imu->mount = {{0.3, -0.2, 0.1}, glm::angleAxis(0.7, glm::normalize(Vec3(1, 2, 3)))};
    const Quat body_from_sensor = sensors.imu->mount.rotation;
    Draws draws(8);
    State state = random_state(draws, 0.3);
    SensorReadings readings;
    update_readings(sensors, {}, vehicle, state, {}, -1.0, 0.0, readings);
    const auto at = [&](const State& s) {
      return s.attitude * (s.velocity.linear() +
                           glm::cross(s.velocity.angular(), sensors.imu->mount.position_m));
    };
    Quat attitude = state.attitude;
    Vec3 velocity = at(state);
    double read_s = 0.0;
    std::uint64_t seen = readings.imu.count;
    State read = state;
    for (int i = 1; i <= 480; ++i) {
      state = step(vehicle, state, {}, 1.0 / 240.0);
      if (i % 31 == 0) {  // as a contact ends within a step
        state.velocity = state.velocity + vec6(Vec3(0.2, -0.1, 0.3), Vec3(-0.5, 0.8, 0.2));
        state.attitude = state.attitude * rotation_by({0.002, -0.001, 0.003});
      }
      const double now_s = i / 240.0;
      update_readings(sensors, {}, vehicle, state, {}, (i - 1) / 240.0, now_s, readings);
      if (std::exchange(seen, readings.imu.count) == readings.imu.count) continue;
      const ImuReading& imu = readings.imu.value;
      const double dt_s = now_s - std::exchange(read_s, now_s);
      const Vec3 turned = dt_s * (body_from_sensor * imu.angular_rad_s);
      const Quat half_way = attitude * rotation_by(0.5 * turned);
      velocity +=
          dt_s * (half_way * body_from_sensor * imu.specific_force_m_s2 + Vec3(0.0, 0.0, 9.82));
      attitude = attitude * rotation_by(turned);
      read = state;
    }
    EXPECT_GT(readings.imu.count, 70u);
    EXPECT_LT(glm::length(rotation_vector(glm::conjugate(attitude) * read.attitude)), 1e-10)
        << rate_hz;
    EXPECT_LT(glm::distance(velocity, at(read)), 1e-10) << rate_hz;
  }
}

TEST(RovSensor, PressureIsThatOfItsDepth) {
  PressureSensor sensor;
  sensor.mount.position_m = {-0.2, 0.0, 0.1};
  State state;
  state.position_ned_m.z = 10.0;
  state.attitude = glm::angleAxis(kPi / 2.0, Vec3(0, 1, 0));  // bow up: its tail is lower
  const SensorWater water{1025.0, 9.82, 101325.0};
  const PressureReading read = read_pressure(sensor, water, state, {}, 0);
  EXPECT_NEAR(read.depth_m, 10.2, 1e-9);
  EXPECT_NEAR(read.pressure_pa, 101325.0 + 1025.0 * 9.82 * 10.2, 1e-6);
  sensor.resolution_pa = 20.0;
  EXPECT_EQ(std::fmod(read_pressure(sensor, water, state, {}, 0).pressure_pa, 20.0), 0.0);
}

// The water presses, and the sensor's setting converts: 20 m of fresh water read by a sensor that
// is set for the sea, and for fresh water.
TEST(RovSensor, PressureIsThatOfTheWaterAndDepthThatOfTheSetting) {
  PressureSensor sensor;
  sensor.water_kg_m3 = 1025.0;
  const SensorWater lake{1000.0, 9.82, 95000.0};
  State state;
  state.position_ned_m.z = 20.0;
  EXPECT_NEAR(read_pressure(sensor, lake, state, {}, 0).pressure_pa, 95000.0 + 1000.0 * 9.82 * 20.0,
              1e-6);
  EXPECT_NEAR(read_pressure(sensor, lake, state, {}, 0).depth_m, 20.0 * 1000.0 / 1025.0, 1e-9);
  sensor.water_kg_m3 = 1000.0;
  EXPECT_NEAR(read_pressure(sensor, lake, state, {}, 0).depth_m, 20.0, 1e-9);
}

// A lake at 2000 m: zeroed there it reads its depth, zeroed at the sea 0.22 bar too little.
TEST(RovSensor, PressureCountsFromTheAirOverTheWater) {
  PressureSensor sensor;
  const SensorWater lake{1025.0, 9.82, 79495.0};
  State state;
  state.position_ned_m.z = 10.0;
  const double water_pa = 1025.0 * 9.82 * 10.0;
  EXPECT_NEAR(read_pressure(sensor, lake, state, {}, 0).pressure_pa, 79495.0 + water_pa, 1e-6);
  EXPECT_NEAR(read_pressure(sensor, lake, state, {}, 0).depth_m, 10.0, 1e-9);
  sensor.surface_pa = 101325.0;
  EXPECT_NEAR(read_pressure(sensor, lake, state, {}, 0).pressure_pa, 79495.0 + water_pa, 1e-6);
  EXPECT_NEAR(read_pressure(sensor, lake, state, {}, 0).depth_m,
              10.0 + (79495.0 - 101325.0) / (1025.0 * 9.82), 1e-9);
}

TEST(RovSensor, CompassReadsTheMagneticHeading) {
  Compass compass;
  compass.declination_rad = radians(3.0);
  State state;
  state.attitude = heading_attitude(radians(1.0)) * glm::angleAxis(0.4, Vec3(1, 0, 0));
  EXPECT_NEAR(degrees(read_compass(compass, state, {}, 0)), 358.0, 1e-9);
  compass.deviation_rad = radians(2.0);
  compass.deviation_phase_rad = radians(-89.0);
  EXPECT_NEAR(degrees(read_compass(compass, state, {}, 0)), 0.0, 1e-9);
}

TEST(RovSensor, DvlMeasuresVelocityAndAltitudeOverABottom) {
  Dvl dvl;
  dvl.mount = {{-0.1, 0.05, 0.12}, glm::angleAxis(0.3, Vec3(0, 0, 1))};
  const Bottom bottom{30.0};
  State state;
  state.position_ned_m = {1.0, 2.0, 20.0};
  state.attitude = heading_attitude(0.8) * glm::angleAxis(0.1, Vec3(1, 0, 0));
  state.velocity = {{0.5, -0.2, 0.1, 0.1, 0.2, -0.3}};
  const DvlReading read = read_dvl(dvl, {}, state, bottom.query(), {}, 0);
  ASSERT_TRUE(read.locked());
  EXPECT_EQ(read.heard, 15u);
  const Vec3 there =
      state.velocity.linear() + glm::cross(state.velocity.angular(), dvl.mount.position_m);
  EXPECT_LT(glm::length(dvl.mount.rotation * read.velocity_m_s - there), 1e-12);
  EXPECT_NEAR(read.altitude_m,
              30.0 - (state.position_ned_m + state.attitude * dvl.mount.position_m).z, 1e-9);
  EXPECT_FALSE(read_dvl(dvl, {}, state, Bottom{500.0}.query(), {}, 0).locked());
  EXPECT_FALSE(read_dvl(dvl, {}, state, {}, {}, 0).locked());
}

TEST(RovSensor, DvlHoldsOnThreeBeamsAndLosesLockOnTwo) {
  // Leaning until beams look over the horizon.
  const Bottom bottom{30.0};
  State state;
  state.position_ned_m.z = 20.0;
  state.velocity = {{0.4, 0.3, -0.1, 0, 0, 0}};
  std::array<int, 5> seen{};
  for (double lean = 0.0; lean < 1.5; lean += 0.01) {
    state.attitude = glm::angleAxis(lean, glm::normalize(Vec3(1.0, 0.6, 0.0)));
    const DvlReading read = read_dvl({}, {}, state, bottom.query(), {}, 0);
    const auto beams = static_cast<std::size_t>(std::popcount(read.heard));
    ++seen[beams];
    EXPECT_EQ(read.locked(), beams >= 3);
    if (read.locked()) {
      EXPECT_LT(glm::length(read.velocity_m_s - state.velocity.linear()), 1e-9);
    } else {
      EXPECT_EQ(read.velocity_m_s, Vec3(0.0));
    }
  }
  EXPECT_GT(seen[4], 0);
  EXPECT_GT(seen[3], 0);
  EXPECT_GT(seen[2], 0);
}

TEST(RovSensor, AltimeterLooksAlongItsAxis) {
  const Bottom bottom{30.0};
  State state;
  state.position_ned_m.z = 20.0;
  state.attitude = glm::angleAxis(kPi / 3.0, Vec3(1, 0, 0));
  const AltimeterReading read = read_altimeter({}, {}, state, bottom.query(), {}, 0);
  EXPECT_EQ(read.heard, 1u);
  EXPECT_NEAR(read.distance_m, 20.0, 1e-9);
  Altimeter near;
  near.most_m = 15.0;
  EXPECT_EQ(read_altimeter(near, {}, state, bottom.query(), {}, 0).heard, 0u);
}

TEST(RovSensor, UsblFindsTheBeacon) {
  Usbl usbl;
  usbl.transceiver_ned_m = {5.0, -3.0, 1.0};
  usbl.beacon_m = {0.0, 0.0, -0.2};
  State state;
  state.position_ned_m = {-20.0, 40.0, 25.0};
  const UsblReading read = read_usbl(usbl, {}, state, {}, 0);
  EXPECT_EQ(read.heard, 1u);
  EXPECT_LT(glm::distance(read.position_ned_m, state.position_ned_m + usbl.beacon_m), 1e-9);
  EXPECT_NEAR(read.travel_s, 2.0 * read.range_m / 1500.0, 1e-12);
  usbl.lost_share = 0.3;
  int lost = 0;
  for (std::uint64_t k = 0; k < 10000; ++k)
    lost += read_usbl(usbl, {}, state, {7, 1}, k).heard == 0;
  EXPECT_NEAR(lost, 3000, 150);
  usbl.most_m = 10.0;
  EXPECT_EQ(read_usbl(usbl, {}, state, {}, 0).heard, 0u);
}

// Fresh and warm over salty and cold.
WaterColumn halocline() {
  WaterColumn column{.temperature_c = 24.0, .salinity_psu = 2.0};
  column.layer[column.count++] = {
      .depth_m = 8.0, .thickness_m = 0.3, .temperature_c = 8.0, .salinity_psu = 35.0};
  return column;
}

// Whose weight is that of both layers: by the density of the lower one alone it is 2.2 kPa more.
TEST(RovSensor, PressureInLayersIsTheWeightOfAllAbove) {
  const LayeredWater layers(halocline());
  SensorWater water{1025.0, 9.82, 101325.0};
  water.layers = &layers;
  State state;
  state.position_ned_m.z = 30.0;
  const double upper = sea_density_kg_m3({24.0, 2.0}), lower = sea_density_kg_m3({8.0, 35.0});
  // The transition's middle lies at 8 m, and it is even.
  const double layers_pa = 9.82 * (8.0 * upper + 22.0 * lower);
  const PressureReading read = read_pressure({}, water, state, {}, 0);
  EXPECT_NEAR(read.pressure_pa, 101325.0 + layers_pa, 0.002 * 9.82 * 30.0);
  EXPECT_GT(101325.0 + 9.82 * lower * 30.0 - read.pressure_pa, 2000.0);
  // The conversion stays the sensor's.
  EXPECT_NEAR(read.depth_m, (read.pressure_pa - 101325.0) / (1025.0 * 9.82), 1e-9);
}

// By travel time through the water there is, and the speed of sound that it is set to.
TEST(RovSensor, UsblRangesAreThoseOfItsOwnSpeedOfSound) {
  const LayeredWater layers(WaterColumn{.temperature_c = 4.0, .salinity_psu = 0.0});
  SensorWater lake;
  lake.layers = &layers;
  Usbl usbl;
  State state;
  state.position_ned_m = {60.0, 0.0, 80.0};
  const double sound_m_s = 1.0 / layers.mean_slowness_s_m(0.0, 80.0);
  EXPECT_NEAR(sound_m_s, 1422.0, 1.0);
  const UsblReading read = read_usbl(usbl, lake, state, {}, 0);
  EXPECT_NEAR(read.travel_s, 200.0 / sound_m_s, 1e-9);
  EXPECT_NEAR(read.range_m, 100.0 * 1500.0 / sound_m_s, 1e-9);
  EXPECT_NEAR(read.position_ned_m.z, 80.0 * 1500.0 / sound_m_s, 1e-9);
  usbl.sound_m_s = sound_m_s;
  EXPECT_NEAR(read_usbl(usbl, lake, state, {}, 0).range_m, 100.0, 1e-9);
}

TEST(RovSensor, DvlAndAltimeterErrByTheSoundThatTheyAreSetTo) {
  const LayeredWater layers(halocline());
  SensorWater water;
  water.layers = &layers;
  const Bottom bottom{30.0};
  State state;
  state.position_ned_m.z = 20.0;
  state.velocity = {{0.5, -0.2, 0.1, 0, 0, 0}};
  Dvl dvl;
  // It measures the sound around it.
  const DvlReading exact = read_dvl(dvl, water, state, bottom.query(), {}, 0);
  EXPECT_LT(glm::length(exact.velocity_m_s - state.velocity.linear()), 1e-12);
  EXPECT_NEAR(exact.sound_m_s, layers.column().sound_speed_m_s(20.0), 1e-9);
  EXPECT_NEAR(exact.altitude_m, 10.0, 1e-9);
  dvl.sound_m_s = 1500.0;
  const DvlReading set = read_dvl(dvl, water, state, bottom.query(), {}, 0);
  const double scale = 1500.0 / layers.column().sound_speed_m_s(20.0);
  EXPECT_GT(scale, 1.01);
  EXPECT_LT(glm::length(set.velocity_m_s - scale * state.velocity.linear()), 1e-9);
  EXPECT_EQ(set.sound_m_s, 1500.0);
  EXPECT_NEAR(set.altitude_m, 10.0 * 1500.0 * layers.mean_slowness_s_m(20.0, 30.0), 1e-9);
  // The water of a scene that does not name it is as it is set.
  EXPECT_NEAR(read_dvl(dvl, {}, state, bottom.query(), {}, 0).altitude_m, 10.0, 1e-9);
  Altimeter altimeter;
  altimeter.sound_m_s = 1500.0;
  EXPECT_NEAR(read_altimeter(altimeter, water, state, bottom.query(), {}, 0).distance_m,
              10.0 * 1500.0 * layers.mean_slowness_s_m(20.0, 30.0), 1e-9);
}

TEST(RovSensorNoise, IsOffByDefaultAndOtherwiseAsSaid) {
  EXPECT_EQ((NoiseSource{3, 4}.error({}, 0, 5, 10.0)), 0.0);
  const Noise noise{0.2, 0.0, 0.0};
  const NoiseSource source{11, 3};
  double sum = 0.0, squares = 0.0, neighbours = 0.0, before = 0.0;
  const int n = 100000;
  for (int k = 0; k < n; ++k) {
    const double e = source.error(noise, 0, static_cast<std::uint64_t>(k), 100.0);
    sum += e;
    squares += e * e;
    neighbours += e * before;
    before = e;
  }
  EXPECT_NEAR(sum / n, 0.0, 4.0 * 0.2 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.2, 0.002);
  EXPECT_NEAR(neighbours / squares, 0.0, 0.015);
  // A bias that differs from dive to dive, and stays within one.
  double bias_squares = 0.0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const NoiseSource dive{seed, 3};
    const double b = dive.error({0.0, 0.5, 0.0}, 2, 0, 10.0);
    EXPECT_EQ(dive.error({0.0, 0.5, 0.0}, 2, 999, 10.0), b);
    bias_squares += b * b;
  }
  EXPECT_NEAR(std::sqrt(bias_squares / 4000), 0.5, 0.025);
}

TEST(RovSensorNoise, WalksHaveIndependentNormalStepsInAnyOrder) {
  // Over many walks: the variance after k steps is k, that of every single step 1, and steps that
  // do not overlap have nothing to do with each other.
  const std::uint64_t steps[] = {1, 2, 3, 7, 8, 100, 1000, 1023, 1024, 1025};
  const int walks = 4000;
  for (const std::uint64_t k : steps) {
    double squares = 0.0, step_squares = 0.0, product = 0.0;
    for (std::uint64_t walk = 0; walk < walks; ++walk) {
      const RandomKey key{walk, 5, 2};
      const double at = random_walk(key, k), next = random_walk(key, k + 1);
      squares += at * at;
      step_squares += (next - at) * (next - at);
      product += at * (next - at);
    }
    EXPECT_NEAR(squares / walks / static_cast<double>(k), 1.0, 0.1) << k;
    EXPECT_NEAR(step_squares / walks, 1.0, 0.1) << k;
    EXPECT_NEAR(product / walks / std::sqrt(static_cast<double>(k)), 0.0, 0.07) << k;
  }
  EXPECT_EQ(random_walk({1, 2, 3}, 0), 0.0);
  // In the sensor's units: after 100 s, ten times that after one.
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < walks; ++seed) {
    const double e = NoiseSource{seed, 0}.error({0.0, 0.0, 0.01}, 0, 5000, 50.0);
    squares += e * e;
  }
  EXPECT_NEAR(std::sqrt(squares / walks), 0.1, 0.005);
}

TEST(RovSensorSet, SamplesAtItsRatesAndTheSameWithAnyStep) {
  SensorSet sensors;
  sensors.imu = Imu{};
  sensors.imu->gyro.white = 0.01;
  sensors.dvl = Dvl{};
  sensors.dvl->noise.walk = 0.02;
  sensors.pressure = PressureSensor{};
  sensors.compass = Compass{};
  sensors.altimeter = Altimeter{};
  sensors.usbl = Usbl{};
  const Bottom bottom{30.0};
  const SensorWorld world{bottom.query(), 99, 3};
  const Vehicle vehicle = heavy_vehicle();
  State state;
  state.position_ned_m.z = 12.0;
  const auto after_ten_seconds = [&](int hz) {
    SensorReadings readings;
    for (int i = 0; i < 10 * hz; ++i)
      update_readings(sensors, world, vehicle, state, {}, i / double(hz), (i + 1) / double(hz),
                      readings);
    return readings;
  };
  const SensorReadings slow = after_ten_seconds(200), fast = after_ten_seconds(1000);
  EXPECT_EQ(fast.imu.count, 2000u);
  EXPECT_EQ(fast.dvl.count, 100u);
  EXPECT_EQ(fast.pressure.count, 200u);
  EXPECT_EQ(fast.heading_rad.count, 500u);
  EXPECT_EQ(fast.altimeter.count, 100u);
  EXPECT_EQ(fast.usbl.count, 10u);
  EXPECT_EQ(fast.imu.value.angular_rad_s, slow.imu.value.angular_rad_s);
  EXPECT_EQ(fast.dvl.value.velocity_m_s, slow.dvl.value.velocity_m_s);
  EXPECT_NE(fast.dvl.value.velocity_m_s, Vec3(0.0));
  EXPECT_EQ(fast.usbl.time_s, 10.0);
  // Another vehicle has other noise.
  SensorReadings other;
  update_readings(sensors, {bottom.query(), 99, 4}, vehicle, state, {}, 9.999, 10.0, other);
  EXPECT_NE(other.imu.value.angular_rad_s, fast.imu.value.angular_rad_s);
  // Nothing named, nothing said.
  SensorReadings none;
  update_readings({}, world, vehicle, state, {}, 0.0, 10.0, none);
  EXPECT_EQ(none.imu.count + none.dvl.count + none.pressure.count, 0u);
}

}  // namespace
}  // namespace neritic::rov
