// `neritic render` makes the data set that a user asks for: chosen data alone, compressed, with
// boxes of cameras and trajectories of all that moves. numpy judges the files.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

// A bottom, two balls of one class and a box that swims round with a camera; a stereo camera and a
// sonar that stand still.
constexpr const char* kScene = R"(
[sun]
[[objects]]
name = "bottom"
shape = "plane"
size_m = [40, 40]
class = "seabed"
position_m = [0, -12, 0]
[[objects]]
name = "balls"
shape = "sphere"
radius_m = 0.4
class = "target"
copies = [[-0.8, -11, -4], [0.9, -10.6, -5]]
[[vehicles]]
name = "sub"
shape = "box"
size_m = [0.5, 0.3, 0.4]
[vehicles.track]
file = "track.csv"
[[vehicles.cameras]]
name = "lens"
width = 24
height = 16
position_m = [0, 0, -0.5]
[[cameras]]
name = "eyes"
width = 96
height = 64
position_m = [0, -10, 0]
pitch_deg = -10
stereo_baseline_m = 0.1
[[sonars]]
name = "ears"
position_m = [0, -10, 0]
pitch_deg = -10
bins = [64, 32, 32]
range_m = [1, 10]
)";

class RenderData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
    ASSERT_TRUE(write_text(folder_ / "scene.toml", kScene).ok());
    ASSERT_TRUE(write_text(folder_ / "track.csv",
                           "t_s,x,y,z,yaw_deg,pitch_deg,roll_deg\n0,-1,-10,-6,0,0,0\n"
                           "1,1,-10,-6.5,40,0,0\n")
                    .ok());
  }
  Status render(const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", (folder_ / "scene.toml").string(), "--out",
                                   (folder_ / out).string()};
    words.insert(words.end(), more.begin(), more.end());
    NERITIC_TRY(const auto line, tools::parse_command_line(words));
    const auto done = line.run();
    return done.ok() ? Status() : Status(done.error());
  }
  // Every file of a sensor's folder, and the same as in the other run where it is one of theirs.
  std::set<std::string> same_files(const std::string& sensor, const std::string& out) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / out / sensor)) {
      const std::string name = entry.path().filename();
      names.insert(name);
      if (name.ends_with(".json")) continue;
      EXPECT_EQ(read_file(entry.path()).value(), read_file(folder_ / "all" / sensor / name).value())
          << entry.path();
    }
    return names;
  }
  test::ScratchFolder folder_;
};

using NameSet = std::set<std::string>;

TEST_F(RenderData, WhatIsNotChosenIsNeitherWrittenNorDeclaredAndTheRestIsTheSame) {
  NERITIC_ASSERT_STATUS(render("all", {}));
  const std::string left = "frame_0000/eyes_left", ears = "frame_0000/ears";
  NERITIC_ASSERT_STATUS(render("some", {"--only", "depth,labels", "--only", "motion",
                                        "--dump-graph", (folder_ / "graph").string()}));
  EXPECT_EQ(same_files(left, "some"),
            (NameSet{"depth.npy", "labels.npy", "motion.npy", "meta.json"}));
  EXPECT_EQ(same_files(ears, "some"), (NameSet{"depth.npy", "labels.npy", "meta.json"}));
  for (const char* name : {"coco.json", "trajectory.csv", "track"})
    EXPECT_FALSE(fs::exists(folder_ / "some" / name)) << name;
  const std::string graph = read_text(folder_ / "graph").value();
  EXPECT_NE(graph.find("eyes depth"), std::string::npos) << graph;
  for (const char* absent :
       {"albedo", "material", "eyes color", "shade", "normal", "gather", "intensity", "emission"})
    EXPECT_EQ(graph.find(absent), std::string::npos) << absent << "\n" << graph;
  // Echoes, and normals without their depth.
  NERITIC_ASSERT_STATUS(render("heard", {"--only", "sonar,normals,instances"}));
  EXPECT_EQ(same_files(ears, "heard"),
            (NameSet{"normals.npy", "instances.npy", "meta.json", "sonar.npy", "sonar.json",
                     "sonar.png", "sonar_labels.npy"}));
  EXPECT_EQ(same_files(left, "heard"), (NameSet{"normals.npy", "instances.npy", "meta.json"}));
}

