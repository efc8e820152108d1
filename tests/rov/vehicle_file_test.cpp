// Vehicles from files, and the thrust table that they name.
#include "rov/vehicle_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rov/bluerov2.hpp"
#include "rov/step.hpp"
#include "tests/rov/cases.hpp"

namespace neritic::rov {
namespace {

using ::testing::HasSubstr;

std::filesystem::path vehicles() {
  return test::source_dir() / "assets/vehicles";
}

VehicleFile shipped(const char* name) {
  auto file = read_vehicle(vehicles() / name, kSeaDensity);
  EXPECT_TRUE(file.ok()) << file.error().message;
  return file.ok() ? std::move(file).value() : VehicleFile();
}

std::string vehicle_fault(const std::string& text) {
  const auto file = parse_vehicle(text, "v.toml", vehicles(), kSeaDensity);
  return file.ok() ? "" : file.error().message;
}

void expect_same(const VehicleParameters& a, const VehicleParameters& b) {
  const auto va = make_vehicle(a), vb = make_vehicle(b);
  ASSERT_TRUE(va.ok() && vb.ok());
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(va->mass, vb->mass);
  EXPECT_DOUBLE_EQ(va->weight_n, vb->weight_n);
  EXPECT_DOUBLE_EQ(va->buoyancy_n, vb->buoyancy_n);
  EXPECT_EQ(va->buoyancy_centre_m, vb->buoyancy_centre_m);
  EXPECT_EQ(va->linear_damping, vb->linear_damping);
  EXPECT_EQ(va->quadratic_damping, vb->quadratic_damping);
  ASSERT_EQ(va->thruster_count, vb->thruster_count);
  for (std::size_t i = 0; i < va->thruster_count; ++i) {
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_NEAR(va->thruster_wrench[i][k], vb->thruster_wrench[i][k], 1e-15);
    EXPECT_EQ(va->thrusters[i].min_n, vb->thrusters[i].min_n);
    EXPECT_EQ(va->thrusters[i].max_n, vb->thrusters[i].max_n);
  }
  EXPECT_EQ(va->lag.kind, vb->lag.kind);
}

TEST(RovVehicleFile, ShippedFilesAreTheBuiltInVehicles) {
  expect_same(shipped("bluerov2_heavy_dynamics.toml").parameters, bluerov2_heavy());
  expect_same(shipped("bluerov2_heavy_manual_dynamics.toml").parameters, bluerov2_heavy_manual());
  const ControlGains gains = shipped("bluerov2_heavy_dynamics.toml").gains;
  const ControlGains built_in = default_gains();
  EXPECT_EQ(gains.period_s, built_in.period_s);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(gains.axes[i].kp, built_in.axes[i].kp);
    EXPECT_EQ(gains.axes[i].i_max, built_in.axes[i].i_max);
    EXPECT_EQ(gains.axes[i].zone, built_in.axes[i].zone);
  }
}

TEST(RovVehicleFile, FaultsNameTheKeyWhatWasFoundAndWhatIsAccepted) {
  const std::string good = "mass_kg = 10\ninertia_kg_m2 = [0.2, 0.2, 0.3]\n";
  EXPECT_EQ(vehicle_fault(good), "");
  EXPECT_THAT(vehicle_fault("mass_kg = -3\ninertia_kg_m2 = [1, 1, 1]"),
              HasSubstr("v.toml:1: mass_kg: found -3; accepted: a number in"));
  EXPECT_THAT(vehicle_fault("mass_kg = nan\ninertia_kg_m2 = [1, 1, 1]"),
              HasSubstr("mass_kg: found \"nan\"; accepted: a number in"));
  EXPECT_THAT(vehicle_fault("inertia_kg_m2 = [1, 1, 1]"),
              HasSubstr("mass_kg: not found, but needed"));
  EXPECT_THAT(vehicle_fault("mass_kg = 10\ninertia_kg_m2 = [0, 0, 0]"),
              HasSubstr("v.toml: inertia_kg_m2: found a mass matrix that is not positive definite, "
                        "with mass 10"));
  EXPECT_THAT(vehicle_fault(good + "added_mas = 3"),
              HasSubstr("added_mas: not known; the nearest is add"));
  EXPECT_THAT(vehicle_fault(good + "added_mass = [1, 2]"),
              HasSubstr("accepted: 6 rows of 6 numbers, or 6 of a diagonal"));
  EXPECT_THAT(vehicle_fault(good + "linear_damping = [[1,9,0,0,0,0],[9,1,0,0,0,0],[0,0,1,0,0,0],"
                                   "[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]]"),
              HasSubstr("linear_damping: found a matrix that adds energy"));
  EXPECT_THAT(vehicle_fault(good + "[lag]\nkind = \"slow\""),
              HasSubstr("lag.kind: found \"slow\"; accepted: none,"));
  EXPECT_THAT(vehicle_fault(good + "[[thrusters]]\nposition_m = [0, 0, 0]"),
              HasSubstr("thrusters[0].direction: not found, but needed"));
  EXPECT_THAT(vehicle_fault(good + "[[thrusters]]\nposition_m = [0, 0, 0]\ndirection = [0, 0, 0]"),
              HasSubstr("direction: found [0,0,0]; accepted: a vector that is not 0"));
  EXPECT_THAT(vehicle_fault(good + "[tether]\nlength_m = -4"),
              HasSubstr("tether.length_m: found -4"));
  EXPECT_THAT(vehicle_fault(good + "[control]\nkp = [1, 1, 1, 1, 1, -1]"), HasSubstr("control.kp"));
  EXPECT_THAT(vehicle_fault(good + "thrust_table = \"none.csv\""),
              HasSubstr("none.csv: found no such file"));
  EXPECT_THAT(vehicle_fault("mass_kg = = 3"), HasSubstr("v.toml:1: not TOML"));
  EXPECT_THAT(vehicle_fault("include = \"bluerov2_heavy_dynamics.toml\"\nmass_kg = -1"),
              HasSubstr("mass_kg: found -1"));
  EXPECT_THAT(vehicle_fault("[=]"), HasSubstr("not TOML"));
  EXPECT_THAT(vehicle_fault("mass_kg = [1\xc3\xb8]"), HasSubstr("not TOML"));
}

TEST(RovVehicleFile, IncludesAreOverlaidAndLoopsAreRefused) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "loop.toml", "include = \"loop.toml\"\n").ok());
  const auto loop = read_vehicle(folder / "loop.toml", kSeaDensity);
  ASSERT_FALSE(loop.ok());
  EXPECT_THAT(loop.error().message, HasSubstr("found files nested deeper; accepted: 8 levels"));
  const auto over = parse_vehicle(
      "include = \"bluerov2_heavy_dynamics.toml\"\nmass_kg = 14\n[lag]\nkind = \"none\"\n",
      "v.toml", vehicles(), kSeaDensity);
  ASSERT_TRUE(over.ok()) << over.error().message;
  EXPECT_EQ(over->parameters.mass_kg, 14.0);
  EXPECT_EQ(over->parameters.thrusters.size(), 8u);
  EXPECT_EQ(over->parameters.lag.kind, ThrusterLag::Kind::kNone);
  EXPECT_EQ(over->parameters.lag.a1, 9258.0);
}

