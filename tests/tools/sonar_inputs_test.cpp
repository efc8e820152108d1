// `neritic sonar` on the same sea floor in the files and conventions that people have: each gives
// the sonar image of the plain .npy in metres.
#include <fstream>

#include "engine/core/files.hpp"
#include "engine/core/npz.hpp"
#include "tests/support/support.hpp"
#include "tests/tools/sonar_command.hpp"

namespace neritic {
namespace {

using test::Words;

constexpr std::uint32_t kColumns = 64, kRows = 48;
constexpr double kFocal = 60.0, kBaseline_m = 0.12;

// A floor 2 m below a level camera, and its normals in the camera's axes of OpenCV.
class SonarInputs : public ::testing::Test {
 protected:
  void SetUp() override {
    for (std::uint32_t v = 0; v < kRows; ++v)
      for (std::uint32_t u = 0; u < kColumns; ++u) {
        const double down = (v + 0.5 - kRows / 2.0) / kFocal;
        // On 1/256 m, which 16 bits hold as well as floats.
        depth_.push_back(down > 0.05 ? std::round(512.0 / down) / 256.0 : 0.0);
      }
    std::vector<float> depth(depth_.begin(), depth_.end()), normals;
    for (std::size_t i = 0; i < depth_.size(); ++i)
      normals.insert(normals.end(), {0.0f, -1.0f, 0.0f});
    const std::size_t shape[] = {kRows, kColumns}, vectors[] = {kRows, kColumns, 3};
    EXPECT_TRUE(write_npy(at("depth.npy"), depth, {kRows, kColumns}).ok());
    EXPECT_TRUE(write_npy(at("normals.npy"), normals, {kRows, kColumns, 3}).ok());
    EXPECT_TRUE(
        write_npz(at("z.npz"), NpyType::kFloat32, shape, std::as_bytes(std::span(depth))).ok());
    EXPECT_TRUE(
        write_npz(at("n.npz"), NpyType::kFloat32, vectors, std::as_bytes(std::span(normals))).ok());
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  void write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(write_text(at(name), text).ok());
  }
  // Big-endian, as .pgm has them.
  std::string pgm16() const {
    std::string out = fmt::format("P5\n# the floor\n{} {}\n65535\n", kColumns, kRows);
    for (const double depth : depth_) {
      const auto code = static_cast<std::uint32_t>(depth * 256.0);
      out += {static_cast<char>(code >> 8), static_cast<char>(code & 0xff)};
    }
    return out;
  }
  // Rows from the bottom, little-endian.
  std::string pfm(const std::vector<double>& values) const {
    std::string out = fmt::format("Pf\n{} {}\n-1.0\n", kColumns, kRows);
    for (std::uint32_t row = kRows; row-- > 0;)
      for (std::uint32_t u = 0; u < kColumns; ++u) {
        const auto value = static_cast<float>(values[row * kColumns + u]);
        out.append(reinterpret_cast<const char*>(&value), 4);
      }
    return out;
  }

  // The whole sonar image; words later in the list win.
  std::vector<double> image(const Words& words) {
    Words all{"imaging", "--method",    "reference", "--range", "2,20",     "--azimuth",
              "50",      "--elevation", "40",        "--bins",  "60,40,40", "--no-pictures",
              "--out",   at("out")};
    const Status done = test::sonar_command(test::operator+(all, words));
    EXPECT_TRUE(done.ok()) << done.error().message;
    return done.ok() ? test::numbers_of(at("out/sonar.npy")) : std::vector<double>();
  }
  std::string refused(const Words& words) {
    Words all{"imaging", "--method", "reference", "--out", at("out")};
    const Status done = test::sonar_command(test::operator+(all, words));
    return done.ok() ? "" : done.error().message;
  }