TEST_F(RenderData, BoxesAndTrajectoriesAreWhatNumpyFindsInTheArrays) {
  NERITIC_ASSERT_STATUS(
      render("out", {"--only", "color,trajectory", "--frames", "3", "--time", "0.3"}));
  // The moving camera sees other things than the check counts.
  NERITIC_ASSERT_STATUS(render("eyes", {"--only", "color,labels,instances,coco", "--frames", "3",
                                        "--time", "0.3", "--sensor", "eyes"}));
  const std::string check = (test::source_dir() / "tests/tools/render_data_check.py").string();
  const auto judged = [&](const char* out, const char* what) {
    return std::system(
        fmt::format("/usr/bin/python3 -B '{}' '{}' {}", check, (folder_ / out).string(), what)
            .c_str());
  };
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
    GTEST_SKIP() << "no numpy";
  EXPECT_EQ(judged("out", "trajectory"), 0);
  EXPECT_EQ(judged("eyes", "coco"), 0);
  NERITIC_ASSERT_STATUS(render("where", {"--only", "trajectory", "--frames", "2"}));
  EXPECT_FALSE(fs::exists(folder_ / "where/frame_0000"));
  EXPECT_TRUE(fs::exists(folder_ / "where/trajectory/sub.txt"));
}

TEST_F(RenderData, CompressedDataAreTheSameNumbersInSmallerFiles) {
  const std::vector<std::string> still{"--only", "depth,normals,labels,instances,sonar"};
  auto with = [&](const char* form) {
    auto words = still;
    if (*form != 0) words.insert(words.end(), {"--compress", form});
    return words;
  };
  NERITIC_ASSERT_STATUS(render("plain", with("")));
  NERITIC_ASSERT_STATUS(render("npz", with("npz")));
  const fs::path eye = "frame_0000/eyes_left";
  for (const char* name : {"depth", "labels", "instances"}) {
    const std::string file = name;
    EXPECT_FALSE(fs::exists(folder_ / "npz" / eye / (file + ".npy")));
    EXPECT_LT(fs::file_size(folder_ / "npz" / eye / (file + ".npz")),
              fs::file_size(folder_ / "plain" / eye / (file + ".npy")));
  }
  EXPECT_TRUE(fs::exists(folder_ / "npz/frame_0000/ears/sonar.npz"));
  // A run of another form leaves nothing that could be taken for its own.
  NERITIC_ASSERT_STATUS(render("npz", with("png")));
  fs::rename(folder_ / "npz", folder_ / "png");
  EXPECT_FALSE(fs::exists(folder_ / "png" / eye / "depth.npz"));
  EXPECT_TRUE(fs::exists(folder_ / "png/frame_0000/ears/sonar.npz"));
  const auto depth = read_npy(folder_ / "plain" / eye / "depth.npy")->to_doubles();
  const auto labels = read_npy(folder_ / "plain" / eye / "labels.npy")->to_doubles();
  NERITIC_ASSERT_OK(const ImageU16 units, scene::read_image16(folder_ / "png" / eye / "depth.png"));
  NERITIC_ASSERT_OK(const ImageU16 classes,
                    scene::read_image16(folder_ / "png" / eye / "labels.png"));
  const auto meta = parse_json(read_text(folder_ / "png" / eye / "meta.json").value()).value();
  const double unit_m = meta["depth_png"]["metres_per_unit"];
  const auto normals = read_npy(folder_ / "plain" / eye / "normals.npy")->to_doubles();
  NERITIC_ASSERT_OK(const ImageU16 colors,
                    scene::read_image16(folder_ / "png" / eye / "normals.png"));
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (std::isfinite(depth[i / 3])) {
      EXPECT_NEAR(2.0 * colors.data[i] / 65535.0 - 1.0, normals[i], 1.6e-5) << i;
    } else {
      EXPECT_EQ(colors.data[i], 0) << i;
    }
  std::size_t hits = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    EXPECT_EQ(classes.data[i], labels[i]);
    if (!std::isfinite(depth[i])) {
      EXPECT_EQ(units.data[i], 0);
    } else {
      ++hits;
      EXPECT_NEAR(units.data[i] * unit_m, depth[i], 0.5001 * unit_m);
    }
  }
  EXPECT_GT(hits, 100u);
}

