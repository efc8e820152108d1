// A sonar that moves while it listens, and one that turns from ping to ping.
#include "sonar/head.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarMotion = test::GpuTest;

constexpr double kSpeed = 3.0;

// Towards the wall at kSpeed, through the origin at time 0.
scene::Scene closing_in(const scene::SonarMotion& motion) {
  scene::Sonar sonar = sonar_of(2.0, 4.0, 2000);
  sonar.terms.water.sound_speed_m_s = 1500.0;
  sonar.terms.frequency_hz = 750e3;
  sonar.terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 60e3};
  sonar.terms.motion = motion;
  scene::Scene scene = wall(3.0, sonar);
  scene.sonars[0].mount.track = scene::Track{
      {{-1.0, Vec3(0, 0, kSpeed)}, {1.0, Vec3(0, 0, -kSpeed)}}, {{0.0, Quat(1, 0, 0, 0)}}};
  return scene;
}

TEST_F(SonarMotion, ClosingInWithinThePingShortensTheWayBack) {
  const double still = mean_range_m(ping(device(), closing_in({})));
  const double moving = mean_range_m(ping(device(), closing_in({.within_ping = true})));
  // v / c of the range, on the axis; less by the cosine off it.
  EXPECT_NEAR((still - moving) / (3.0 * kSpeed / 1500.0), 1.0, 0.03);
}

TEST_F(SonarMotion, AChirpReadsAClosingTargetTooNear) {
  const double still = mean_range_m(ping(device(), closing_in({})));
  const double moving =
      mean_range_m(ping(device(), closing_in({.doppler = true, .pulse_s = 500e-6})));
  EXPECT_NEAR((still - moving) / (kSpeed * 750e3 * 500e-6 / 60e3), 1.0, 0.03);
}

TEST_F(SonarMotion, ATurningSonarHearsLateEchoesOnTurnedBearings) {
  scene::Sonar sonar = sonar_of(20.0, 40.0, 100);
  sonar.azimuth_rad = radians(40.0);
  sonar.bins_azimuth = 400;
  sonar.terms.water.sound_speed_m_s = 1500.0;
  sonar.terms.motion = scene::SonarMotion{.within_ping = true};
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_sphere(0.5, 64), {0.0, 0.0, -30.0}));
  scene.sonars = {sonar};
  constexpr double kTurn = 1.0;  // rad/s to port
  scene.sonars[0].mount.track = scene::Track{
      {{0.0, Vec3(0.0)}},
      {{-1.0, glm::angleAxis(-kTurn, Vec3(0, 1, 0))}, {1.0, glm::angleAxis(kTurn, Vec3(0, 1, 0))}}};
  const SonarFrame frame = ping(device(), scene);
  double sum = 0.0, weighted = 0.0;
  for (std::uint32_t row = 0; row < 100; ++row)
    for (std::uint32_t c = 0; c < 400; ++c) {
      const double v = frame.image.intensity[row * 400 + c];
      sum += v;
      weighted += v * frame.grid.azimuth_rad(c);
    }
  // Turned to port by 2 r / c, it hears the target to starboard.
  EXPECT_NEAR(weighted / sum, kTurn * 2.0 * 29.5 / 1500.0, radians(0.1));
}

// The bearing at which a moving sonar hears a ball, against where the ball is seen from the place
// where the echo arrives: over bearings, speeds and directions, level.
TEST_F(SonarMotion, ASonarThatMovesAsideHearsOnTheBearingsOfWhereItArrives) {
  const auto heard_deg = [&](double bearing_rad, const Vec3& velocity_m_s) {
    scene::Sonar sonar = sonar_of(25.0, 35.0, 50);
    sonar.azimuth_rad = radians(100.0);
    sonar.elevation_rad = radians(4.0);
    sonar.bins_azimuth = 500;
    sonar.bins_elevation = 16;
    sonar.gbuffer_scale = 1.0;
    sonar.terms.water.sound_speed_m_s = 1500.0;
    sonar.terms.motion = scene::SonarMotion{.within_ping = true};
    scene::Scene scene;
    const Vec3 ball_m = 30.0 * Vec3(std::sin(bearing_rad), 0.0, -std::cos(bearing_rad));
    scene.objects.push_back(object_of(scene, scene::make_sphere(0.5, 48), ball_m));
    scene.sonars = {sonar};
    scene.sonars[0].mount.track =
        scene::Track{{{-1.0, -velocity_m_s}, {1.0, velocity_m_s}}, {{0.0, Quat(1, 0, 0, 0)}}};
    const SonarFrame frame = ping(device(), scene);
    double sum = 0.0, weighted = 0.0;
    for (std::size_t i = 0; i < frame.image.intensity.size(); ++i) {
      sum += frame.image.intensity[i];
      weighted += frame.image.intensity[i] *
                  frame.grid.azimuth_rad(static_cast<std::uint32_t>(i % frame.image.n_azimuth));
    }
    return degrees(weighted / sum);
  };
  for (const double bearing_deg : {-40.0, 25.0}) {
    const double still_deg = heard_deg(radians(bearing_deg), Vec3(0.0));
    EXPECT_NEAR(still_deg, bearing_deg, 0.02);
    for (const Vec3& v : {Vec3(5, 0, 0), Vec3(-3, 0, 8)}) {
      const double echo_s = 2.0 * 29.5 / 1500.0, b = radians(bearing_deg);
      const Vec3 seen = 29.5 * Vec3(std::sin(b), 0.0, -std::cos(b)) - v * echo_s;
      const double wanted_deg = degrees(std::atan2(seen.x, -seen.z)) - bearing_deg;
      EXPECT_NEAR(heard_deg(b, v) - still_deg, wanted_deg, 0.02)
          << bearing_deg << " at " << v.x << ", " << v.z << " m/s";
    }
  }
}