  test::ScratchFolder folder_;  // first: the words below name it
  const Words normals_{"--normals", at("normals.npy"), "--axes", "opencv"};
  const Words pinhole_{"--intrinsics", "60,60,32,24"};
  std::vector<double> depth_;
};

TEST_F(SonarInputs, EveryKindOfFileGivesTheSameSonar) {
  using test::operator+;
  const auto wanted = image(Words{"--depth", at("depth.npy")} + normals_ + pinhole_);
  EXPECT_GT(test::sum(wanted), 1.0);
  write("z.pgm", pgm16());
  write("z.pfm", pfm(depth_));
  for (const Words& depth : {Words{"--depth", at("z.npz")},
                             {"--depth", at("z.pfm")},
                             {"--depth", at("z.pgm"), "--depth-scale", "0.00390625"}})
    EXPECT_EQ(image(depth + normals_ + pinhole_), wanted) << depth[1];
  EXPECT_EQ(image({"--depth", at("depth.npy"), "--normals", at("n.npz"), "--axes", "opencv",
                   "--intrinsics", "60,60,32,24"}),
            wanted);
}

TEST_F(SonarInputs, DisparitiesAreDepthsByBaselineAndFocalLength) {
  using test::operator+;
  std::vector<double> disparity;
  for (const double depth : depth_)
    disparity.push_back(depth > 0.0 ? kFocal * kBaseline_m / depth : 0.0);
  write("d.pfm", pfm(disparity));
  const auto wanted = image(Words{"--depth", at("depth.npy")} + normals_ + pinhole_);
  const Words words =
      Words{"--depth", at("d.pfm"), "--depth-kind", "disparity"} + normals_ + pinhole_;
  const auto found = image(words + Words{"--baseline", "0.12"});
  ASSERT_EQ(found.size(), wanted.size());
  EXPECT_NEAR(test::sum(found), test::sum(wanted),
              0.02 * test::sum(wanted));  // floats at bins' edges
  EXPECT_NE(refused(words).find("--baseline: found none"), std::string::npos) << refused(words);
  EXPECT_NE(refused(words + Words{"--baseline", "-1"}).find("--baseline: found -1"),
            std::string::npos);
}

// The camera looks along the world's x axis, z up: the floor's normal is (0, 0, 1) there.
TEST_F(SonarInputs, NormalsInWorldAxesAreTurnedByTheCamerasPose) {
  using test::operator+;
  const auto wanted = image(Words{"--depth", at("depth.npy")} + normals_ + pinhole_);
  std::vector<float> normals;
  for (std::size_t i = 0; i < depth_.size(); ++i) normals.insert(normals.end(), {0.0f, 0.0f, 1.0f});
  ASSERT_TRUE(write_npy(at("world.npy"), normals, {kRows, kColumns, 3}).ok());
  // In OpenCV's camera axes: right is -y, down is -z, forward is x.
  write("pose.json",
        R"({"camera_to_world": [[0, 0, 1, 5], [-1, 0, 0, 6], [0, -1, 0, 7], [0, 0, 0, 1]]})");
  write("pose.yaml", "pose:\n  rotation_xyzw: [-0.5, 0.5, -0.5, 0.5]\n");
  const Words world =
      Words{"--depth", at("depth.npy"), "--normals", at("world.npy"), "--axes", "opencv"} +
      pinhole_;
  for (const std::string& pose :
       {std::string("-0.5,0.5,-0.5,0.5"), at("pose.json"), at("pose.yaml")}) {
    const auto found = image(world + Words{"--camera-pose=" + pose});
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], wanted[i], 1e-6) << pose;
  }
  EXPECT_NE(image(world), wanted);
  EXPECT_NE(refused(world + Words{"--camera-pose", "1,1,0,0"}).find("a quaternion of length 1.41"),
            std::string::npos);
  write("mirrored.json", R"({"camera_to_world": [[0, 0, 1], [1, 0, 0], [0, -1, 0]]})");
  EXPECT_NE(refused(world + Words{"--camera-pose", at("mirrored.json")})
                .find("camera_to_world: found no rotation"),
            std::string::npos);
}

