// Contacts as a vehicle's inertial unit measures them.
#include "rov/sensor_set.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

// The inertial unit of one vehicle of a dive, read as its steps go by.
struct Feeler {
  const TestDive& dive;
  std::size_t vehicle = 0;
  rov::SensorSet sensors{};
  rov::SensorReadings readings{};
  // Sum of accelerations, readings and gravity, times the time that each stands for. World axes.
  Vec3 sum_m_s{0.0};

  Feeler(const TestDive& of, double rate_hz, std::size_t which = 0) : dive(of), vehicle(which) {
    sensors.imu = rov::Imu{.rate_hz = rate_hz};
  }
  void read() {
    const double before_s = readings.imu_from.time_s;
    const std::uint64_t count = readings.imu.count;
    const VehicleState& state = dive.vehicle(vehicle);
    rov::update_readings(sensors, {{}, 0, vehicle}, dive.world->vehicles()[vehicle].vehicle,
                         state.body, state.contact.acceleration,
                         dive.time_s() - dive.world->step_s(), dive.time_s(), readings);
    if (readings.imu.count > count)
      sum_m_s +=
          (dive.pose(vehicle).rotation * rov::world_from_ned(force()) - Vec3(0.0, 9.82, 0.0)) *
          (readings.imu_from.time_s - before_s);
  }
  // World axes.
  Vec3 velocity_m_s() const {
    return dive.pose(vehicle).rotation *
           rov::world_from_ned(dive.vehicle(vehicle).body.velocity.linear());
  }
  const Vec3& force() const { return readings.imu.value.specific_force_m_s2; }
};

const char* kBed =
    "[[objects]]\nname = \"bed\"\nclass = \"seabed\"\nshape = \"box\"\nsize_m = [20, 1, 20]\n"
    "position_m = [0, -20.5, 0]\n";
const char* kWall =
    "[[objects]]\nname = \"wall\"\nclass = \"wreck\"\nshape = \"box\"\nsize_m = [1, 20, 20]\n"
    "position_m = [2.5, -10, 0]\n";

// Lying on the bed, which bears what water does not: gravity, upward, as on a table.
TEST(FeltContact, AtRestOnTheBedItReadsGravityUpward) {
  TestDive dive = dive_of(std::string("[physics]\nwater_kg_m3 = 980\n") + kBed +
                          rov_text("position_m = [0, -19.5, 0]\nyaw_deg = 20\n"));
  Feeler imu(dive, 200.0);
  dive.run(30.0);
  ASSERT_GT(dive.vehicle().contact.near_points, 0u);
  const rov::Vehicle& vehicle = dive.world->vehicles()[0].vehicle;
  ASSERT_GT(vehicle.weight_n - vehicle.buoyancy_n, 2.0);  // N: 0.1 m/s^2 if nothing bore it
  dive.run(2.0, [&] {
    imu.read();
    if (imu.readings.imu.count == 0) return;
    const Vec3 up = glm::conjugate(dive.vehicle().body.attitude) * Vec3(0, 0, -9.82);
    ASSERT_LT(glm::distance(imu.force(), up), 5e-4) << dive.time_s();
  });
  EXPECT_NEAR(imu.force().z, -9.82, 1e-2);
  EXPECT_EQ(imu.readings.imu.count, 400u);
}

// At full thrust against a wall: nothing moves, nothing is felt but gravity.
TEST(FeltContact, HeldByAWallItReadsNoPush) {
  TestDive dive = dive_of(std::string("[physics]\n") + kWall +
                          rov_text("position_m = [1.2, -10, 0]\nyaw_deg = -90\n"));
  Piloting inputs;
  inputs.piloted = 1;
  inputs.pilot[0] = 60.0;  // 3 m/s^2 if nothing stood there
  pilot(dive, 0, inputs);
  dive.run(10.0);
  Feeler imu(dive, 100.0);
  dive.run(5.0, [&] {
    imu.read();
    if (imu.readings.imu.count == 0) return;
    const Vec3 up = glm::conjugate(dive.vehicle().body.attitude) * Vec3(0, 0, -9.82);
    ASSERT_LT(glm::distance(imu.force(), up), 0.05) << dive.time_s();
  });
  EXPECT_LT(dive.speed_m_s(), 5e-3);
  const rov::Vehicle& vehicle = dive.world->vehicles()[0].vehicle;
  const rov::State& body = dive.vehicle().body;
  EXPECT_GT(rov::derivative(vehicle, body, body.held).velocity[0], 2.0);  // without the wall
}

