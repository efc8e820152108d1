// The filter's arithmetic against differences of the motion, dense matrices and least squares.
#include "engine/sim/fields.hpp"
#include "rov/navigation_measurements.hpp"
#include "tests/rov/navigation_runs.hpp"
#include "tests/rov/random_vehicle.hpp"

namespace neritic::rov {
namespace {

using Errors = std::array<double, kErrors>;
using Dense = std::vector<std::vector<double>>;

Dense zero(std::size_t rows, std::size_t columns) {
  return Dense(rows, std::vector<double>(columns, 0.0));
}
Dense times(const Dense& a, const Dense& b) {
  Dense out = zero(a.size(), b[0].size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k)
      for (std::size_t j = 0; j < b[0].size(); ++j) out[i][j] += a[i][k] * b[k][j];
  return out;
}
Dense transposed(const Dense& a) {
  Dense out = zero(a[0].size(), a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < a[0].size(); ++j) out[j][i] = a[i][j];
  return out;
}
// Gauss and Jordan's elimination with pivots.
Dense inverted(Dense a) {
  const std::size_t n = a.size();
  Dense out = zero(n, n);
  for (std::size_t i = 0; i < n; ++i) out[i][i] = 1.0;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    std::swap(a[k], a[pivot]), std::swap(out[k], out[pivot]);
    const double p = a[k][k];
    for (std::size_t j = 0; j < n; ++j) a[k][j] /= p, out[k][j] /= p;
    for (std::size_t i = 0; i < n; ++i) {
      const double f = a[i][k];
      if (i == k || f == 0.0) continue;
      for (std::size_t j = 0; j < n; ++j) a[i][j] -= f * a[k][j], out[i][j] -= f * out[k][j];
    }
  }
  return out;
}
Dense dense(const Covariance& p) {
  Dense out = zero(kErrors, kErrors);
  for (std::size_t i = 0; i < kErrors; ++i)
    for (std::size_t j = 0; j < kErrors; ++j) out[i][j] = p(i, j);
  return out;
}

// A state in full motion, with biases and a covariance A A^T.
NavigationState random_navigation(Draws& draws) {
  NavigationState s;
  s.attitude = draws.attitude();
  s.velocity_ned_m_s = draws.vec3(1.0);
  s.position_ned_m = draws.vec3(20.0);
  for (double& bias : s.bias) bias = draws.uniform(-0.02, 0.02);
  s.imu = {draws.vec3(0.5), draws.vec3(1.0) + Vec3(0, 0, -9.8)};
  Dense a = zero(kErrors, kErrors);
  for (auto& row : a)
    for (double& x : row) x = draws.uniform(-0.1, 0.1);
  const Dense p = times(a, transposed(a));
  for (std::size_t i = 0; i < kErrors; ++i)
    for (std::size_t j = i; j < kErrors; ++j) s.covariance.set(i, j, p[i][j]);
  return s;
}

// The error that takes a to b.
Errors difference(const NavigationState& a, const NavigationState& b) {
  Errors out{};
  const Quat q = b.attitude * glm::conjugate(a.attitude);
  const Vec3 turn = (q.w < 0.0 ? -2.0 : 2.0) * Vec3(q.x, q.y, q.z);
  const Vec3 v = b.velocity_ned_m_s - a.velocity_ned_m_s, x = b.position_ned_m - a.position_ned_m;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out[kAttitudeError + k] = turn[i], out[kVelocityError + k] = v[i];
    out[kPositionError + k] = x[i];
  }
  for (std::size_t i = kFirstBias; i < kErrors; ++i)
    out[i] = b.bias[i - kFirstBias] - a.bias[i - kFirstBias];
  return out;
}

NavigationState with_error(NavigationState s, std::size_t place, double error) {
  Errors e{};
  e[place] = error;
  add_error(s, e);
  return s;
}

TEST(RovNavigationFilter, FieldsNameEveryByte) {
  sim::check_fields_cover(NavigationState{});
}

TEST(RovNavigationFilter, ErrorsMoveAsDifferencesOfTheMotionDo) {
  Draws draws(31);
  for (int n = 0; n < 20; ++n) {
    const NavigationState start = random_navigation(draws);
    const auto moved = [&](NavigationState s) {
      for (int k = 0; k < 4; ++k) move(s, s.imu, 9.82, 0.005);
      return s;
    };
    const NavigationState end = moved(start);
    const Transition f = transition(end);
    for (std::size_t j = 0; j < kBeamBias; ++j) {
      const double h = 1e-5;
      const Errors up = difference(end, moved(with_error(start, j, h))),
                   down = difference(end, moved(with_error(start, j, -h)));
      for (std::size_t i = 0; i < kFirstBias; ++i)
        EXPECT_NEAR(f[i][j], (up[i] - down[i]) / (2.0 * h), 2e-4) << i << " by " << j;
    }
  }
}