TEST_F(SonarInputs, CameraInfoOfRosAndOpencvAreIntrinsics) {
  using test::operator+;
  const Words depth = Words{"--depth", at("depth.npy")} + normals_;
  const auto wanted = image(depth + pinhole_);
  write("ros.yaml",
        "image_width: 64\nimage_height: 48\ncamera_name: left\ncamera_matrix:\n  rows: 3\n"
        "  cols: 3\n  data: [60., 0., 32.,\n         0., 60., 24., 0., 0., 1.]\n"
        "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
        "  data: [0, 0, 0, 0, 0]\n");
  write("topic.yaml",
        "header:\n  frame_id: left\nheight: 48\nwidth: 64\nd:\n- 0.0\nk:\n- 60.0\n- 0.0\n"
        "- 32.0\n- 0.0\n- 60.0\n- 24.0\n- 0.0\n- 0.0\n- 1.0\n---\n");
  write("opencv.yml",
        "%YAML:1.0\n---\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
        "   data: [ 6.0e+01, 0., 32., 0., 6.0e+01, 24., 0., 0., 1. ]\n");
  for (const char* name : {"ros.yaml", "topic.yaml", "opencv.yml"})
    EXPECT_EQ(image(depth + Words{"--intrinsics", at(name)}), wanted) << name;
  write("bent.yaml", "K: [60, 0, 32, 0, 60, 24, 0, 0, 1]\nD: [0.1, 0, 0, 0, 0]\n");
  const std::string bent = refused(depth + Words{"--intrinsics", at("bent.yaml")});
  EXPECT_NE(bent.find("bent.yaml: D: found [0.1,0,0,0,0]; accepted: no distortion"),
            std::string::npos)
      << bent;
  // What Neritic's meta.json says of a lens and of a port.
  const std::string pinhole = R"({"fx": 60, "fy": 60, "cx": 32, "cy": 24, )";
  for (const char* none : {R"("lens": {"model": "brown_conrady", "opencv": [0, 0, 0, 0, 0]}})",
                           R"("port": {"kind": "dome", "offset": 0.0, "index": 1.34}})"}) {
    write("meta.json", pinhole + none);
    EXPECT_EQ(image(depth + Words{"--intrinsics", at("meta.json")}), wanted) << none;
  }
  for (const auto& [bends, found] :
       {std::pair{R"("lens": {"model": "brown_conrady", "opencv": [-0.2, 0, 0, 0, 0]}})",
                  "lens: found"},
        {R"("lens": {"model": "fisheye", "opencv": [0, 0, 0, 0]}})", "lens: found"},
        {R"("port": {"kind": "flat", "offset": 0.0, "index": 1.34}})", "port: found"},
        {R"("port": {"kind": "dome", "offset": 0.3, "index": 1.34}})", "port: found"}}) {
    write("meta.json", pinhole + bends);
    const std::string said = refused(depth + Words{"--intrinsics", at("meta.json")});
    EXPECT_NE(said.find(std::string("meta.json: ") + found), std::string::npos) << said;
  }
  write("torn.yaml", "K: [60, 0\nwidth: 64\n");
  const std::string torn = refused(depth + Words{"--intrinsics", at("torn.yaml")});
  EXPECT_NE(torn.find("torn.yaml: line 1: found"), std::string::npos) << torn;
}

TEST_F(SonarInputs, BrokenFilesEndInOneLine) {
  using test::operator+;
  const std::string whole = pgm16();
  write("cut.pgm", whole.substr(0, whole.size() - 1));
  write("kind.pgm", "P6 1 1 255\nabc");
  write("cut.npz", read_text(at("z.npz")).value().substr(0, 300));
  const std::pair<const char*, const char*> cases[] = {
      {"cut.pgm", "cut.pgm: found 6143 bytes of numbers; accepted: 6144 for 64 x 48"},
      {"kind.pgm", "kind.pgm: found 14 bytes of another kind; accepted: a grey .pgm"},
      {"cut.npz", "cut.npz: found no end of a ZIP archive; accepted: a whole .npz"}};
  for (const auto& [name, words] : cases) {
    const std::string said = refused(Words{"--depth", at(name)} + normals_ + pinhole_);
    EXPECT_NE(said.find(words), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace neritic
