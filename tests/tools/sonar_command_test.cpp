// `neritic sonar imaging` on files: real data sets in their own conventions, coded normals, bad
// input.
#include "tests/tools/sonar_command.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/math.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;
using test::have_device;
using test::numbers_of;
using test::sum;

// The command as a user types it after `neritic sonar imaging`.
Status sonar(std::vector<std::string> words) {
  words.insert(words.begin(), {"sonar", "imaging"});
  const bool pictures = std::ranges::find(words, "--no-pictures") == words.end();
  NERITIC_TRY(const tools::CommandLine line, tools::parse_command_line(words));
  NERITIC_TRY(const std::string done, line.run());
  EXPECT_EQ(done.find("sonar.png") != std::string::npos, pictures) << done;
  return {};
}

// The data sets' conventions, as sonar/OFFLINE.md lists them. Paths are below shared/data/rgbd.
struct DataSet {
  const char* name;
  std::vector<std::string> words;
  double least_heard;  // share of columns with a return
};
void PrintTo(const DataSet& set, std::ostream* out) {
  *out << set.name;
}

const DataSet kDataSets[] = {
    {"wall5m",
     {"--depth",         "depth-analytic/wall5m_depth_m.exr",
      "--normals",       "depth-analytic/wall5m_normal_cam.exr",
      "--labels",        "depth-analytic/wall5m_segmentation.png",
      "--intrinsics",    "depth-analytic/meta.json",
      "--pixel-centers", "integer",
      "--axes",          "opencv",
      "--range",         "3,8",
      "--azimuth",       "58",
      "--elevation",     "40",
      "--bins",          "250,200,150"},
     0.99},
    {"seabed_and_sphere",
     {"--depth",         "depth-analytic/seabed_and_sphere_depth_m.exr",
      "--normals",       "depth-analytic/seabed_and_sphere_normal_cam.exr",
      "--labels",        "depth-analytic/seabed_and_sphere_segmentation.png",
      "--intrinsics",    "depth-analytic/meta.json",
      "--pixel-centers", "integer",
      "--axes",          "opencv",
      "--range",         "3,12",
      "--azimuth",       "58",
      "--elevation",     "44",
      "--bins",          "250,200,150"},
     0.99},
    {"wreck_0",
     {"--depth",         "depth-synthetic-wreck/frame_0000_depth_m.exr",
      "--normals",       "depth-synthetic-wreck/frame_0000_normal_cam.exr",
      "--labels",        "depth-synthetic-wreck/frame_0000_segmentation.png",
      "--intrinsics",    "depth-synthetic-wreck/meta.json",
      "--pixel-centers", "integer",
      "--axes",          "opencv",
      "--range",         "2,40",
      "--azimuth",       "74",
      "--elevation",     "59",
      "--bins",          "500,400,300"},
     0.9},
    {"wreck_1",
     {"--depth",         "depth-synthetic-wreck/frame_0001_depth_m.exr",
      "--normals",       "depth-synthetic-wreck/frame_0001_normal_cam.exr",
      "--labels",        "depth-synthetic-wreck/frame_0001_segmentation.png",
      "--intrinsics",    "depth-synthetic-wreck/meta.json",
      "--pixel-centers", "integer",
      "--axes",          "opencv",
      "--range",         "2,40",
      "--azimuth",       "60",
      "--elevation",     "46",
      "--bins",          "500,400,300"},
     0.9},
    {"wreck_2_mm",
     {"--depth",         "depth-synthetic-wreck/frame_0002_depth_mm.png",
      "--depth-scale",   "0.001",
      "--normals",       "depth-synthetic-wreck/frame_0002_normal_cam.exr",
      "--labels",        "depth-synthetic-wreck/frame_0002_segmentation.png",
      "--intrinsics",    "depth-synthetic-wreck/meta.json",
      "--pixel-centers", "integer",
      "--axes",          "opencv",
      "--range",         "2,30",
      "--azimuth",       "90",
      "--elevation",     "73",
      "--bins",          "500,400,300"},
     0.9},
    {"cleargrasp_synthetic",
     {"--depth", "depth-cleargrasp/synthetic/000000000-depth-rectified.exr", "--normals",
      "depth-cleargrasp/synthetic/000000000-cameraNormals.exr", "--labels",
      "depth-cleargrasp/synthetic/000000000-segmentation-mask.png", "--intrinsics",
      "1386.4160255812183,1386.4160255812183,960,540", "--range", "0.3,1.5", "--azimuth", "69",
      "--elevation", "42", "--bins", "400,400,300"},
     0.9},
    {"cleargrasp_synthetic_2",
     {"--depth", "depth-cleargrasp/synthetic/000000002-depth-rectified.exr", "--normals",
      "depth-cleargrasp/synthetic/000000002-cameraNormals.exr", "--intrinsics",
      "depth-cleargrasp/meta.json", "--range", "0.3,1.5", "--azimuth", "69", "--elevation", "42",
      "--bins", "400,400,300"},
     0.9},
    {"cleargrasp_real",
     {"--depth", "depth-cleargrasp/real/000000080-opaque-depth-img.exr", "--normals",
      "depth-cleargrasp/real/000000080-normals.exr", "--labels",
      "depth-cleargrasp/real/000000080-mask.png", "--intrinsics", "921,921,642,359", "--range",
      "0.3,1.5", "--azimuth", "69", "--elevation", "42", "--bins", "400,400,300"},
     0.8},
    {"cleargrasp_real_raw",
     {"--depth", "depth-cleargrasp/real/000000080-transparent-depth-img.exr", "--intrinsics",
      "921,921,642,359", "--range", "0.3,1.5", "--azimuth", "69", "--elevation", "42", "--bins",
      "400,400,300"},
     0.7},
    {"redwood",
     {"--depth", "depth-redwood/depth/00000.png", "--depth-scale", "0.001", "--intrinsics",
      "depth-redwood/camera_primesense.json", "--pixel-centers", "integer", "--range", "0.5,5",
      "--azimuth", "62", "--elevation", "48", "--bins", "400,400,300"},
     0.8}};

