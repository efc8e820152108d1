// `neritic render` as its users run it: exit statuses, one clear line for bad input, the file
// contract, and the same bytes whatever the number of the driver's threads.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "engine/gpu/device.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;
  std::string said;  // stderr
};

Outcome neritic(const std::string& arguments, const std::string& environment = "") {
  const test::ScratchFolder folder;
  const std::string command = environment + " " NERITIC_BINARY_DIR "/tools/neritic " + arguments +
                              " >/dev/null 2>" + (folder / "stderr").string();
  const int raw = std::system(command.c_str());
  return {WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw),
          read_text(folder / "stderr").value()};
}

std::string scene(const std::string& name) {
  return (test::source_dir() / "assets/scenes" / name).string();
}

TEST(RenderCommand, BadInputEndsInStatusTwoAndOneLineThatNamesIt) {
  const test::ScratchFolder folder;
  const std::string out = " --out " + (folder / "out").string();
  std::ofstream(folder / "garbage.toml") << "\x01\x02 not a [scene";
  std::ofstream(folder / "unknown.toml") << "[watr]\ntype = \"II\"\n";
  const auto with_sonar = [&](const std::string& name, const std::string& keys) {
    std::ofstream(folder / name) << "[[sonars]]\nname = \"ears\"\n" << keys;
    return "render " + (folder / name).string() + out;
  };
  const struct {
    std::string arguments, names;
  } cases[] = {
      // An error that only the sonar can find names file, sonar and key too.
      {with_sonar("pulse.toml", "bandwidth_hz = 10\n"), "pulse.toml: sonar ears: range_spread"},
      {with_sonar("gather.toml", "gather = \"published\"\nlevel = {}\n"),
       "gather.toml: sonar ears: gather: found published"},
      {with_sonar("quality.toml", "max_error = 1e-5\n"), "quality.toml: sonar ears: max_error"},
      {with_sonar("samples.toml", "bins = [10, 8192, 10]\nbeam = { samples = 64 }\n"),
       "samples.toml: sonar ears: with 64 samples a beam"},
      {"render nothere.toml" + out, "nothere.toml"},
      {"render " + (folder / "garbage.toml").string() + out, "garbage.toml"},
      {"render " + (folder / "unknown.toml").string() + out, "water"},  // the nearest known key
      {"render " + scene("pool.toml") + out + " --size 0x0", "0x0"},
      {"render " + scene("pool.toml") + out + " --size 99999x1", "99999x1"},
      {"render " + scene("pool.toml") + out + " --time inf", "--time"},
      {"render " + scene("pool.toml") + out + " --offset nan 0 0", "--offset"},
      {"render " + scene("pool.toml") + out + " --offset 0 -4.1e7 0", "4e+07"},
      {"render 'not\nthere.toml'" + out, "not\\nthere.toml"},
      {"render " + scene("pool.toml") + out + " --sensor nobody",
       "--sensor: found 'nobody'; accepted: camera, sonar"},
      {"render " + scene("pool.toml") + out + " --sensor camera --sensor nobody", "found 'nobody'"},
      {"render " + scene("pool.toml") + out + " --water 4X", "4X"},
      {"render " + scene("../models/shark.glb") + out + " --clip glide",
       "--clip: found \"glide\"; accepted: a clip of the model, by name or number: 0 swim"},
      {"render " + scene("pool.toml") + out + " --clip swim", "--clip: found a scene"},
      {"render " + scene("pool.toml") + out + " --colour red", "neritic render --help"},
      {"render " + scene("pool.toml") + out + " --frames abc",
       "--frames: found 'abc'; accepted: 1 to 1000000"},
      {"render " + scene("pool.toml") + out + " --chart-cell 2000",
       "--chart-cell: found '2000'; accepted: 0.001 to 1000"},
      // Not the seeds 2^64 - 4 and 2^64 - 1.
      {"render " + scene("pool.toml") + out + " --seed -4",
       "--seed: found '-4'; accepted: a whole number"},
      {"render " + scene("pool.toml") + out + " --seed 99999999999999999999", "--seed: found '9"},
      {"dive " + scene("mission.toml") + " --headless --seed -4",
       "--seed: found '-4'; accepted: a whole number"},
      {"render " + scene("mission.toml") + out + " --runs 2 --log log.csv",
       "--runs: found a flag of one run"},
      {"render " + scene("pool.toml") + out + " --chart-cell 1",
       "--chart-cell: found no profiling"},
      {"render " + scene("../models/shark.glb") + out + " --quality draft",
       "--quality: found no sonar"},
      {"render " + scene("mission.toml") + out + " --log-rate 5", "--log-rate: found no --log"},
      {"rendre " + scene("pool.toml"), "rendre"},
      {"render", "--out: found nothing; accepted: "},
      {"render" + out, "SCENE: found none"}};
  for (const auto& c : cases) {
    const Outcome outcome = neritic(c.arguments);
    EXPECT_EQ(outcome.status, 2) << c.arguments << "\n" << outcome.said;
    EXPECT_EQ(std::count(outcome.said.begin(), outcome.said.end(), '\n'), 1) << c.arguments << "\n"
                                                                             << outcome.said;
    EXPECT_NE(outcome.said.find(c.names), std::string::npos) << c.arguments << "\n" << outcome.said;
    EXPECT_FALSE(fs::exists(folder / "out")) << c.arguments;
  }
}

