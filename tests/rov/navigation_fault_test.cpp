// Navigation when sensors fall silent, jump, or read what cannot be; and where it starts badly.
#include "engine/sim/fields.hpp"
#include "tests/rov/navigation_runs.hpp"
#include "tests/rov/random_vehicle.hpp"

namespace neritic::rov {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// No variance is negative, and no error is correlated with others beyond what is possible: every
// pivot of the correlations is positive, to rounding.
void expect_positive(const Covariance& p) {
  std::array<std::array<double, kErrors>, kErrors> l{};
  std::array<double, kErrors> sigma{};
  for (std::size_t i = 0; i < kErrors; ++i) {
    ASSERT_GE(p(i, i), 0.0) << i;
    sigma[i] = std::sqrt(p(i, i));
  }
  for (std::size_t i = 0; i < kErrors; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double scale = sigma[i] * sigma[j];
      double sum = i == j ? 1.0 + 1e-9 : scale > 0.0 ? p(i, j) / scale : 0.0;
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      if (i == j) {
        ASSERT_GT(sum, 0.0) << i;
        l[i][i] = std::sqrt(sum);
      } else {
        l[i][j] = sum / l[j][j];
      }
    }
}

using SensorFault = std::function<void(SensorReadings&, double time_s)>;

NavigationRun flown(std::uint64_t seed, double seconds, const SensorFault& fault = {},
                    const SensorSet* sensors = nullptr) {
  const auto& truth = circling(seconds);
  NavigationRun run(sensors ? *sensors : sensors_of(seed), seed, truth[0]);
  const auto steps = static_cast<std::size_t>(seconds / kRunStep_s);
  for (std::size_t k = 1; k <= steps; ++k) {
    const double time_s = static_cast<double>(k) * kRunStep_s;
    run.step(truth[k], time_s, [&](SensorReadings& r) {
      if (fault) fault(r, time_s);
    });
  }
  return run;
}

const State& truth_after(double seconds) {
  return circling(seconds)[static_cast<std::size_t>(seconds / kRunStep_s)];
}

double error_of(const NavigationRun& run, double seconds) {
  return glm::length(run.position_error(truth_after(seconds)));
}

TEST(RovNavigationFault, WithoutDvlForAMinuteItKnowsHowFarOffItIs) {
  const SensorFault silent = [](SensorReadings& r, double t) {
    if (t > 10.0 && t < 70.0) r.dvl.value.heard = 0;
  };
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const NavigationRun run = flown(seed, 69.0, silent);
    EXPECT_LT(error_of(run, 69.0), 1.0) << seed;  // fixes hold it: one of them is 0.2 to 0.4 m off
    sum += normalized_square(run.state, kPositionError, run.position_error(truth_after(69.0)));
    expect_positive(run.state.covariance);
    if (seed > 3) continue;
    EXPECT_LT(error_of(flown(seed, 80.0, silent), 80.0), 0.5) << seed;
  }
  EXPECT_LT(sum, 59.7);  // chi-square of 30, 99.9 %
}

TEST(RovNavigationFault, WithoutDvlAndUsblTheErrorGrowsAsItsCovarianceDoes) {
  const SensorFault silent = [](SensorReadings& r, double t) {
    if (t > 10.0) r.dvl.value.heard = r.usbl.value.heard = 0;
  };
  double sum = 0.0, most = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const NavigationRun run = flown(seed, 40.0, silent);
    const Vec3 error = run.position_error(truth_after(40.0));
    sum += normalized_square(run.state, kPositionError, error);
    most = std::max(most, glm::length(error));
    EXPECT_GT(glm::length(run.state.sigma3(kPositionError)), 1.0);
    EXPECT_LT(std::abs(error.z), 0.1) << "the pressure sensor still reads";
  }
  EXPECT_GT(most, 1.0);
  EXPECT_LT(sum, 59.7);
  EXPECT_GT(sum, 11.6);  // 0.1 %
}

TEST(RovNavigationFault, WithoutUsblTheDvlHoldsThePosition) {
  const SensorFault silent = [](SensorReadings& r, double) { r.usbl.value.heard = 0; };
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    EXPECT_LT(error_of(flown(seed, 60.0, silent), 60.0), 1.0) << seed;  // 30 m flown
}

