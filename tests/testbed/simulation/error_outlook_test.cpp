// A dive tells in one line what max_error_m does not promise.
#include "testbed/simulation/error_outlook.hpp"

#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

std::string not_promised_of(const std::string& scene_text) {
  const TestDive dive = dive_of(scene_text);
  return not_promised(dive.scene, *dive.world);
}

TEST(ErrorOutlook, NamesWhatAnAcceptedErrorDoesNotHold) {
  const auto scene = [](const char* asked, const std::string& more) {
    return fmt::format("[physics]\n{}", asked) + more;
  };
  const std::string way = rov_text(
      "position_m = [0, -10, 0]\nmission = { waypoints = [ { position_m = [0, -10, -4] }, "
      "{ position_m = [2, -10, -4] } ] }\n");
  const std::string wall =
      "[[objects]]\nclass = 'structure'\nshape = 'box'\nposition_m = [0, -5, -9]\n";
  EXPECT_EQ(not_promised_of(scene("", way)), "");  // nothing was asked
  const std::string station =
      rov_text("position_m = [0, -10, 0]\nmission = { hold = \"station\" }\n");
  EXPECT_EQ(not_promised_of(scene("max_error_m = 1e-3\n", station)), "");
  EXPECT_NE(
      not_promised_of(scene("max_error_m = 1e-3\n", way))
          .find("not for a waypoint that is left a control period sooner or later, up to 0.02 m"),
      std::string::npos);
  EXPECT_EQ(not_promised_of(scene("max_error_m = 1e-6\n", rov_text("position_m = [0, -10, 0]\n"))),
            "");  // nobody steers it
  const std::string less = not_promised_of(scene("max_error_m = 1e-5\n", way));
  EXPECT_NE(
      less.find("dive.toml: physics.max_error_m: 1e-05 m holds for the integration, not for a "
                "thruster's pulse that is rounded to the other microsecond, up to "
                "0.0005 m"),
      std::string::npos)
      << less;
  EXPECT_EQ(less.find("contacts"), std::string::npos) << less;
  EXPECT_NE(not_promised_of(scene("max_error_m = 1e-3\n", way + wall))
                .find("contacts under control, up to 0.005 m"),
            std::string::npos);
  const std::string two =
      way + rov_text("position_m = [4, -10, 0]\n", "other", "bluerov2_heavy_dynamics.toml");
  EXPECT_NE(not_promised_of(scene("max_error_m = 1e-3\n", two)).find("participants meet"),
            std::string::npos);
  const std::string survey =
      rov_text("position_m = [0, -10, 0]\nmission = { hold = \"station\" }\n", "rov",
               "bluerov2_heavy_survey_dynamics.toml");
  EXPECT_NE(not_promised_of(scene("max_error_m = 1e-3\n", survey)).find("what it measures"),
            std::string::npos);
}

}  // namespace
}  // namespace neritic::testbed