TEST(RovVehicleFile, SensorsAreThereWhereNamedAndQuietWhereNotTold) {
  const SensorSet none = shipped("bluerov2_heavy_dynamics.toml").sensors;
  EXPECT_FALSE(none.imu || none.dvl || none.pressure || none.compass || none.altimeter ||
               none.usbl);
  const SensorSet all = shipped("bluerov2_heavy_survey_dynamics.toml").sensors;
  ASSERT_TRUE(all.imu && all.dvl && all.pressure && all.compass && all.altimeter && all.usbl);
  EXPECT_NEAR(all.imu->gyro.white, radians(0.057), 1e-15);
  EXPECT_EQ(all.dvl->most_m, 50.0);
  EXPECT_EQ(all.pressure->resolution_pa, 20.0);
  const std::string body = "mass_kg = 10\ninertia_kg_m2 = [0.2, 0.2, 0.3]\n";
  const auto quiet = parse_vehicle(body + "[imu]\n[dvl]\n", "v.toml", vehicles(), kSeaDensity);
  ASSERT_TRUE(quiet.ok()) << quiet.error().message;
  EXPECT_TRUE(quiet->sensors.imu->gyro.off() && quiet->sensors.dvl->noise.off());
  EXPECT_THAT(vehicle_fault(body + "[dvl]\nrange_m = [5, 1]"),
              HasSubstr("dvl.range_m: found [5,1]"));
  EXPECT_THAT(vehicle_fault(body + "[imu]\ngyro_deg_s = { wite = 1 }"),
              HasSubstr("imu.gyro_deg_s.wite: not known; the nearest is white"));
}

