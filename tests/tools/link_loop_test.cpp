// Links that lead round in a loop, wherever a command takes a path: one line that names the path,
// no exception of a library.
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

class LinkLoop : public DivePhysics {
 protected:
  void SetUp() override {
    DivePhysics::SetUp();
    for (const char* suffix : {"", ".npy", ".png", ".toml", ".glb", ".csv", ".mcap", ".obj"}) {
      const auto link = scratch_ / (std::string("loop") + suffix);
      std::filesystem::create_symlink(link.filename(), link);
    }
  }
  // The command fails in one line with its name, and not by an exception.
  void expect_one_line(const std::string& arguments, const std::string& named) {
    const Outcome outcome = neritic(arguments);
    EXPECT_TRUE(outcome.status == 1 || outcome.status == 2) << arguments << " " << outcome.status;
    EXPECT_EQ(outcome.err.find("filesystem error"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(named), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
};

TEST_F(LinkLoop, ReadFilesAndFoldersAreNamedInOneLine) {
  expect_one_line("sonar imaging --depth " + file("loop.npy") +
                      " --intrinsics 100,100,50,50 --range 1,5 --out " + file("results"),
                  "loop.npy");
  expect_one_line("sonar imaging --depth " + file("loop") +
                      " --intrinsics 100,100,50,50 --range 1,5 --out " + file("results"),
                  "loop");
  expect_one_line("sonar imaging --depth " + file("loop/sub") +
                      " --intrinsics 100,100,50,50 --range 1,5 --out " + file("results"),
                  "loop");
  expect_one_line("dive --headless " + file("loop.toml"), "loop.toml");
  expect_one_line("dive --headless " + file("loop/scene.toml"), "loop/scene.toml");
  expect_one_line("render --out " + file("results") + " " + file("loop.glb"), "loop.glb");
  expect_one_line("physio breath " + file("loop.csv") + " --plot " + file("plot.png"), "loop.csv");
  expect_one_line("register " + file("loop.csv"), "loop.csv");
  expect_one_line("recording check " + file("loop.mcap"), "loop.mcap");
  expect_one_line("dive --headless --replay " + file("loop.mcap"), "loop.mcap");
  expect_one_line("serve " + file("dive.toml") + " --recordings " + file("loop"), "loop");
  expect_one_line("plan --log " + file("loop.csv") + " --out " + file("results"), "loop.csv");
}

TEST_F(LinkLoop, WrittenFilesAndFoldersAreNamedInOneLine) {
  expect_one_line("render --out " + file("loop") + " " + file("dive.toml"), "loop");
  expect_one_line("render --out " + file("loop/sub") + " " + file("dive.toml"), "loop");
  expect_one_line("dive --headless --seconds 1 --log " + file("loop.csv") + " " + file("dive.toml"),
                  "loop.csv");
  expect_one_line(
      "dive --headless --seconds 1 --record " + file("loop/dive.mcap") + " " + file("dive.toml"),
      "loop");
  expect_one_line("keys " + file("loop"), "loop");
  expect_one_line("keys " + file("loop/sub") + " --client one", "the folder cannot be made");
  std::filesystem::create_directory(scratch_ / "keys");
  std::filesystem::create_symlink("server.secret", scratch_ / "keys/server.secret");
  expect_one_line("keys " + file("keys") + " --client one", "server.secret: found ");
  expect_one_line("plan --depth 30 --time 20 --out " + file("loop/sub"), "--out: ");
}

TEST_F(LinkLoop, AScenesOwnFilesAreNamedWithTheirKey) {
  const auto scene = [&](const std::string& text) {
    EXPECT_TRUE(write_text(scratch_ / "scene.toml", "[physics]\n" + text).ok());
    return "dive --headless --seconds 1 " + file("scene.toml");
  };
  const std::string vehicle = "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = \"";
  expect_one_line(scene("[[objects]]\nmodel = \"loop.glb\"\n"), "model: ");
  expect_one_line(scene("[[objects]]\nshape = \"box\"\ncolor_texture = \"loop.png\"\n"),
                  "color_texture: ");
  expect_one_line(scene("[[objects]]\nclass = \"seabed\"\nterrain = \"loop.npy\"\ncell_m = 1\n"),
                  "terrain: ");
  expect_one_line(scene(vehicle + "loop.toml\"\n"), "dynamics: ");
  ASSERT_TRUE(write_text(scratch_ / "scene.toml", "include = \"loop.toml\"\n").ok());
  expect_one_line("dive --headless --seconds 1 " + file("scene.toml"), "include: ");
}

// A vehicle's table of thrusters that is not there, leads nowhere, or is none.
TEST_F(LinkLoop, AVehiclesThrusterTableIsNamedWithItsKeyAndWhatIsAccepted) {
  ASSERT_TRUE(write_text(scratch_ / "words.csv", "some words\n").ok());
  ASSERT_TRUE(write_text(scratch_ / "short.csv", "pwm_us,thrust_n_16v\n1100,-40\n").ok());
  ASSERT_TRUE(write_text(scratch_ / "row.csv", "pwm_us,thrust_n_16v\n1100,-40\n1200,x\n").ok());
  std::filesystem::create_symlink("nowhere.csv", scratch_ / "dangling.csv");
  ASSERT_TRUE(write_text(scratch_ / "scene.toml",
                         "[physics]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = "
                         "\"vehicle.toml\"\n")
                  .ok());
  for (const char* table :
       {"loop.csv", "dangling.csv", "none.csv", "words.csv", "short.csv", "row.csv", "loop"}) {
    ASSERT_TRUE(write_text(scratch_ / "vehicle.toml",
                           fmt::format("mass_kg = 10\ninertia_kg_m2 = [0.2, 0.2, 0.3]\n"
                                       "thrust_table = \"{}\"\n",
                                       table))
                    .ok());
    const std::string command = "dive --headless --seconds 1 " + file("scene.toml");
    expect_one_line(command, "vehicle.toml: thrust_table: ");
    const std::string line = neritic(command).err;
    EXPECT_NE(line.find(table), std::string::npos) << line;
    EXPECT_NE(line.find("; accepted: "), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace neritic
