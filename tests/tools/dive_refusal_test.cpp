// Vehicles and flags that `neritic dive` refuses, each in one line.
#include <algorithm>

#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

// The vehicle's file is refused before anything moves.
TEST_F(DivePhysics, AParameterFileThatIsNoVehicleEndsInOneLine) {
  const struct {
    const char *parameters, *message;
  } files[] = {
      {"mass_kg = -13.5\ninertia_kg_m2 = [0.3, 0.2, 0.4]\n", "mass_kg: found -13.5"},
      {"mass_kg = 13.5\ninertia_kg_m2 = [0.3, 0, 0.4]\n",
       "found a mass matrix that is not positive definite"},
      {"mass_kg = 13.5\ninertia_kg_m2 = [0.3, 0.2, 0.4]\nadded_mass = [[-13.5, 0, 0, 0, 0, 0], "
       "[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], "
       "[0, 0, 0, 0, 0, 0]]\n",
       "added_mass: found a sum with the rigid body's mass matrix that is not"},
      {"mass_kg = nan\ninertia_kg_m2 = [0.3, 0.2, 0.4]\n", "mass_kg: found \"nan\""}};
  for (const auto& file : files) {
    ASSERT_TRUE(write_text(scratch_ / "wrong.toml", file.parameters).ok());
    ASSERT_TRUE(write_text(scratch_ / "wrong_dive.toml",
                           "[physics]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\n"
                           "dynamics = \"wrong.toml\"\nposition_m = [0, -6, 0]\n")
                    .ok());
    const Outcome outcome = dive("--headless --seconds 1", "wrong_dive.toml");
    EXPECT_EQ(outcome.status, 2) << file.message;
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find("wrong.toml:"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(file.message), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

TEST_F(DivePhysics, FlagsThatDoNotFitEndInOneLine) {
  const struct {
    std::string arguments, scene, message;
  } cases[] = {
      {"--headless --log x.csv", "still.toml",
       "still.toml, where nothing moves by physics; accepted: a scene where a vehicle has "
       "dynamics"},
      {"--headless --log-rate 0", "still.toml", "--log-rate: found "},
      {"--headless --seconds 1 --record a.txt", "dive.toml",
       "--record: found 'a.txt'; accepted: an .mcap; of a dive also an .xdf"},
      {"--realtime", "dive.toml",
       "--realtime: found a run with pictures; accepted: with --headless and without flags"},
      {"--headless --replay none.mcap", "dive.toml", "none.mcap"},
      {"--headless --replay a.mcap --save x.state", "dive.toml",
       "--replay: found --save beside it; accepted: no --seconds, --record, --save, --play, "},
      {"--headless --replay a.mcap --seconds 10", "dive.toml",
       "--replay: found --seconds beside it; accepted: no --seconds"},
      {"--headless --seconds 1e7", "dive.toml", "--seconds: found 10000000; accepted: up to 1e+06"},
      {"--headless --play a.mcap --restore a.state", "dive.toml",
       "--play: found --restore beside it; accepted: a run from time 0"},
      {"--headless --log-rate -1", "dive.toml", "--log-rate: found -1; accepted: 0 to 10000"},
      // Flags that would be looked at by nobody.
      {"--headless --log-rate 7", "dive.toml", "--log-rate: found no --log beside it"},
      {"--headless --diver ada", "dive.toml", "--diver: found --headless without --hud"},
      {"--headless --units imperial", "dive.toml", "--units: found --headless without --hud"},
      {"--headless --hud wrist,wrist", "dive.toml",
       "--hud: found wrist twice in 'wrist,wrist'; accepted: each name once"},
      {"--headless --refresh 90", "dive.toml", "--refresh: found --headless beside it"},
      {"--headless --swim", "dive.toml", "--swim: found --headless beside it"},
      {"--headless --task look", "dive.toml", "--task: found --headless beside it"},
      {"--headless --bindings own.toml", "dive.toml", "--bindings: found --headless beside it"}};
  for (const auto& wrong : cases) {
    const Outcome outcome = dive(wrong.arguments, wrong.scene);
    EXPECT_EQ(outcome.status, 2) << wrong.message;
    EXPECT_NE(outcome.err.find(wrong.message), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

}  // namespace
}  // namespace neritic