// The scene's water and the vehicle's gravity, unless a table names its own.
TEST(RovVehicleFile, TetherAndSensorsAreInTheScenesWater) {
  const std::string text =
      "mass_kg = 10\ninertia_kg_m2 = [0.2, 0.2, 0.3]\ngravity_m_s2 = 9.78\n[tether]\n[imu]\n"
      "[pressure]\n";
  const auto lake = parse_vehicle(text, "v.toml", vehicles(), kFreshDensity);
  ASSERT_TRUE(lake.ok()) << lake.error().message;
  EXPECT_EQ(lake->parameters.tether->water_kg_m3, kFreshDensity);
  EXPECT_EQ(lake->gravity_m_s2, 9.78);
  EXPECT_EQ(lake->sensors.imu->gravity_m_s2, 9.78);
  EXPECT_EQ(lake->sensors.pressure->gravity_m_s2, 9.78);
  const auto named = parse_vehicle(
      "mass_kg = 10\ninertia_kg_m2 = [0.2, 0.2, 0.3]\n[tether]\n"
      "water_kg_m3 = 1010\n[imu]\ngravity_m_s2 = 9.8\n",
      "v.toml", vehicles(), kFreshDensity);
  ASSERT_TRUE(named.ok()) << named.error().message;
  EXPECT_EQ(named->parameters.tether->water_kg_m3, 1010.0);
  EXPECT_EQ(named->sensors.imu->gravity_m_s2, 9.8);
}

TEST(RovThrustCurve, ShippedTableIsTheMeasurementsToATenthOfANewton) {
  const auto curve = ThrustCurve::read(vehicles() / "t200_thrust.csv");
  ASSERT_TRUE(curve.ok()) << curve.error().message;
  // The maker's public measurements, September 2019.
  std::istringstream lines(data_text("t200_measured.csv"));
  std::string line;
  double squares[6] = {};
  int rows = 0;
  while (std::getline(lines, line)) {
    if (line.empty() || line[0] == '#' || line[0] == 'p') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    double pwm = 0.0;
    row >> pwm;
    for (int k = 0; k < 6; ++k) {
      double measured = 0.0;
      row >> measured;
      const double off = curve->thrust_n(pwm, 10.0 + 2.0 * k) - measured;
      ASSERT_LT(std::abs(off), 0.7) << pwm << " us, " << 10 + 2 * k << " V";
      squares[k] += off * off;
    }
    ++rows;
  }
  ASSERT_EQ(rows, 201);
  for (const double sum : squares) EXPECT_LT(std::sqrt(sum / rows), 0.12);
  EXPECT_NEAR(curve->most_n(16.0), kT200Max16V, 0.3);
  EXPECT_NEAR(curve->least_n(16.0), kT200Min16V, 0.3);
  EXPECT_EQ(curve->dead_band_us(16.0), (std::pair{1472.0, 1528.0}));
}