TEST(RovNavigationFault, ACompassThatStopsLeavesTheHeadingToTheGyros) {
  const SensorFault stops = [](SensorReadings& r, double t) {
    static SensorReadings last;
    if (t < 10.0) last = r;
    r.heading_rad = last.heading_rad;
  };
  const NavigationRun run = flown(3, 60.0, stops);
  EXPECT_LT(std::abs(run.attitude_error(truth_after(60.0)).z), radians(6.0));
  EXPECT_LT(error_of(run, 60.0), 1.0);
}

// A log that locks onto something that moves: all beams read 0.8 m/s ahead of the truth.
TEST(RovNavigationFault, JumpsOfTheBottomLockAreRejected) {
  std::uint64_t wrong = 0;
  const SensorFault jumps = [&](SensorReadings& r, double t) {
    static std::uint64_t last = 0;
    if (!(t > 15.0 && t < 20.0)) return;
    if (r.dvl.count != last) ++wrong;
    last = r.dvl.count;
    for (std::size_t i = 0; i < 4; ++i)
      r.dvl.value.speed_m_s[i] += 0.8 * dvl_beam(*survey_file().sensors.dvl, i).x;
  };
  const NavigationRun clean = flown(4, 30.0), run = flown(4, 30.0, jumps);
  EXPECT_GT(wrong, 35u);
  for (const Aid beam : {Aid::kBeam0, Aid::kBeam1, Aid::kBeam2, Aid::kBeam3})
    EXPECT_GE(run.state.of(beam).rejected + 1, wrong);
  EXPECT_LT(error_of(run, 30.0), error_of(clean, 30.0) + 0.3);
  EXPECT_EQ(run.state.of(Aid::kBeam0).readmitted, 0u);
}

TEST(RovNavigationFault, FixesByMultipathAreRejected) {
  std::uint64_t wrong = 0;
  const SensorFault echoes = [&](SensorReadings& r, double) {
    if (r.usbl.count % 4 != 0 || r.usbl.value.heard == 0) return;
    static std::uint64_t last = 0;
    if (r.usbl.count != last) ++wrong;
    last = r.usbl.count;
    r.usbl.value.position_ned_m += Vec3(12.0, -16.0, 0.0);
  };
  const NavigationRun run = flown(5, 60.0, echoes), clean = flown(5, 60.0);
  EXPECT_GT(wrong, 10u);
  EXPECT_GE(run.state.of(Aid::kUsbl).rejected + 1, wrong);
  EXPECT_LT(error_of(run, 60.0), error_of(clean, 60.0) + 0.2);
}

// The vehicle is somewhere else than its navigation takes it to be: after five fixes it believes
// them.
TEST(RovNavigationFault, FixesThatStayAwayAreBelievedInTheEnd) {
  const Vec3 away(30.0, -20.0, 0.0);
  const SensorFault elsewhere = [&](SensorReadings& r, double t) {
    if (t > 10.0) r.usbl.value.position_ned_m += away;
  };
  EXPECT_LT(error_of(flown(6, 14.0, elsewhere), 14.0), 1.0);
  const NavigationRun run = flown(6, 45.0, elsewhere);
  EXPECT_LT(glm::length(run.position_error(truth_after(45.0)) + away), 1.0);
  EXPECT_EQ(run.state.begun_anew, 1u);
  EXPECT_GT(run.state.begun_anew_s, 13.0);
  EXPECT_LT(run.state.begun_anew_s, 18.0);
  expect_positive(run.state.covariance);
}

// A navigation that goes on from a state that is wrong by 25 degrees and 2 m/s, with a covariance
// that says it is right.
NavigationRun flown_lost(std::uint64_t seed, double seconds, const SensorSet& sensors) {
  const auto& truth = circling(seconds);
  NavigationRun run(sensors, seed, truth[0]);
  const auto steps = static_cast<std::size_t>(seconds / kRunStep_s);
  for (std::size_t k = 1; k <= steps; ++k) {
    if (k == 2500) {
      run.state.attitude = rotation_by({0.3, 0.3, 0.0}) * run.state.attitude;
      run.state.velocity_ned_m_s += Vec3(2.0, 0.0, 0.0);
    }
    run.step(truth[k], static_cast<double>(k) * kRunStep_s);
  }
  return run;
}

TEST(RovNavigationFault, ALostNavigationBeginsAnewByItsFixes) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const NavigationRun run = flown_lost(seed, 40.0, sensors_of(seed));
    EXPECT_GE(run.state.begun_anew, 1u);
    EXPECT_LT(run.state.begun_anew_s, 20.0);
    EXPECT_LT(error_of(run, 40.0), 0.8);
    EXPECT_LT(glm::length(run.velocity_error(truth_after(40.0))), 0.05);
    EXPECT_LT(glm::length(run.attitude_error(truth_after(40.0))), radians(4.0));
    EXPECT_LT(normalized_square(run.state, kPositionError, run.position_error(truth_after(40.0))),
              16.0);
    EXPECT_LT(normalized_square(run.state, kAttitudeError, run.attitude_error(truth_after(40.0))),
              16.0);
    expect_positive(run.state.covariance);
  }
}