TEST(RovNavigationFilter, CovarianceMovesAsTheDenseMatrixProduct) {
  Draws draws(32);
  NavigationState s = random_navigation(draws);
  MotionNoise noise{.gyro = 1e-4, .accelerometer = 2e-3, .walk = {}};
  for (double& walk : noise.walk) walk = draws.uniform(0.0, 1e-3);
  move(s, s.imu, 9.82, 0.2);
  Dense f = zero(kErrors, kErrors);
  const Transition t = transition(s);
  for (std::size_t i = 0; i < kErrors; ++i) f[i][i] = 1.0;
  for (std::size_t i = 0; i < kFirstBias; ++i)
    for (std::size_t j = 0; j < kBeamBias; ++j) f[i][j] = t[i][j];
  Dense expected = times(times(f, dense(s.covariance)), transposed(f));
  // The attitude is hardly known here: what is beyond first order acts for a second.
  const double bent_m_s2 = second_order(s, s.pending_ned_m_s) / 0.2;
  EXPECT_GT(bent_m_s2, 0.1);
  const double force = 2e-3 + bent_m_s2 * bent_m_s2 * 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    expected[i][i] += 1e-4 * 0.2;
    expected[3 + i][3 + i] += force * 0.2;
    expected[3 + i][6 + i] += force * 0.2 * 0.2 / 2;
    expected[6 + i][3 + i] += force * 0.2 * 0.2 / 2;
    expected[6 + i][6 + i] += force * 0.2 * 0.2 * 0.2 / 3;
  }
  for (std::size_t i = 9; i < kErrors; ++i) expected[i][i] += noise.walk[i - 9] * 0.2;
  move_covariance(s, noise);
  for (std::size_t i = 0; i < kErrors; ++i)
    for (std::size_t j = 0; j < kErrors; ++j)
      EXPECT_NEAR(s.covariance(i, j), expected[i][j], 1e-14);
}

// Against the root mean square over random attitudes of what the first order leaves.
TEST(RovNavigationFilter, TheSecondOrderOfAnAttitudeIsWhatTheFirstLeaves) {
  Draws draws(35);
  for (int n = 0; n < 10; ++n) {
    NavigationState s;
    const Vec3 sigma(draws.uniform(0.0, 0.3), draws.uniform(0.0, 0.3), draws.uniform(0.0, 0.3));
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = sigma[static_cast<int>(i)];
      s.covariance.set(i, i, x * x);
    }
    const Vec3 v = draws.vec3(5.0);
    double square = 0.0;
    constexpr std::uint64_t kDraws = 20000;
    for (std::uint64_t k = 0; k < kDraws; ++k) {
      const RandomKey key{35, static_cast<std::uint64_t>(n), k};
      const Vec3 e =
          sigma * Vec3(random_normal(key, 0), random_normal(key, 1), random_normal(key, 2));
      const Vec3 left = rotation_by(e) * v - v - glm::cross(e, v);
      square += glm::dot(left, left) / kDraws;
    }
    EXPECT_LT(std::sqrt(square), 1.03 * second_order(s, v)) << n;
    EXPECT_GT(std::sqrt(square), 0.9 * second_order(s, v)) << n;
  }
}

// Measurements of every sensor, at random places, in random motion, with every arm and bias in it.
TEST(RovNavigationFilter, MeasurementsChangeAsTheirDerivativesSay) {
  Draws draws(33);
  SensorSet sensors = survey_file().sensors;
  sensors.imu->mount = {{0.1, -0.05, 0.2}, draws.attitude()};
  sensors.dvl->mount.rotation = draws.attitude();
  sensors.usbl->transceiver_ned_m = {100, 80, 3};
  sensors.compass->declination_rad = 0.1;
  const NavigationModel model = navigation_model(sensors);
  UsblReading fix;
  fix.position_ned_m = {3, 4, 9};
  int checked = 0;
  for (int n = 0; n < 50; ++n) {
    const NavigationState s = random_navigation(draws);
    const auto check = [&](const auto& measure) {
      const Measurement m = measure(s);
      for (std::size_t j = 0; j < kErrors; ++j) {
        const double h = 1e-5;
        const Measurement up = measure(with_error(s, j, h)), down = measure(with_error(s, j, -h));
        for (std::size_t r = 0; r < m.count; ++r) {
          // The line of sight turns with the position: of second order in the fix's own biases.
          EXPECT_NEAR(m.change[r][j], (down.innovation[r] - up.innovation[r]) / (2.0 * h),
                      m.count == 3 ? 0.03 : 1e-6)
              << r << " by " << j;
          ++checked;
        }
      }
    };
    for (std::size_t beam = 0; beam < 4; ++beam)
      check([&](const NavigationState& x) { return beam_measurement(model, x, beam, 0.3); });
    check([&](const NavigationState& x) { return depth_measurement(model, x, 10.0); });
    check([&](const NavigationState& x) { return level_measurement(model, x); });
    check([&](const NavigationState& x) { return fix_measurement(model, x, fix, 0.2); });
    if (has_heading(s))
      check([&](const NavigationState& x) { return heading_measurement(model, x, 1.0); });
  }
  EXPECT_GT(checked, 50 * 26 * 11);
}