class RealImages : public ::testing::TestWithParam<DataSet> {};

TEST_P(RealImages, GiveTheSameSonarImageByBothMethods) {
  NERITIC_REQUIRE_SHARED(shared);
  const DataSet& set = GetParam();
  std::vector<std::string> words = set.words;
  for (std::string& word : words)
    if (word.rfind("depth-", 0) == 0) word = (shared / "data/rgbd" / word).string();
  const test::ScratchFolder folder;
  const auto out = [&](const char* method) {
    const char* kept = std::getenv("NERITIC_KEEP");  // a folder, to look at the panels
    return kept != nullptr ? fs::path(kept) / set.name / method : folder / method;
  };
  words.insert(words.end(), {"--method", "reference", "--out", out("reference").string()});
  const Status done = sonar(words);
  ASSERT_TRUE(done.ok()) << done.error().message;
  const auto reference = numbers_of(out("reference") / "sonar.npy");
  const auto labels = numbers_of(out("reference") / "sonar_labels.npy");
  const auto facts = parse_json(*read_text(out("reference") / "sonar.json")).value();
  const std::size_t columns = facts["bins"]["azimuth"], rows = facts["bins"]["range"];
  ASSERT_EQ(reference.size(), rows * columns);
  ASSERT_EQ(labels.size(), rows * columns);
  std::size_t heard = 0;
  for (std::size_t c = 0; c < columns; ++c) {
    bool any = false;
    for (std::size_t r = 0; r < rows; ++r) any |= reference[r * columns + c] > 0.0;
    heard += any;
  }
  EXPECT_GE(static_cast<double>(heard), set.least_heard * static_cast<double>(columns));
  EXPECT_TRUE(fs::exists(out("reference") / "sonar.png"));

  if (!have_device()) GTEST_SKIP() << "the reference ran; no Vulkan device for the other method";
  words[words.size() - 3] = "gpu";
  words.back() = out("gpu").string();
  const Status on_gpu = sonar(words);
  ASSERT_TRUE(on_gpu.ok()) << on_gpu.error().message;
  const auto image = numbers_of(out("gpu") / "sonar.npy");
  EXPECT_NEAR(sum(image) / sum(reference), 1.0, 0.01);
  double moved = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) moved += std::abs(image[i] - reference[i]);
  EXPECT_LT(moved, 0.02 * sum(reference));  // half of it is energy in another cell
}

