// Vehicles that touch the bottom while they fly on what they measure.
#include "tests/rov/navigation_runs.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

// The survey vehicle flies for 20 s, sets down on a flat floor under its second waypoint, and
// pushes on towards that; keys of its dynamics file follow.
TestDive setting_down(std::uint64_t seed, double speed_m_s, const std::string& dynamics_keys = {}) {
  const test::ScratchFolder folder;
  const std::string vehicles = vehicles_folder();
  EXPECT_TRUE(write_text(folder / "survey.toml", "include = \"" + vehicles +
                                                     "/bluerov2_heavy_survey_dynamics.toml\"\n" +
                                                     dynamics_keys)
                  .ok());
  EXPECT_TRUE(write_text(folder / "dive.toml", "seed = " + std::to_string(seed) + R"(
[physics]
[[objects]]
name = "floor"
shape = "plane"
size_m = [400, 400]
position_m = [0, -16.2, 0]
class = "seabed"
[[vehicles]]
name = "rov"
include = ")" + vehicles + R"(/rov.toml"
dynamics = ")" + (folder / "survey.toml").string() +
                                                   R"("
position_m = [0, -15, )" + std::to_string(20.0 * speed_m_s - 10.0) +
                                                   R"(]
[vehicles.mission]
speed_m_s = )" + std::to_string(speed_m_s) + R"(
waypoints = [{position_m = [0, -15, -10]}, {position_m = [0, -18, -10]}]
)")
                  .ok());
  auto scene = scene::load_scene(folder / "dive.toml");
  EXPECT_TRUE(scene.ok()) << scene.error().message;
  return dive_of(std::move(scene).value());
}

// The largest errors of a dive's navigation, in metres, in m/s and in its own standard deviations.
struct Off {
  double most_m = 0.0, most_m_s = 0.0;
  double most_square = 0.0;  // errors over their covariance, in position and velocity
  double mean_square = 0.0;  // of the position, from the first contact on
  std::uint64_t touched_steps = 0;
};

Off off_after(TestDive dive, double seconds) {
  Off out;
  std::uint64_t steps = 0;
  dive.run(seconds, [&] {
    const rov::NavigationState& state = dive.state().navigation()[0];
    const rov::State& body = dive.vehicle().body;
    // Between two inertial readings a hit is not known yet.
    if (state.imu_s != dive.time_s()) return;
    const auto estimate = dive.world->estimate(dive.state(), 0);
    // The unit lies at the body's origin.
    const Vec3 off_m = body.position_ned_m - estimate->position_ned_m;
    const Vec3 off_m_s = body.attitude * body.velocity.linear() - estimate->velocity_ned_m_s;
    const double square = rov::normalized_square(state, rov::kPositionError, off_m);
    out.most_m = std::max(out.most_m, glm::length(off_m));
    out.most_square = std::max(
        {out.most_square, square, rov::normalized_square(state, rov::kVelocityError, off_m_s)});
    if (dive.vehicle().contact.touched_steps == 0) return;
    out.most_m_s = std::max(out.most_m_s, glm::length(off_m_s));
    out.mean_square += square;
    ++steps;
  });
  out.mean_square /= static_cast<double>(steps);
  out.touched_steps = dive.vehicle().contact.touched_steps;
  return out;
}

// A fix is 0.2 to 0.4 m off here: the navigation is hardly more, at any rate of the inertial unit,
// and it knows it.
TEST(NavigationContact, WhereItSetsDownItKnowsWhereItIs) {
  for (const double speed_m_s : {0.15, 0.5}) {
    double sum = 0.0;
    for (std::uint64_t seed = 11; seed <= 16; ++seed) {
      SCOPED_TRACE(seed);
      SCOPED_TRACE(speed_m_s);
      const Off off = off_after(setting_down(seed, speed_m_s), 50.0);
      EXPECT_GT(off.touched_steps, 1000u);
      EXPECT_LT(off.most_m, 0.8);
      EXPECT_LT(off.most_m_s, 0.25);
      EXPECT_LT(off.most_square, 36.0);
      sum += off.mean_square;
    }
    EXPECT_LT(sum / 6.0, 7.8);  // 3 on average; of one whole run 95 % lie below this
  }
}

TEST(NavigationContact, SoItDoesAtOtherRatesOfItsInertialUnit) {
  for (const int rate_hz : {60, 120, 240})
    for (std::uint64_t seed = 11; seed <= 12; ++seed) {
      SCOPED_TRACE(seed);
      SCOPED_TRACE(rate_hz);
      const Off off = off_after(
          setting_down(seed, 0.5, "[imu]\nrate_hz = " + std::to_string(rate_hz) + "\n"), 50.0);
      EXPECT_GT(off.touched_steps, 1000u);
      EXPECT_LT(off.most_m, 0.8);
      EXPECT_LT(off.most_square, 36.0);
    }
}

}  // namespace
}  // namespace neritic::testbed
