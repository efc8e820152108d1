// The lines before a dive about thrusters that push axes only together, and whether the dive then
// goes as they say. The oracle of forces is closed: horizontal thrusters stand at 45 degrees.
#include "testbed/simulation/thrust_outlook.hpp"

#include <cmath>

#include "testbed/simulation/mission_outlook.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

constexpr double kForwards_n = 51.436, kBackwards_n = 39.908;  // of one thruster

std::string mission_of(const std::string& failed, const std::string& mission_keys = "") {
  return std::string(kStillWater) +
         rov_text("position_m = [0, -10, 0]\nfailed_thrusters = " + failed +
                  "\n[vehicles.mission]\nspeed_m_s = 0.4\n" + mission_keys +
                  "waypoints = [ { position_m = [0, -10, -5] }, { position_m = [5, -10, -5] } ]\n");
}

std::string lines_of(const std::string& text) {
  std::string out;
  for (const std::string& line : cannot_hold(*dive_of(text).world)) out += line + "\n";
  return out;
}

std::uint64_t arrived(const std::string& text, double seconds) {
  TestDive dive = dive_of(text);
  dive.run(seconds);
  return dive.vehicle().mission.arrived;
}

TEST(ThrustOutlook, OneHorizontalThrusterIsToldToPushThreeAxesOnlyTogether) {
  for (const char* failed : {"[1, 2, 3]", "[2, 3, 4]", "[1, 3, 4]"}) {
    const std::string lines = lines_of(mission_of(failed));
    EXPECT_NE(lines.find("rov: its thrusters push forward or back (surge), to the side (sway) and "
                         "round (yaw) only together, not each by itself: 1 of these 3 can be "
                         "chosen, and the others follow; it may not hold its way or its heading\n"),
              std::string::npos)
        << lines;
    EXPECT_NE(lines.find("push with 0 N with the other axes at rest: it may not arrive"),
              std::string::npos)
        << lines;
    EXPECT_EQ(lines.find("it is slower there"), std::string::npos) << lines;
    EXPECT_EQ(lines.find("heave"), std::string::npos) << lines;
  }
  EXPECT_LT(arrived(mission_of("[1, 2, 3]"), 60.0), 2u);
}

// Those on a diagonal push along it and turn; front ones or rear ones push ahead, and to the side
// only with a turn.
TEST(ThrustOutlook, TwoHorizontalThrustersAreToldByWhatTheyCannot) {
  EXPECT_NE(lines_of(mission_of("[1, 4]"))
                .find("rov: its thrusters push forward or back (surge) and to the side (sway) only "
                      "together, not each by itself: 1 of these 2 can be chosen"),
            std::string::npos)
      << lines_of(mission_of("[1, 4]"));
  for (const char* failed : {"[1, 2]", "[3, 4]"}) {
    const std::string lines = lines_of(mission_of(failed));
    EXPECT_NE(lines.find("rov: its thrusters push to the side (sway) and round (yaw) only "
                         "together, not each by itself: 1 of these 2 can be chosen"),
              std::string::npos)
        << lines;
    EXPECT_EQ(lines.find("surge"), std::string::npos) << lines;
  }
}

TEST(ThrustOutlook, AnyOneThrusterMayFailWithoutALine) {
  for (int i = 1; i <= 8; ++i) {
    const std::string text = mission_of(fmt::format("[{}]", i));
    EXPECT_EQ(lines_of(text), "") << i;
    if (i == 1 || i == 6) {
      EXPECT_EQ(arrived(text, 60.0), 2u) << i;
    }
  }
}

TEST(ThrustOutlook, APushIsWhatTheAxisHoldsWithTheOthersAtRest) {
  const auto push = [](const std::string& failed, std::size_t axis, double sign) {
    const TestDive dive = dive_of(mission_of(failed));
    return most_along(dive.world->vehicles()[0], axis_of(axis, sign));
  };
  const double two = std::sqrt(2.0);  // two thrusters, each at 45 degrees
  EXPECT_NEAR(push("[3, 4]", 0, 1.0), two * kForwards_n, 0.01);
  EXPECT_NEAR(push("[3, 4]", 0, -1.0), two * kBackwards_n, 0.01);
  EXPECT_NEAR(push("[1, 2]", 0, 1.0), two * kBackwards_n, 0.01);
  EXPECT_NEAR(push("[1, 2]", 2, -1.0), 4.0 * kForwards_n, 0.01);
  EXPECT_EQ(push("[1, 2]", 1, 1.0), 0.0);
  EXPECT_EQ(push("[1, 2, 3]", 0, 1.0), 0.0);
  EXPECT_EQ(push("[1, 2, 3]", 5, 1.0), 0.0);
  // Along the diagonal the other pair pushes as far as its weaker direction allows.
  const TestDive dive = dive_of(mission_of("[1, 4]"));
  const PhysicsVehicle& vehicle = dive.world->vehicles()[0];
  EXPECT_NEAR(most_along(vehicle, rov::vec6(Vec3(1.0, 1.0, 0.0) / two, Vec3(0.0))),
              2.0 * kBackwards_n, 0.01);
  EXPECT_EQ(most_along(vehicle, rov::vec6(Vec3(1.0, -1.0, 0.0) / two, Vec3(0.0))), 0.0);
}

// The horizontal thrusters sit 8.5 cm below the origin, the centres 1 cm apart: W x 1 cm.
TEST(ThrustOutlook, ASurgeThatPitchesIsToldByTheForceThatOverturns) {
  const std::string lines = lines_of(mission_of("[5, 6, 7, 8]"));
  EXPECT_NE(lines.find("push 0 N up or down (heave): that axis is not controlled"),
            std::string::npos)
      << lines;
  EXPECT_NE(lines.find("rov: its thrusters push forward or back (surge) only together with nose up "
                       "or down (pitch): above 15."),
            std::string::npos)
      << lines;
}

// A current that the diagonal holds at one heading: none of those that are multiples of 5 degrees.
TEST(ThrustOutlook, ADiagonalThatHoldsACurrentAtOneHeadingIsFound) {
  const std::string still = "mission = { hold = \"station\" }\n";
  const auto text = [&](double speed_m_s) {
    return fmt::format("[physics]\n[current]\nkind = \"uniform\"\nvelocity_m_s = [{}, 0, {}]\n",
                       speed_m_s * 0.31, speed_m_s * 0.95) +
           rov_text("position_m = [0, -10, 0]\nfailed_thrusters = [1, 4]\n" + still);
  };
  // The station's own heading is not that one.
  const std::string slow = lines_of(text(0.2)), fast = lines_of(text(3.0));
  EXPECT_EQ(slow.find(" against it: it drifts away"), std::string::npos) << slow;
  EXPECT_NE(slow.find("with 0 N against it at the heading there: it drifts away"),
            std::string::npos)
      << slow;
  EXPECT_NE(fast.find(" against it: it drifts away"), std::string::npos) << fast;
}

}  // namespace
}  // namespace neritic::testbed