INSTANTIATE_TEST_SUITE_P(Sonar, RealImages, ::testing::ValuesIn(kDataSets),
                         [](const auto& info) { return std::string(info.param.name); });

// A wall 2 m ahead in 16 x 12 pixels, its normals in every coding.
class SmallImages : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kWidth = 16, kHeight = 12;
  void SetUp() override {
    depth_.assign(kWidth * kHeight, 2.0f);
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) normals_.insert(normals_.end(), {0, 0, 1});
    write(depth_, normals_);
  }
  void write(const std::vector<float>& depth, const std::vector<float>& normals) {
    ASSERT_TRUE(
        write_npy(folder_ / "depth.npy", std::span<const float>(depth), {kHeight, kWidth}).ok());
    ASSERT_TRUE(
        write_npy(folder_ / "normals.npy", std::span<const float>(normals), {kHeight, kWidth, 3})
            .ok());
  }
  std::vector<std::string> words(std::vector<std::string> more = {}) {
    std::vector<std::string> all{"--depth",      (folder_ / "depth.npy").string(),
                                 "--normals",    (folder_ / "normals.npy").string(),
                                 "--intrinsics", "10,10,8,6",
                                 "--bins",       "8,8,8",
                                 "--out",        (folder_ / "out").string(),
                                 "--no-pictures"};
    if (std::find(more.begin(), more.end(), "--method") == more.end())
      all.insert(all.end(), {"--method", "reference"});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  // Replaces the value of a flag.
  std::vector<std::string> with(const std::string& flag, const std::string& value) {
    auto all = words();
    *(std::find(all.begin(), all.end(), flag) + 1) = value;
    return all;
  }
  double energy() { return sum(numbers_of(folder_ / "out" / "sonar.npy")); }
  void expect_refused(const std::vector<std::string>& all, const std::string& named) {
    const Status status = sonar(all);
    ASSERT_FALSE(status.ok()) << named;
    EXPECT_EQ(status.error().code, ErrorCode::kBadInput);
    EXPECT_NE(status.error().message.find(named), std::string::npos) << status.error().message;
    EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
  }
  test::ScratchFolder folder_;
  std::vector<float> depth_, normals_;
};

TEST_F(SmallImages, GammaCodedNormalsAreUndone) {
  ASSERT_TRUE(sonar(words()).ok());
  const double expected = energy();
  EXPECT_GT(expected, 0.5);
  ImageU8 coded(kWidth, kHeight, 3);
  // (0, 0, 1) with gamma 2.2: v = ((n + 1) / 2)^(1 / 2.2).
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    coded.data[3 * i] = coded.data[3 * i + 1] =
        static_cast<std::uint8_t>(std::lround(255.0 * std::pow(0.5, 1.0 / 2.2)));
    coded.data[3 * i + 2] = 255;
  }
  ASSERT_TRUE(scene::write_png8(folder_ / "n8.png", coded).ok());
  auto all = with("--normals", (folder_ / "n8.png").string());
  all.insert(all.end(), {"--gamma", "2.2"});
  ASSERT_TRUE(sonar(all).ok());
  EXPECT_NEAR(energy(), expected, 0.01 * expected);
  // Without the gamma the same bytes mean another normal.
  ASSERT_TRUE(sonar(with("--normals", (folder_ / "n8.png").string())).ok());
  EXPECT_LT(energy(), 0.96 * expected);

  ImageU16 fine(kWidth, kHeight, 3);
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    fine.data[3 * i] = fine.data[3 * i + 1] = 32768;
    fine.data[3 * i + 2] = 65535;
  }
  ASSERT_TRUE(scene::write_png16(folder_ / "n16.png", fine).ok());
  ASSERT_TRUE(sonar(with("--normals", (folder_ / "n16.png").string())).ok());
  EXPECT_NEAR(energy(), expected, 1e-3 * expected);
}