TEST(RenderCommand, RunsHaveSeedsAndFoldersOfTheirOwnAndEndInATable) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  const test::ScratchFolder folder;
  std::ofstream(folder / "scene.toml")
      << "[physics]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\nsize_m = [0.4, 0.3, "
         "0.5]\nposition_m = [0, -5, 0]\ndynamics = \"" +
             (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string() +
             "\"\n[vehicles.mission]\nwaypoints = [{ position_m = [0.5, -5, 0] }]\n"
             "[[cameras]]\nname = \"eye\"\nwidth = 16\nheight = 16\n";
  const std::string command =
      NERITIC_BINARY_DIR "/tools/neritic render " + (folder / "scene.toml").string() +
      " --only trajectory --time 1 --seed 7 --runs 2 --out " + (folder / "out").string() + " >" +
      (folder / "table").string() + " 2>" + (folder / "stderr").string();
  EXPECT_EQ(std::system(command.c_str()), 0) << read_text(folder / "stderr").value();
  for (const char* run : {"run_0000", "run_0001"})
    EXPECT_TRUE(fs::exists(folder / "out" / run / "trajectory.csv")) << run;
  const std::string table = read_text(folder / "table").value();
  EXPECT_NE(table.find("         7  rov"), std::string::npos) << table;
  EXPECT_NE(table.find("         8  rov"), std::string::npos) << table;
  EXPECT_NE(table.find("of 2 missions done"), std::string::npos) << table;
}

TEST(RenderCommand, WhatCannotBePrintedIsAFailure) {
  for (const char* arguments : {"--version", "render --help"}) {
    const std::string command =
        std::string(NERITIC_BINARY_DIR "/tools/neritic ") + arguments + " >/dev/full 2>&1";
    const int raw = std::system(command.c_str());
    ASSERT_TRUE(WIFEXITED(raw));
    EXPECT_EQ(WEXITSTATUS(raw), 1) << arguments;
  }
}

TEST(RenderCommand, WithoutADeviceOneLineNamesThePackage) {
  const test::ScratchFolder folder;
  const Outcome outcome =
      neritic("render " + scene("pool.toml") + " --out " + (folder / "out").string(),
              "VK_ICD_FILENAMES=/nonexistent.json VK_DRIVER_FILES=/nonexistent.json");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.said.find("mesa-vulkan-drivers"), std::string::npos) << outcome.said;
  EXPECT_NE(outcome.said.find("VK_DRIVER_FILES is '/nonexistent.json'"), std::string::npos)
      << outcome.said;
  EXPECT_EQ(std::count(outcome.said.begin(), outcome.said.end(), '\n'), 1);
}