// Without fixes the depth tells that it is lost. Where it is then stays unknown, and it knows that.
TEST(RovNavigationFault, ALostNavigationBeginsAnewByItsDepth) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    SensorSet sensors = sensors_of(seed);
    sensors.usbl.reset();
    const NavigationRun run = flown_lost(seed, 40.0, sensors);
    EXPECT_GE(run.state.begun_anew, 1u);
    EXPECT_LT(run.state.begun_anew_s, 20.0);
    EXPECT_LT(glm::length(run.velocity_error(truth_after(40.0))), 0.05);
    EXPECT_LT(glm::length(run.attitude_error(truth_after(40.0))), radians(4.0));
    EXPECT_LT(std::abs(run.position_error(truth_after(40.0)).z), 0.1);
    EXPECT_LT(normalized_square(run.state, kPositionError, run.position_error(truth_after(40.0))),
              16.0);
  }
}

// An emergency ascent, or a vehicle that is dropped: the force at the start is not gravity's.
TEST(RovNavigationFault, StartedWhileItAcceleratesItKnowsThatItIsNotLevelled) {
  const NavigationModel model = navigation_model(survey_file().sensors);
  for (const Vec3& acceleration :
       {Vec3(0, 0, -4), Vec3(0, 0, 3), Vec3(2, -1.5, 0), Vec3(3, 0, 2)}) {
    SensorReadings readings;
    readings.imu.count = 1;
    readings.imu.value.specific_force_m_s2 = acceleration - Vec3(0.0, 0.0, 9.82);
    const NavigationState state = start_navigation(model, readings, Vec3(0.0), 0.0);
    const Quat& q = state.attitude;
    const double off = 2.0 * std::hypot(q.x, q.y);
    EXPECT_GT(2.5 * state.sigma3(kAttitudeError).x, off);
    EXPECT_GT(state.sigma3(kAttitudeError).x, radians(10.0));
  }
}

TEST(RovNavigationFault, ReadingsThatAreNoNumbersAreRefusedAndCounted) {
  const SensorFault broken = [](SensorReadings& r, double t) {
    if (t < 10.0 || t > 12.0) return;
    r.dvl.value.speed_m_s = {kNone, 1e300, -1e300, std::numeric_limits<double>::infinity()};
    r.pressure.value.depth_m = 1e200;
    r.heading_rad.value = kNone;
    r.usbl.value.position_ned_m = {kNone, 0, 0};
    r.imu.value.angular_rad_s = {0, 1e200, 0};
  };
  const NavigationRun run = flown(7, 30.0, broken);
  for (const AidTally& aid : run.state.aids) EXPECT_GT(aid.refused, 0u);
  EXPECT_GT(run.state.imu_refused, 300u);
  EXPECT_TRUE(sim::all_finite(run.state));
  expect_positive(run.state.covariance);
  EXPECT_LT(error_of(run, 30.0), 0.7);
}

// Any bytes in any reading, at any times, for a thousand updates each.
TEST(RovNavigationFault, NoReadingsTakeTheStateOrItsCovarianceApart) {
  for (std::uint64_t n = 0; n < 40; ++n) {
    SCOPED_TRACE(n);
    Draws draws(400 + n);
    const auto any = [&] {
      const double kinds[] = {kNone,
                              std::numeric_limits<double>::infinity(),
                              draws.uniform(-1, 1) * draws.scale(1e-320, 1e300),
                              draws.uniform(-1, 1) * draws.scale(1e-6, 1e3),
                              0.0,
                              draws.uniform(-1, 1)};
      return kinds[static_cast<int>(draws.uniform(0, 6))];
    };
    NavigationRun run(sensors_of(n), n, circling(1.0)[0]);
    if (n % 4 == 1)  // variances that are hardly numbers
      for (std::size_t i = 0; i < kErrors; ++i)
        for (std::size_t j = i; j < kErrors; ++j)
          run.state.covariance.set(i, j, i == j ? 5e-324 : 0);
    double t = 0.0;
    SensorReadings r = run.readings;
    for (int k = 0; k < 1000; ++k) {
      const double steps[] = {0.0, 1e-9, 0.004, 0.004, 0.004, 5.0, -1.0, 1e5};
      t += steps[static_cast<int>(draws.uniform(0, 8))];
      sim::for_each_scalar(r, [&](auto& x) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(x)>, double>)
          if (draws.uniform(0, 1) < 0.3) x = any();
      });
      r.usbl.time_s = t;
      ++r.imu.count, ++r.dvl.count, ++r.pressure.count, ++r.heading_rad.count, ++r.usbl.count;
      r.dvl.value.heard = 15, r.usbl.value.heard = 1;
      update_navigation(run.model(), r, t, run.state);
      ASSERT_TRUE(sim::all_finite(run.state)) << n << " update " << k;
    }
    EXPECT_NEAR(glm::length(run.state.attitude), 1.0, 1e-9);
    expect_positive(run.state.covariance);
  }
}