// A hit between two samples, or within one: the readings add up to the change of velocity, whatever
// the unit's rate.
TEST(FeltContact, AHitAddsUpToTheChangeOfVelocity) {
  for (const double rate_hz : {37.0, 100.0, 200.0, 240.0, 1000.0}) {
    TestDive dive = dive_of(std::string("[physics]\n") + kWall +
                            rov_text("position_m = [0.6, -10, 0]\nyaw_deg = -90\n"));
    Feeler imu(dive, rate_hz);
    Piloting inputs;
    inputs.piloted = 1;
    inputs.pilot[0] = 80.0;
    pilot(dive, 0, inputs);
    double fastest_m_s = 0.0, hardest = 0.0;
    dive.run(3.0, [&] {
      imu.read();
      fastest_m_s = std::max(fastest_m_s, dive.vehicle().body.velocity[0]);
      hardest = std::max(hardest, std::abs(imu.force().x));
    });
    ASSERT_GT(dive.vehicle().contact.touched_steps, 100u);
    ASSERT_GT(fastest_m_s, 0.5);
    // The sum holds all changes of velocity since the first reading, apart from the effect of
    // turning between two readings.
    EXPECT_LT(glm::distance(imu.sum_m_s, imu.velocity_m_s()), 0.1) << rate_hz;
    EXPECT_GT(hardest, 0.7 * fastest_m_s * std::min(rate_hz, 240.0)) << rate_hz;
  }
}

// So does a hit by another vehicle, on both.
TEST(FeltContact, VehiclesThatMeetFeelEachOther) {
  TestDive dive =
      dive_of("[physics]\n" + rov_text("position_m = [-1.5, -6, 0]\nyaw_deg = -90\n", "one") +
              rov_text("position_m = [0.5, -6, 0]\nyaw_deg = -90\n", "other"));
  Piloting ahead;
  ahead.piloted = 1;
  ahead.pilot[0] = 80.0;
  pilot(dive, 0, ahead);
  // At the steps' rate: between steps a reading says less than the velocity at the step's end.
  Feeler one(dive, 240.0, 0), other(dive, 240.0, 1);
  double fastest_m_s = 0.0;
  while (dive.vehicle(1).contact.touched_steps < 24 && dive.time_s() < 10.0) {
    dive.run(dive.world->step_s());
    one.read();
    other.read();
    fastest_m_s = std::max(fastest_m_s, dive.vehicle(0).body.velocity[0]);
  }
  ASSERT_GT(fastest_m_s, 0.5);
  ASSERT_GT(dive.vehicle(1).body.velocity[0], 0.2);
  EXPECT_LT(glm::distance(one.sum_m_s, one.velocity_m_s()), 0.02 * fastest_m_s);
  EXPECT_LT(glm::distance(other.sum_m_s, other.velocity_m_s()), 0.02 * fastest_m_s);
}

// Steps that touch and are halved feel the same.
TEST(FeltContact, InHalvesTheSameIsFelt) {
  TestDive dive = dive_of(std::string("[physics]\nmax_error_m = 0.002\nwater_kg_m3 = 980\n") +
                          kBed + rov_text("position_m = [0, -19.7, 0]\n"));
  ASSERT_GT(dive.world->method().contact_error_m, 0.0);
  dive.run(20.0);
  Feeler imu(dive, 200.0);
  dive.run(1.0, [&] {
    imu.read();
    if (imu.readings.imu.count > 0) {
      ASSERT_NEAR(imu.force().z, -9.82, 1e-2) << dive.time_s();
    }
  });
}

TEST(FeltContact, InOpenWaterNothingIs) {
  TestDive dive = dive_of("[physics]\n" + rov_text("position_m = [0, -10, 0]\n"));
  dive.run(2.0, [&] { ASSERT_EQ(dive.vehicle().contact.acceleration, rov::Vec6{}); });
}

}  // namespace
}  // namespace neritic::testbed