TEST(RenderCommand, OneAndTwoThreadsOfTheDriverWriteTheSameBytes) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  const test::ScratchFolder folder;
  for (const char* threads : {"1", "2"}) {
    const Outcome outcome = neritic(
        "render " + scene("wreck.toml") + " --size 320x180 --out " + (folder / threads).string(),
        std::string("LP_NUM_THREADS=") + threads);
    ASSERT_EQ(outcome.status, 0) << outcome.said;
  }
  int compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "1")) {
    const std::string extension = entry.path().extension();
    if (extension != ".npy" && extension != ".png") continue;
    const fs::path other = folder / "2" / fs::relative(entry.path(), folder / "1").string();
    EXPECT_EQ(read_file(entry.path()).value(), read_file(other).value()) << entry.path();
    ++compared;
  }
  EXPECT_GE(compared, 15);
}

TEST(RenderCommand, WritesTheFileContractAndTheArraysAgreeWithEachOther) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  const test::ScratchFolder folder;
  const Outcome outcome = neritic("render " + scene("pool.toml") +
                                  " --size 101x57 --frames 2 --out " + (folder / "out").string());
  ASSERT_EQ(outcome.status, 0) << outcome.said;
  for (const char* frame : {"frame_0000", "frame_0001"}) {
    const fs::path camera = folder / "out" / frame / "camera",
                   sonar = folder / "out" / frame / "sonar";
    const auto depth = read_npy(camera / "depth.npy"), normals = read_npy(camera / "normals.npy");
    const auto labels = read_npy(camera / "labels.npy"),
               instances = read_npy(camera / "instances.npy");
    const auto motion = read_npy(camera / "motion.npy");
    ASSERT_TRUE(depth.ok() && normals.ok() && labels.ok() && instances.ok() && motion.ok());
    EXPECT_EQ(depth->shape, (std::vector<std::size_t>{57, 101}));
    EXPECT_EQ(normals->shape, (std::vector<std::size_t>{57, 101, 3}));
    EXPECT_EQ(motion->shape, (std::vector<std::size_t>{57, 101, 2}));
    EXPECT_EQ(depth->type, NpyType::kFloat32);
    EXPECT_EQ(labels->type, NpyType::kUint16);
    const auto d = depth->to_doubles(), n = normals->to_doubles(), l = labels->to_doubles();
    for (std::size_t i = 0; i < d.size(); ++i) {
      const double size = std::hypot(n[3 * i], n[3 * i + 1], n[3 * i + 2]);
      EXPECT_NEAR(size, std::isfinite(d[i]) ? 1.0 : 0.0, 1e-3);
      EXPECT_EQ(std::isfinite(d[i]), l[i] > 0.0);
    }
    const auto color = scene::read_image8(camera / "color.png");
    ASSERT_TRUE(color.ok());
    EXPECT_EQ(color->width, 101u);
    const auto image = read_npy(sonar / "sonar.npy"),
               classes = read_npy(sonar / "sonar_labels.npy");
    ASSERT_TRUE(image.ok() && classes.ok());
    EXPECT_EQ(image->shape, (std::vector<std::size_t>{500, 500}));
    EXPECT_EQ(classes->shape, image->shape);
    for (const fs::path& facts : {camera / "meta.json", sonar / "meta.json"}) {
      const auto meta = parse_json(read_text(facts).value()).value();
      for (const char* key : {"fx", "fy", "cx", "cy", "pose", "frames", "near", "time", "seed",
                              "scene", "device", "passes_ms"})
        EXPECT_TRUE(meta.contains(key)) << facts << " " << key;
    }
    const auto json = parse_json(read_text(sonar / "sonar.json").value()).value();
    for (const char* key : {"limits", "bins", "units", "model", "seed", "timings_ms"})
      EXPECT_TRUE(json.contains(key)) << key;
    EXPECT_TRUE(fs::exists(sonar / "sonar.png"));
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out"))
    EXPECT_NE(entry.path().extension(), ".tmp");
}

}  // namespace
}  // namespace neritic