// A normal of its own in every pixel, so that no axis can be turned or left without a cell telling.
TEST_F(SmallImages, AxesAreTurnedToTheSonars) {
  std::vector<Vec3> normals;  // x right, y up, z backwards
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i)
    normals.push_back(
        glm::normalize(Vec3(0.9 * std::sin(1.0 + 0.7 * i), 0.9 * std::sin(2.0 + 1.3 * i), 1.0)));
  const auto heard = [&](const char* axes, auto turned) {
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
      const Vec3 n = turned(normals[i]);
      for (int k = 0; k < 3; ++k) normals_[3 * i + k] = static_cast<float>(n[k]);
    }
    write(depth_, normals_);
    EXPECT_TRUE(sonar(words({"--axes", axes})).ok());
    return numbers_of(folder_ / "out" / "sonar.npy");
  };
  const auto expected = heard("opengl", [](const Vec3& n) { return n; });
  // OpenCV: x right, y down, z forwards. ROS (REP 103): x forwards, y left, z up.
  const auto opencv = heard("opencv", [](const Vec3& n) { return Vec3(n.x, -n.y, -n.z); });
  const auto ros = heard("ros", [](const Vec3& n) { return Vec3(-n.z, -n.x, n.y); });
  ASSERT_GT(sum(expected), 0.5);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(opencv[i], expected[i], 1e-7) << i;
    EXPECT_NEAR(ros[i], expected[i], 1e-7) << i;
  }
}

// As masks of classes are exported: a PNG of indices, with colours to look at.
TEST_F(SmallImages, LabelsOfAPaletteAreItsIndices) {
  std::vector<unsigned char> pixels(kWidth * kHeight, 2);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = kWidth;
  png.height = kHeight;
  png.format = PNG_FORMAT_RGB_COLORMAP;
  png.colormap_entries = 4;
  const unsigned char colors[] = {0, 0, 0, 128, 0, 0, 0, 128, 0, 128, 128, 0};
  const auto path = (folder_ / "classes.png").string();
  ASSERT_TRUE(png_image_write_to_file(&png, path.c_str(), 0, pixels.data(), 0, colors));
  ASSERT_TRUE(sonar(words({"--labels", path})).ok());
  const auto labels = numbers_of(folder_ / "out" / "sonar_labels.npy");
  EXPECT_EQ(*std::max_element(labels.begin(), labels.end()), 2.0);
  // Colours in their stead are no classes, nor indices distances.
  ImageU8 colored(kWidth, kHeight, 3);
  for (std::size_t i = 0; i < colored.data.size(); ++i) colored.data[i] = i % 3 == 1 ? 128 : 0;
  ASSERT_TRUE(scene::write_png8(folder_ / "colors.png", colored).ok());
  expect_refused(words({"--labels", (folder_ / "colors.png").string()}),
                 "colors.png: found 3 channels");
  expect_refused(with("--depth", path), "classes.png: found a palette");
  const std::vector<float> halves(kWidth * kHeight, 1.5f);
  ASSERT_TRUE(write_npy(folder_ / "halves.npy", halves, {kHeight, kWidth}).ok());
  expect_refused(words({"--labels", (folder_ / "halves.npy").string()}), "label 1.5");
}