TEST(RovThrustCurve, RisesWithPulseAndVoltageAndComesBack) {
  const auto curve = ThrustCurve::read(vehicles() / "t200_thrust.csv");
  ASSERT_TRUE(curve.ok());
  for (const double volts : {10.0, 11.3, 14.8, 16.0, 19.9, 25.0}) {
    for (double pwm = 1100.0; pwm < 1900.0; pwm += 1.0)
      ASSERT_LE(curve->thrust_n(pwm, volts), curve->thrust_n(pwm + 1.0, volts)) << pwm;
    for (double n = curve->least_n(volts); n < curve->most_n(volts); n += 0.7)
      ASSERT_NEAR(curve->thrust_n(curve->pwm_us(n, volts), volts), n, 1e-9) << n << " " << volts;
    EXPECT_EQ(curve->thrust_n(1500.0, volts), 0.0);
    EXPECT_EQ(curve->pwm_us(1e6, volts), 1900.0);
    EXPECT_EQ(curve->pwm_us(-1e6, volts), 1100.0);
    EXPECT_EQ(curve->realised_n(0.0, volts), 0.0);
  }
  EXPECT_NEAR(curve->thrust_n(1700.0, 15.0),
              0.5 * (curve->thrust_n(1700.0, 14.0) + curve->thrust_n(1700.0, 16.0)), 1e-12);
  EXPECT_EQ(curve->thrust_n(1700.0, 30.0), curve->thrust_n(1700.0, 20.0));
}

// The published polynomial of ninth order falls near its ends: made a table, it must not.
TEST(RovThrustCurve, ACurveThatFallsIsMadeMonotoneBeforeItIsInverted) {
  std::vector<double> inputs;
  std::vector<std::vector<double>> thrust;
  for (int i = -100; i <= 100; ++i) {
    inputs.push_back(0.01 * i);
    thrust.push_back({von_benzon_thrust_n(0.01 * i)});
  }
  EXPECT_LT(thrust[200][0], thrust[196][0]);
  const auto curve = ThrustCurve::make(inputs, {16.0}, thrust);
  ASSERT_TRUE(curve.ok());
  double before = -1e9;
  for (double v = -1.0; v <= 1.0; v += 0.003) {
    const double now = curve->thrust_n(v, 16.0);
    ASSERT_GE(now, before);
    before = now;
  }
  EXPECT_NEAR(curve->thrust_n(0.5, 16.0), 16.5939453125, 1e-12);
  EXPECT_NEAR(curve->pwm_us(16.5939453125, 16.0), 0.5, 1e-9);
}

TEST(RovThrustCurve, FaultsAreSaidInOneLine) {
  const auto said = [](const char* text) {
    const auto curve = ThrustCurve::parse(text, "t.csv");
    return curve.ok() ? "" : curve.error().message;
  };
  EXPECT_EQ(said("# c\npwm_us,thrust_n_12v\n1100,-3\n1900,4\n"), "");
  EXPECT_THAT(said(""), HasSubstr("t.csv: found 0 pulse widths"));
  EXPECT_THAT(said("pwm,thrust_n_12v\n"), HasSubstr("t.csv:1: found another heading"));
  EXPECT_THAT(said("pwm_us,thrust_n_v\n"), HasSubstr("t.csv:1: found column 2"));
  EXPECT_THAT(said("pwm_us,thrust_n_12v\n1100,x\n"),
              HasSubstr("t.csv:2: found another row; accepted: 2 numbers"));
  EXPECT_THAT(said("pwm_us,thrust_n_12v\n1100,1\n1000,2\n"), HasSubstr("do not rise"));
}

TEST(RovThrustCurve, CommandsGoThroughDeadBandAndSaturation) {
  const VehicleFile file = shipped("bluerov2_heavy_dynamics.toml");
  Inputs inputs;
  inputs.thruster_n = {0.04, -0.04, 10.0, 100.0, -100.0, 0.0, 0.0, 0.0};
  drive(file, inputs);
  EXPECT_EQ(inputs.thruster_n[0], 0.0);  // nearest whole microsecond: in the dead band
  EXPECT_EQ(inputs.thruster_n[1], 0.0);
  EXPECT_NEAR(inputs.thruster_n[2], 10.0, 0.06);
  EXPECT_EQ(inputs.thruster_n[3], file.curve->most_n(16.0));
  EXPECT_EQ(inputs.thruster_n[4], file.curve->least_n(16.0));
  // A NaN gets through to the step, which refuses it, counts it and holds the last input.
  inputs.thruster_n[0] = std::numeric_limits<double>::quiet_NaN();
  inputs.thruster_n[1] = -std::numeric_limits<double>::infinity();
  drive(file, inputs);
  EXPECT_EQ(step(make_vehicle(file.parameters).value(), {}, inputs, 0.01).refused_inputs, 2u);
}

}  // namespace
}  // namespace neritic::rov