TEST(RovNavigationFault, AnInertialUnitThatFallsSilentIsMissedForAsLongAsItIs) {
  const SensorFault silent = [](SensorReadings& r, double t) {
    static Reading<ImuReading> last;
    if (t < 10.0) last = r.imu;
    if (t > 10.0 && t < 13.0) r.imu = last;
  };
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const NavigationRun run = flown(seed, 30.0, silent);
    EXPECT_LT(error_of(run, 30.0), 0.7) << seed;
    EXPECT_LT(glm::length(run.velocity_error(truth_after(30.0))), 0.1) << seed;
    expect_positive(run.state.covariance);
  }
}

TEST(RovNavigationFault, ExactSensorsGiveAnExactPosition) {
  SensorSet exact = survey_file().sensors;
  exact.imu->gyro = exact.imu->accelerometer = exact.dvl->noise = exact.dvl->range_noise = {};
  exact.pressure->noise = exact.compass->noise = {};
  exact.usbl->range_noise = exact.usbl->direction_noise = {};
  exact.dvl->noise_share = exact.pressure->resolution_pa = exact.compass->deviation_rad = 0.0;
  const NavigationRun run = flown(9, 30.0, {}, &exact);
  EXPECT_LT(error_of(run, 30.0), 0.01);
  EXPECT_LT(glm::length(run.velocity_error(truth_after(30.0))), 0.003);
  EXPECT_LT(glm::length(run.attitude_error(truth_after(30.0))), radians(0.05));
}

TEST(RovNavigationFault, StartedUpsideDownItKnowsIt) {
  State state;
  teleport(state, {0, 0, 10}, heading_attitude(1.0) * glm::angleAxis(kPi - 0.1, Vec3(1, 0, 0)));
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    NavigationRun run(sensors_of(seed), seed, state);
    EXPECT_LT(glm::length(run.attitude_error(state)),
              4.5 * glm::length(run.state.sigma3(kAttitudeError)));
    EXPECT_LT(glm::length(run.attitude_error(state)), radians(15.0));
  }
}

TEST(RovNavigationFault, FarFromTheOriginItErrsAsAtTheOrigin) {
  const Vec3 far(1e5, -2e5, 0.0);
  SensorSet sensors = sensors_of(8), there = sensors;
  there.usbl->transceiver_ned_m += far;
  const auto& truth = circling(10.0);
  const auto moved = [&](State s) {
    s.position_ned_m += far;
    return s;
  };
  NavigationRun near_run(sensors, 8, truth[0]), far_run(there, 8, moved(truth[0]));
  for (std::size_t k = 1; k <= 2500; ++k) {
    near_run.step(truth[k], static_cast<double>(k) * kRunStep_s);
    far_run.step(moved(truth[k]), static_cast<double>(k) * kRunStep_s);
  }
  EXPECT_LT(glm::length(near_run.position_error(truth[2500]) -
                        far_run.position_error(moved(truth[2500]))),
            1e-6);
}

TEST(RovNavigationFault, SensorsThatAreMissingAreNamed) {
  SensorSet sensors = survey_file().sensors;
  EXPECT_EQ(missing_for_navigation(sensors), "");
  sensors.usbl.reset();
  EXPECT_EQ(missing_for_navigation(sensors), "");
  sensors.dvl.reset();
  sensors.compass.reset();
  EXPECT_EQ(missing_for_navigation(sensors), "[compass], [dvl] or [usbl]");
  EXPECT_EQ(missing_for_navigation({}), "[imu], [pressure], [compass], [dvl] or [usbl]");
}

}  // namespace
}  // namespace neritic::rov