// The estimate after any number of measurements is the least squares of all of them and of what
// was known before (Gauss 1809); its covariance the inverse of the information added up.
TEST(RovNavigationFilter, CorrectionsAreTheLeastSquaresOfAllMeasurements) {
  Draws draws(34);
  NavigationState s = random_navigation(draws);
  s.attitude = Quat(1, 0, 0, 0);
  const NavigationState start = s;
  Dense information = inverted(dense(s.covariance));
  Dense weighted = zero(kErrors, 1);
  AidTally tally;
  for (int n = 0; n < 40; ++n) {
    Measurement m;
    m.count = 1 + static_cast<std::size_t>(n % 3);
    Dense h = zero(m.count, kErrors), y = zero(m.count, 1), r = zero(m.count, m.count);
    // Nothing of the attitude, whose errors do not add.
    const Errors so_far = difference(start, s);
    for (std::size_t k = 0; k < m.count; ++k) {
      for (std::size_t j = kVelocityError; j < kErrors; ++j)
        h[k][j] = m.change[k][j] = draws.uniform(-1.0, 1.0);
      y[k][0] = draws.uniform(-0.05, 0.05);
      m.innovation[k] = y[k][0];
      for (std::size_t j = 0; j < kErrors; ++j) m.innovation[k] -= h[k][j] * so_far[j];
      m.noise[k][k] = r[k][k] = draws.uniform(0.1, 0.2);
    }
    if (m.count > 1) m.noise[0][1] = m.noise[1][0] = r[0][1] = r[1][0] = 0.05;
    ASSERT_TRUE(correct(s, m, tally, 1000));
    const Dense weight = times(transposed(h), inverted(r));
    const Dense added = times(weight, h), moved = times(weight, y);
    for (std::size_t i = 0; i < kErrors; ++i) {
      for (std::size_t j = 0; j < kErrors; ++j) information[i][j] += added[i][j];
      weighted[i][0] += moved[i][0];
    }
  }
  const Dense expected = inverted(information);
  const Dense best = times(expected, weighted);
  const Errors found = difference(start, s);
  for (std::size_t i = 0; i < kErrors; ++i) {
    for (std::size_t j = 0; j < kErrors; ++j) EXPECT_NEAR(s.covariance(i, j), expected[i][j], 1e-9);
    if (i >= kVelocityError) {
      EXPECT_NEAR(found[i], best[i][0], 1e-7) << i;
    }
  }
  EXPECT_EQ(tally.accepted, 40u);
}

TEST(RovNavigationFilter, AnOutlierChangesNothingUntilItIsTheRule) {
  Draws draws(35);
  NavigationState s = random_navigation(draws);
  Measurement m;
  m.change[0][kPositionError] = 1.0;
  m.noise[0][0] = 1e-4;
  m.innovation[0] = 50.0;
  const NavigationState before = s;
  AidTally tally;
  for (int n = 1; n < 7; ++n) {
    EXPECT_FALSE(correct(s, m, tally, 7));
    EXPECT_TRUE(sim::same_bits(s, before));
  }
  EXPECT_TRUE(correct(s, m, tally, 7));
  EXPECT_NEAR(s.position_ned_m.x - before.position_ned_m.x, 50.0, 0.1);
  EXPECT_EQ(tally.rejected, 7u);
  EXPECT_EQ(tally.readmitted, 1u);
  EXPECT_EQ(tally.rejected_in_a_row, 0u);
}

// Rotation, gravity and acceleration with a closed form: a turn at a steady rate on a circle.
TEST(RovNavigationFilter, ACircleAtASteadyRateCloses) {
  const double w = 0.4, radius = 3.0, g = 9.82;
  NavigationState s;
  s.velocity_ned_m_s = {0.0, w * radius, 0.0};
  s.position_ned_m = {radius, 0.0, 5.0};
  s.attitude = heading_attitude(kPi / 2.0);  // along its way
  // In body axes the centre lies to starboard.
  s.imu = {{0, 0, w}, {0, w * w * radius, -g}};
  const double turn_s = 2.0 * kPi / w;
  for (int n = 0; n < 4000; ++n) move(s, s.imu, g, turn_s / 4000.0);
  EXPECT_LT(glm::length(s.position_ned_m - Vec3(radius, 0.0, 5.0)), 1e-4);
  EXPECT_NEAR(heading_of(s.attitude), kPi / 2.0, 1e-9);
}

}  // namespace
}  // namespace neritic::rov