// A side-scan that looks 60 degrees down turns its bearings by half of what its vehicle yaws.
TEST_F(SonarMotion, ASideScanTurnsByItsShareOfAYaw) {
  const auto heard = [&](double depression_rad, double yaw_rate_rad_s) {
    scene::Sonar sonar = sonar_of(25.0, 35.0, 100);
    sonar.kind = scene::SonarKind::kSideScan;
    sonar.azimuth_rad = radians(2.0);
    sonar.elevation_rad = radians(20.0);
    sonar.depression_rad = depression_rad;
    sonar.bins_azimuth = 1;
    sonar.bins_elevation = 512;
    sonar.terms.beam.samples = 32;
    sonar.terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(1.0)};
    sonar.terms.water.sound_speed_m_s = 1500.0;
    sonar.terms.motion = scene::SonarMotion{.within_ping = true};
    scene::Scene scene;
    const Vec3 to_port(-std::cos(depression_rad), -std::sin(depression_rad), 0.0);
    scene.objects.push_back(object_of(scene, scene::make_sphere(0.1, 64), 30.0 * to_port));
    scene.sonars = {sonar};
    const auto yawed = [&](double time_s) {
      return glm::angleAxis(yaw_rate_rad_s * time_s, Vec3(0, 1, 0));
    };
    scene.sonars[0].mount.track =
        scene::Track{{{0.0, Vec3(0.0)}}, {{-1.0, yawed(-1.0)}, {1.0, yawed(1.0)}}};
    return total(ping(device(), scene));
  };
  const double echo_s = 2.0 * 30.0 / 1500.0;
  for (const double turned_deg : {0.3, 0.5}) {
    const double rate = radians(turned_deg) / echo_s;
    const double level = heard(0.0, rate) / heard(0.0, 0.0);
    EXPECT_LT(level, 0.9) << turned_deg;
    EXPECT_GT(level, 0.1) << turned_deg;
    EXPECT_NEAR(heard(radians(60.0), 2.0 * rate) / heard(radians(60.0), 0.0), level, 0.02)
        << turned_deg;
  }
}

TEST_F(SonarMotion, AScannerStepsRoundOrToAndFro) {
  scene::Sonar sonar;
  sonar.kind = scene::SonarKind::kMechanical;
  sonar.azimuth_rad = radians(360.0);
  sonar.step_rad = radians(90.0);
  const auto heading = [&](std::uint32_t ping) {
    return std::lround(degrees(sonar::scan_heading_rad(sonar, ping)));
  };
  EXPECT_EQ(heading(0), -135);
  EXPECT_EQ(heading(3), 135);
  EXPECT_EQ(heading(4), -135);
  sonar.azimuth_rad = radians(90.0);
  sonar.step_rad = radians(30.0);
  EXPECT_EQ(heading(0), -30);
  EXPECT_EQ(heading(2), 30);
  EXPECT_EQ(heading(3), 0);
  EXPECT_EQ(heading(4), -30);
}

TEST_F(SonarMotion, AScannersStepsLieInTheMiddleOfItsSector) {
  scene::Sonar sonar;
  sonar.kind = scene::SonarKind::kMechanical;
  for (const auto& [azimuth_deg, step_deg] :
       {std::pair(10.0, 4.0), std::pair(10.0, 10.0), std::pair(10.0, 3.0), std::pair(90.0, 0.7)}) {
    sonar.azimuth_rad = radians(azimuth_deg);
    sonar.step_rad = radians(step_deg);
    double lowest = kPi, highest = -kPi;
    for (std::uint32_t ping = 0; ping < 300; ++ping) {
      const double heading = sonar::scan_heading_rad(sonar, ping);
      lowest = std::min(lowest, heading);
      highest = std::max(highest, heading);
    }
    EXPECT_NEAR(lowest, -highest, 1e-12) << azimuth_deg << " by " << step_deg;
    // No half beam outside, no room for another step inside.
    const double covered = highest - lowest + sonar.step_rad;
    EXPECT_LE(covered, sonar.azimuth_rad + 1e-9) << azimuth_deg << " by " << step_deg;
    EXPECT_GT(covered, sonar.azimuth_rad - sonar.step_rad) << azimuth_deg << " by " << step_deg;
  }
}

TEST_F(SonarMotion, AScannersBeamHearsWhereItPoints) {
  scene::Sonar sonar = sonar_of(2.0, 8.0, 60);
  sonar.kind = scene::SonarKind::kMechanical;
  sonar.azimuth_rad = radians(360.0);
  sonar.step_rad = radians(10.0);
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_sphere(0.5, 64), {5.0, 0.0, 0.0}));
  scene.sonars = {sonar};
  for (std::uint32_t step = 0; step < 36; ++step) {
    const SonarFrame frame = ping(device(), scene, step);
    const double off = std::abs(degrees(frame.heading_rad) - 90.0);
    if (off < 5.1) {
      EXPECT_GT(total(frame), 0.0) << step;
    }
    if (off > 15.0) {
      EXPECT_EQ(total(frame), 0.0) << step;
    }
  }
}

}  // namespace
}  // namespace neritic::testbed