TEST_F(SmallImages, AnotherKindsResultDoesNotStay) {
  auto with_picture = words();
  std::erase(with_picture, "--no-pictures");
  ASSERT_TRUE(sonar(words()).ok());
  for (const char* name : {"cloud.npy", "cloud.pcd", "sonar_counts.npy"})
    ASSERT_TRUE(write_text(folder_ / "out" / name, "of a profiling sonar").ok());
  ASSERT_TRUE(sonar(with_picture).ok());
  EXPECT_FALSE(fs::exists(folder_ / "out" / "cloud.npy"));
  EXPECT_FALSE(fs::exists(folder_ / "out" / "cloud.pcd"));
  // Nor beside a side-scan's line from a picture.
  ASSERT_TRUE(write_text(folder_ / "out" / "cloud.npy", "of a profiling sonar").ok());
  ASSERT_TRUE(scene::write_png8(folder_ / "p.png", ImageU8(kWidth, kHeight, 1)).ok());
  NERITIC_ASSERT_STATUS(test::sonar_command(
      {"sidescan", "--method", "image", "--picture", (folder_ / "p.png").string(), "--altitude",
       "5", "--intrinsics", "10,10,8,6", "--out", (folder_ / "out").string()}));
  for (const char* name : {"cloud.npy", "sonar_labels.npy", "sonar.png"})
    EXPECT_FALSE(fs::exists(folder_ / "out" / name)) << name;
  EXPECT_TRUE(fs::exists(folder_ / "out" / "sonar.npy"));
}

TEST_F(SmallImages, NormalsAreEstimatedFromTheDepthAndSaidSo) {
  ASSERT_TRUE(sonar(words()).ok());
  const double expected = energy();
  auto all = words();
  const auto at = std::find(all.begin(), all.end(), "--normals");
  all.erase(at, at + 2);
  ASSERT_TRUE(sonar(all).ok());
  EXPECT_NEAR(energy(), expected, 1e-6 * expected);
  const auto facts = parse_json(*read_text(folder_ / "out" / "sonar.json")).value();
  EXPECT_EQ(facts["normals"], "estimated from depth");
}

TEST_F(SmallImages, HolesMakeSilence) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float hole : {nan, std::numeric_limits<float>::infinity(), 0.0f, -3.0f}) {
    write(std::vector<float>(depth_.size(), hole), normals_);
    ASSERT_TRUE(sonar(words()).ok());
    EXPECT_EQ(energy(), 0.0) << hole;
  }
  for (const float hole : {nan, 0.0f, -1.0f}) {
    write(depth_, std::vector<float>(normals_.size(), hole));
    ASSERT_TRUE(sonar(words()).ok());
    EXPECT_EQ(energy(), 0.0) << hole;
  }
}

TEST_F(SmallImages, WrongFlagsAreRefusedByName) {
  expect_refused(with("--bins", "8,8"), "--bins");
  expect_refused(with("--bins", "8,0,8"), "--bins");
  expect_refused(with("--bins", "8,99999999,8"), "--bins");
  expect_refused(with("--intrinsics", "10,10,8"), "--intrinsics");
  expect_refused(with("--intrinsics", "0,10,8,6"), "--intrinsics");
  expect_refused(with("--intrinsics", "nan,10,8,6"), "--intrinsics");
  expect_refused(words({"--range", "5,1"}), "--range");
  expect_refused(words({"--range", "1"}), "--range");
  expect_refused(words({"--azimuth", "400"}), "--azimuth");
  expect_refused(words({"--elevation", "wide"}), "--elevation");
  expect_refused(words({"--depth-scale", "-1"}), "--depth-scale");
  expect_refused(words({"--gamma", "0"}), "--gamma");
  expect_refused(words({"--axes", "maya"}), "--axes");
  expect_refused(words({"--method", "magic"}), "--method");
  expect_refused(words({"--azimuth", "-90"}),
                 "--azimuth: found -90 degrees; accepted: more than 0, or two edges");
  expect_refused(words({"--elevation", "0"}),
                 "--elevation: found 0 degrees; accepted: more than 0");
  expect_refused(with("--intrinsics", "calib.txt"), "fx,fy,cx,cy");
  expect_refused(with("--intrinsics", "calib.yaml"), "calib.yaml: found no such file");
  expect_refused(words({"--seed", "-1"}), "0 to 18446744073709551615");
  expect_refused(words({"--seed", "99999999999999999999999"}), "0 to 18446744073709551615");
}