TEST_F(RenderData, ANameThatIsNoneOrThatNothingGivesIsRefusedWithTheNames) {
  const auto said = [&](const std::vector<std::string>& words) {
    const auto result = render("out", words);
    return result.ok() ? std::string() : result.error().message;
  };
  EXPECT_EQ(said({"--only", "color,deph"}),
            "--only: found 'deph'; accepted: one or more of color, depth, normals, labels, "
            "instances, motion, sonar, coco, trajectory, linear, raw, boxes, kitti, panoptic");
  EXPECT_EQ(
      said({"--only", "color", "--sensor", "ears"}),
      "--only: found color, and no camera to give it; accepted: a scene and a --sensor with a "
      "camera, or data of sonars");
  EXPECT_EQ(said({"--only", "sonar", "--sensor", "eyes"}),
            "--only: found sonar, and no sonar to give it; accepted: a scene and a --sensor with a "
            "sonar, or data of cameras");
  EXPECT_EQ(said({"--only", "color,raw"}),
            "--only: found 'raw'; accepted: that with a camera of sensor = { bayer = \"rggb\" }");
  EXPECT_EQ(said({"--only", "linear"}),
            "--only: found 'linear'; accepted: that with a camera of linear = true");
  EXPECT_NE(said({"--only", "depth", "--track-only"}).find("sonar, trajectory"), std::string::npos);
  EXPECT_NE(said({"--only", "trajectory", "--sheet"}).find("--sheet"), std::string::npos);
  ASSERT_TRUE(write_text(folder_ / "scene.toml",
                         std::string(kScene) + "[[cameras]]\nname = \"bent\"\nwidth = 16\n"
                                               "height = 16\nlens = { model = \"fisheye\" }\n")
                  .ok());
  EXPECT_EQ(said({"--only", "kitti", "--sensor", "eyes", "--sensor", "bent"}),
            "--only: found kitti of 'bent', which has a lens or a port; accepted: cameras without "
            "(--sensor), since KITTI's P2 has no place for one");
  const auto help = tools::parse_command_line({"render", "--help"});
  EXPECT_NE(help->help.find("instances, motion, sonar, coco, trajectory"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(RenderData, APortsBendingIsNotToldAsALensThatBendsNothing) {
  const auto meta_of = [&](const std::string& keys) {
    EXPECT_TRUE(write_text(folder_ / "scene.toml", std::string(kScene) +
                                                       "[[cameras]]\nname = \"bent\"\nwidth = "
                                                       "16\nheight = 16\n" +
                                                       keys)
                    .ok());
    EXPECT_TRUE(render("out", {"--only", "depth", "--sensor", "bent"}).ok());
    return parse_json(read_text(folder_ / "out/frame_0000/bent/meta.json").value()).value();
  };
  const auto port = meta_of("port = { kind = \"flat\" }\n");
  EXPECT_FALSE(port.contains("lens")) << port["lens"];
  EXPECT_EQ(port["port"]["kind"], "flat");
  const auto both =
      meta_of("port = { kind = \"flat\" }\nlens = { model = \"brown_conrady\", k = [-0.1] }\n");
  EXPECT_FALSE(both["lens"].contains("opencv"));
  EXPECT_EQ(both["lens"]["opencv_in_air"][0], -0.1);
  const auto lens = meta_of("lens = { model = \"brown_conrady\", k = [-0.1] }\n");
  EXPECT_EQ(lens["lens"]["opencv"][0], -0.1);
}

TEST_F(RenderData, APictureCameraThatDoesNotSuitItsSideScanIsRefusedBeforeTheFirstFrame) {
  const auto said = [&](const std::string& keys, std::vector<std::string> words) {
    EXPECT_TRUE(write_text(folder_ / "scene.toml",
                           std::string(kScene) +
                               "[[cameras]]\nname = \"down\"\nwidth = 16\nheight = 16\n"
                               "position_m = [0, -10, 0]\n" +
                               keys +
                               "[[sonars]]\nname = \"side\"\nkind = \"sidescan\"\nrange_m = [1, 10]"
                               "\nposition_m = [0, -10, 0]\nbins = [32, 4, 32]\nrate_hz = 10\n"
                               "picture_camera = \"down\"\n")
                    .ok());
    words.insert(words.end(), {"--frames", "2", "--sensor", "side"});
    const auto result = render("out", words);
    EXPECT_EQ(fs::exists(folder_ / "out/frame_0000"), result.ok());
    return result.ok() ? std::string() : result.error().message;
  };
  EXPECT_EQ(said("", {"--sensor", "down"}),
            "sonar side: picture_camera: found down, which looks 90 degrees off straight down; "
            "accepted: at most 15 degrees");
  EXPECT_EQ(
      said("pitch_deg = -90\n", {}),
      "sonar side: picture_camera: found 'down'; accepted: a camera of the scene that --sensor "
      "names too");
  EXPECT_EQ(said("pitch_deg = -90\nrate_hz = 5\n", {"--sensor", "down", "--own-rates"}),
            "sonar side: picture_camera: found down at 5 Hz; accepted: a camera of 10 Hz or more, "
            "as the sonar has (--own-rates)");
  EXPECT_EQ(said("pitch_deg = -90\n", {"--sensor", "down"}), "");
}

}  // namespace
}  // namespace neritic