TEST_F(SmallImages, FlagsWithoutEffectAreRefused) {
  expect_refused(words({"--seed", "2"}),
                 "--seed: found in a run that would ignore it; accepted: with --sensor");
  expect_refused(words({"--backscatter-db", "-30"}), "--backscatter-db: found");
  expect_refused(words({"--side", "port"}), "--side: found");
  for (const auto& [flag, value] :
       {std::pair{"--gamma", "1"}, {"--axes", "opencv"}, {"--normals-sign", "unknown"}}) {
    auto all = words({flag, value});
    const auto at = std::find(all.begin(), all.end(), "--normals");
    all.erase(at, at + 2);
    expect_refused(
        all, std::string(flag) + ": found in a run that would ignore it; accepted: with --normals");
  }
}

TEST_F(SmallImages, WrongFilesAreRefusedByName) {
  expect_refused(with("--depth", (folder_ / "absent.npy").string()), "absent.npy");
  ASSERT_TRUE(write_text(folder_ / "junk.exr", "not an image").ok());
  expect_refused(with("--depth", (folder_ / "junk.exr").string()), "junk.exr");
  ASSERT_TRUE(write_text(folder_ / "junk.png", "not an image").ok());
  expect_refused(with("--normals", (folder_ / "junk.png").string()), "junk.png");
  expect_refused(with("--depth", (folder_ / "depth.tiff").string()), "depth.tiff");
  ASSERT_TRUE(write_npy(folder_ / "small.npy", std::vector<float>(3 * 4, 1.0f), {2, 2, 3}).ok());
  expect_refused(with("--normals", (folder_ / "small.npy").string()), "small.npy");
  expect_refused(with("--normals", (folder_ / "depth.npy").string()), "depth.npy");
  ASSERT_TRUE(write_npy(folder_ / "empty.npy", std::vector<float>(), {0, 16}).ok());
  expect_refused(with("--depth", (folder_ / "empty.npy").string()), "empty.npy");
  ASSERT_TRUE(write_npy(folder_ / "flat.npy", std::vector<float>(9, 1.0f), {9}).ok());
  expect_refused(with("--depth", (folder_ / "flat.npy").string()), "flat.npy");
  ASSERT_TRUE(write_text(folder_ / "k.json", "{\"fx\": \"wide\"}").ok());
  expect_refused(with("--intrinsics", (folder_ / "k.json").string()), "k.json");
  ASSERT_TRUE(
      write_text(folder_ / "k.json", "{\"fx\": 1, \"fy\": 1, \"cx\": 1, \"cy\": 1, \"width\": 99}")
          .ok());
  expect_refused(with("--intrinsics", (folder_ / "k.json").string()), "width");
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(SmallImages, SixteenThousandPixelsInARowAreTaken) {
  const std::uint32_t width = 16384;
  ASSERT_TRUE(
      write_npy(folder_ / "depth.npy", std::vector<float>(width * 2, 2.0f), {2, width}).ok());
  std::vector<float> normals;
  for (std::uint32_t i = 0; i < width * 2; ++i) normals.insert(normals.end(), {0, 0, 1});
  ASSERT_TRUE(write_npy(folder_ / "normals.npy", normals, {2, width, 3}).ok());
  const auto k = std::string("8192,8192,8192,1");
  ASSERT_TRUE(sonar(with("--intrinsics", k)).ok());
  const double expected = energy();
  EXPECT_GT(expected, 0.1);
  if (!have_device()) GTEST_SKIP() << "no Vulkan device";
  auto all = with("--intrinsics", k);
  *(std::find(all.begin(), all.end(), "--method") + 1) = "gpu";
  const Status done = sonar(all);
  ASSERT_TRUE(done.ok()) << done.error().message;
  EXPECT_NEAR(energy(), expected, 0.01 * expected);
}

}  // namespace
}  // namespace neritic
