// Every kind of sonar on images of others: the real sets, every convention, sensors with terms, and
// what images alone cannot give.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/math.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/support.hpp"
#include "tests/tools/sonar_command.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;
using test::numbers_of;
using test::sonar_command;
using test::sum;
using test::Words;
using test::operator+;

struct RealSet {
  const char* name;
  Words words;  // paths below shared/data/rgbd begin with "depth-"
  std::size_t frames;
  const char* range;
};
void PrintTo(const RealSet& set, std::ostream* out) {
  *out << set.name;
}
const RealSet kSets[] = {
    {"analytic",
     {"--depth", "depth-analytic/*_depth_m.exr", "--normals", "depth-analytic/*_normal_cam.exr",
      "--labels", "depth-analytic/*_segmentation.png", "--intrinsics", "depth-analytic/meta.json",
      "--pixel-centers", "integer", "--axes", "opencv"},
     2,
     "3,12"},
    {"wreck",
     {"--depth", "depth-synthetic-wreck/*_depth_m.exr", "--normals",
      "depth-synthetic-wreck/*_normal_cam.exr", "--labels",
      "depth-synthetic-wreck/*_segmentation.png", "--intrinsics", "depth-synthetic-wreck/meta.json",
      "--pixel-centers", "integer", "--axes", "opencv"},
     3,
     "2,40"},
    {"wreck_mm_without_normals",
     {"--depth", "depth-synthetic-wreck/*_depth_mm.png", "--depth-scale", "0.001", "--intrinsics",
      "depth-synthetic-wreck/meta.json", "--pixel-centers", "integer"},
     3,
     "2,40"},
    {"redwood",
     {"--depth", "depth-redwood/depth", "--depth-scale", "0.001", "--intrinsics",
      "depth-redwood/camera_primesense.json", "--pixel-centers", "integer"},
     0,  // as many as there are
     "0.5,6"},
    {"cleargrasp",
     {"--depth", "depth-cleargrasp/synthetic/*-depth-rectified.exr", "--normals",
      "depth-cleargrasp/synthetic/*-cameraNormals.exr", "--intrinsics",
      "1386.416,1386.416,960,540"},
     0,
     "0.2,3"}};
const char* const kKinds[] = {"imaging", "profiling", "echosounder", "sidescan"};

class RealSets : public ::testing::TestWithParam<std::tuple<RealSet, const char*>> {};

TEST_P(RealSets, GoThroughEveryKind) {
  NERITIC_REQUIRE_SHARED(shared);
  if (!test::have_device()) GTEST_SKIP() << "no Vulkan device";
  const auto& [set, kind] = GetParam();
  Words words = set.words;
  for (std::string& word : words)
    if (word.rfind("depth-", 0) == 0) word = (shared / "data/rgbd" / word).string();
  const test::ScratchFolder folder;
  const char* kept = std::getenv("NERITIC_KEEP");  // a folder, to look at the pictures
  const fs::path out = kept != nullptr ? fs::path(kept) / set.name / kind : folder / "out";
  Words all{kind, "--range", set.range, "--out", out.string(), "--overwrite"};
  if (kept == nullptr) all.push_back("--no-pictures");
  const Status done = sonar_command(all + words);
  ASSERT_TRUE(done.ok()) << done.error().message;
  const auto run = parse_json(read_text(out / "run.json").value()).value();
  EXPECT_EQ(run["skipped"], 0);
  if (set.frames > 0) {
    EXPECT_EQ(run["made"], set.frames);
  }
  double heard = 0.0;
  for (const auto& entry : fs::directory_iterator(out)) {
    if (!entry.is_directory()) continue;
    const std::vector<double> image = numbers_of(entry.path() / "sonar.npy");
    for (const double v : image) ASSERT_TRUE(v >= 0.0 && std::isfinite(v)) << entry.path();
    heard += sum(image);
    const std::string k = kind;
    EXPECT_EQ(fs::exists(entry.path() / "cloud.npy"), k == "profiling");
    const auto facts = parse_json(read_text(entry.path() / "sonar.json").value()).value();
    if (k == "echosounder") {
      EXPECT_TRUE(facts["echo"]["first_return_m"].is_number());
    }
  }
  EXPECT_GT(heard, 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    Sonar, RealSets, ::testing::Combine(::testing::ValuesIn(kSets), ::testing::ValuesIn(kKinds)),
    [](const auto& info) {
      return std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param);
    });

// A wall 2.03 m ahead, in every convention.
class Wall : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kWidth = 64, kHeight = 48;
  static constexpr double kDepth_m = 2.03, kFocal = 60.0;

  void SetUp() override {
    if (!test::have_device()) GTEST_SKIP() << "no Vulkan device";
    std::vector<float> planar, along, z, minus_z, minus_x;
    ImageU16 mm(kWidth, kHeight, 1);
    for (std::uint32_t v = 0; v < kHeight; ++v)
      for (std::uint32_t u = 0; u < kWidth; ++u) {
        const double x = (u + 0.5 - kWidth / 2.0) / kFocal, y = (v + 0.5 - kHeight / 2.0) / kFocal;
        planar.push_back(float(kDepth_m));
        along.push_back(float(kDepth_m * std::sqrt(1.0 + x * x + y * y)));
        mm.data[v * kWidth + u] = 2030;
        z.insert(z.end(), {0, 0, 1});
        minus_z.insert(minus_z.end(), {0, 0, -1});
        minus_x.insert(minus_x.end(), {-1, 0, 0});
      }
    ImageU8 coded(kWidth, kHeight, 3);
    for (std::size_t i = 0; i < coded.data.size(); ++i)
      coded.data[i] = i % 3 == 2 ? 255 : std::uint8_t(std::lround(255 * std::pow(0.5, 1 / 2.2)));
    ASSERT_TRUE(write_npy(folder_ / "planar.npy", planar, {kHeight, kWidth}).ok());
    ASSERT_TRUE(write_npy(folder_ / "along.npy", along, {kHeight, kWidth}).ok());
    ASSERT_TRUE(scene::write_png16(folder_ / "mm.png", mm).ok());
    ASSERT_TRUE(write_npy(folder_ / "z.npy", z, {kHeight, kWidth, 3}).ok());
    ASSERT_TRUE(write_npy(folder_ / "minus_z.npy", minus_z, {kHeight, kWidth, 3}).ok());
    ASSERT_TRUE(write_npy(folder_ / "minus_x.npy", minus_x, {kHeight, kWidth, 3}).ok());
    ASSERT_TRUE(scene::write_png8(folder_ / "coded.png", coded).ok());
    ASSERT_TRUE(write_text(folder_ / "k.json",
                           R"({"width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 32, "cy": 24})")
                    .ok());
  }
  std::string file(const std::string& name) { return (folder_ / name).string(); }
  Words command(const std::string& kind, const Words& more) {
    return Words{kind, "--out", file("out"), "--range", "1,4", "--no-pictures"} + more;
  }
  std::vector<double> image(const Words& all) {
    const Status done = sonar_command(all);
    EXPECT_TRUE(done.ok()) << done.error().message;
    return done.ok() ? numbers_of(folder_ / "out" / "sonar.npy") : std::vector<double>();
  }
  nlohmann::json facts() {
    return parse_json(read_text(folder_ / "out" / "sonar.json").value()).value();
  }
  // Floats, [height][width][channels].
  void write_exr(const std::string& name, const std::vector<const char*>& channels,
                 const std::vector<float>& values) {
    Imf::Header header(kWidth, kHeight);
    Imf::FrameBuffer frame;
    const std::size_t stride = sizeof(float) * channels.size();
    for (std::size_t c = 0; c < channels.size(); ++c) {
      header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
      frame.insert(channels[c],
                   Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(&values[c])),
                              stride, stride * kWidth));
    }
    Imf::OutputFile out(file(name).c_str(), header);
    out.setFrameBuffer(frame);
    out.writePixels(kHeight);
  }
  std::string sensor(const std::string& text) {
    EXPECT_TRUE(write_text(folder_ / "sensor.toml", text).ok());
    return file("sensor.toml");
  }
  void expect_refused(const Words& all, const std::string& named) {
    const Status status = sonar_command(all);
    ASSERT_FALSE(status.ok()) << named;
    EXPECT_EQ(status.error().code, ErrorCode::kBadInput);
    EXPECT_NE(status.error().message.find(named), std::string::npos) << status.error().message;
    EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
  }
  Words images() {
    return {"--depth",     file("planar.npy"), "--normals",
            file("z.npy"), "--intrinsics",     "60,60,32,24"};
  }
  test::ScratchFolder folder_;
};

// Every convention by an imaging sonar, and by one of the other kinds in turn: all read images
// alike.
TEST_F(Wall, SoundsTheSameInEveryConvention) {
  const Words numbers{"--intrinsics", "60,60,32,24"};
  const Words conventions[] = {
      Words{"--depth", file("along.npy"), "--depth-kind", "range", "--normals", file("z.npy")} +
          numbers,
      Words{"--depth", file("mm.png"), "--depth-scale", "0.001", "--normals", file("z.npy")} +
          numbers,
      Words{"--depth", file("planar.npy"), "--normals", file("minus_z.npy"), "--axes", "opencv"} +
          numbers,
      Words{"--depth", file("planar.npy"), "--normals", file("minus_x.npy"), "--axes", "ros"} +
          numbers,
      Words{"--depth", file("planar.npy"), "--normals", file("minus_z.npy"), "--normals-sign",
            "unknown"} +
          numbers,
      Words{"--depth", file("planar.npy"), "--normals", file("coded.png"), "--gamma", "2.2"} +
          numbers,
      Words{"--depth", file("planar.npy")} + numbers,
      Words{"--depth", file("planar.npy"), "--normals", file("z.npy"), "--intrinsics",
            file("k.json")},
      Words{"--depth", file("planar.npy"), "--normals", file("z.npy"), "--intrinsics",
            "60,60,31.5,23.5", "--pixel-centers", "integer"}};
  for (std::size_t k = 0; k < std::size(kKinds); ++k) {
    const char* const kind = kKinds[k];
    const std::vector<double> expected = image(command(kind, images()));
    ASSERT_GT(sum(expected), 0.0) << kind;
    for (std::size_t i = 0; i < std::size(conventions); ++i) {
      if (k > 0 && 1 + i % 3 != k) continue;
      const Words& convention = conventions[i];
      const std::vector<double> found = image(command(kind, convention));
      ASSERT_EQ(found.size(), expected.size());
      EXPECT_NEAR(sum(found) / sum(expected), 1.0, 0.02) << kind << " " << convention[1];
    }
  }
}

// Oblique normals, another in every pixel, so that an axis that is turned wrongly is heard: bin by
// bin, from files of every kind.
TEST_F(Wall, OfObliqueNormalsSoundsTheSameInEveryConvention) {
  std::vector<float> opengl, opencv, ros;
  ImageU8 coded(kWidth, kHeight, 3);
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const Vec3 n = glm::normalize(
        Vec3(0.7 * std::sin(0.3 * (i % kWidth)), 0.7 * std::sin(1.0 + 0.4 * (i / kWidth)), 1.0));
    const auto x = static_cast<float>(n.x), y = static_cast<float>(n.y),
               z = static_cast<float>(n.z);
    opengl.insert(opengl.end(), {x, y, z});
    opencv.insert(opencv.end(), {x, -y, -z});
    ros.insert(ros.end(), {-z, -x, y});
    for (int k = 0; k < 3; ++k)
      coded.data[3 * i + k] = static_cast<std::uint8_t>(std::lround(255.0 * (n[k] + 1.0) / 2.0));
  }
  const std::vector<float> planar(kWidth * kHeight, static_cast<float>(kDepth_m));
  ASSERT_TRUE(write_npy(folder_ / "opengl.npy", opengl, {kHeight, kWidth, 3}).ok());
  ASSERT_TRUE(write_npy(folder_ / "opencv.npy", opencv, {kHeight, kWidth, 3}).ok());
  ASSERT_TRUE(write_npy(folder_ / "ros.npy", ros, {kHeight, kWidth, 3}).ok());
  ASSERT_TRUE(scene::write_png8(folder_ / "oblique.png", coded).ok());
  write_exr("depth.exr", {"Z"}, planar);
  write_exr("opencv.exr", {"X", "Y", "Z"}, opencv);
  const auto words = [&](const char* depth, const char* normals, const char* axes) {
    return Words{"--depth", file(depth), "--normals",    file(normals),
                 "--axes",  axes,        "--intrinsics", "60,60,32,24"};
  };
  for (const char* kind : kKinds) {
    const auto expected = image(command(kind, words("planar.npy", "opengl.npy", "opengl")));
    ASSERT_GT(sum(expected), 0.0) << kind;
    const auto differs = [&](const Words& all) {
      const std::vector<double> found = image(command(kind, all));
      double moved = 0.0;
      for (std::size_t i = 0; i < expected.size(); ++i) moved += std::abs(found[i] - expected[i]);
      return moved / sum(expected);
    };
    EXPECT_LT(differs(words("depth.exr", "opencv.exr", "opencv")), 1e-6) << kind;
    EXPECT_LT(differs(words("planar.npy", "ros.npy", "ros")), 1e-6) << kind;
    if (std::string(kind) != "imaging") continue;  // arrays and pictures are read alike for all
    EXPECT_LT(differs(words("planar.npy", "opencv.npy", "opencv")), 1e-6) << kind;
    EXPECT_LT(differs(words("planar.npy", "oblique.png", "opengl")), 0.03) << kind;  // 8 bits
  }
}

TEST_F(Wall, IsWhereEachKindHearsIt) {
  image(command("echosounder", images()));
  EXPECT_NEAR(facts()["echo"]["first_return_m"].get<double>(), kDepth_m, 3.0 / 200);
  image(command("profiling", images()));
  const std::vector<double> points = numbers_of(folder_ / "out" / "cloud.npy");
  ASSERT_GT(points.size(), 3u * 100u);
  for (std::size_t i = 0; i < points.size(); i += 3)
    ASSERT_NEAR(points[i + 2], -kDepth_m, 3.0 / 500) << i;
  image(command("sidescan", images() + Words{"--side", "starboard"}));
  EXPECT_NE(facts()["head"].get<std::string>().find("starboard"), std::string::npos);
}

TEST_F(Wall, SensorsBringTheirTerms) {
  const std::string plain = sensor(R"(kind = "imaging"
range_m = [1, 4]
azimuth_deg = 40
elevation_deg = 20
bins = [100, 50, 40]
)");
  const std::vector<double> cosine =
      image(Words{"imaging", "--out", file("out"), "--sensor", plain} + images());
  EXPECT_EQ(cosine.size(), 100u * 50u);
  const std::string terms = read_text(plain).value() + R"(frequency_hz = 400e3
level = { source_level_db = 200, tvg = 40 }
noise = { level_db = 40 }
beam = { azimuth = "sinc", azimuth_deg = 1.0 }
output = { bits = 8 }
)";
  const Words all = Words{"imaging", "--out", file("out"), "--sensor", sensor(terms)} + images();
  const std::vector<double> level = image(all);
  EXPECT_GT(sum(level), 1e6 * sum(cosine));  // powers of 1 uPa^2
  EXPECT_EQ(facts()["gather"], "plane");
  EXPECT_TRUE(facts()["terms"].contains("level"));
  EXPECT_TRUE(fs::exists(folder_ / "out" / "sonar_counts.npy"));
  EXPECT_EQ(image(all), level);  // noise and all
  EXPECT_NE(image(all + Words{"--seed", "2"}), level);
  // 6 dB less scattering is 6 dB less echo, where the echo is well above the noise.
  const auto strongest = [](const std::vector<double>& v) {
    return 10.0 * std::log10(*std::max_element(v.begin(), v.end()));
  };
  EXPECT_NEAR(strongest(level) - strongest(image(all + Words{"--backscatter-db", "-33"})), 6.0,
              0.1);
  // Flags win over the file.
  EXPECT_EQ(image(all + Words{"--bins", "60,30,20"}).size(), 60u * 30u);
}

// Half the view is empty: what is heard there is noise, and noise is no return.
TEST_F(Wall, NoiseIsNoReturnAndDetectionSaysWhatIs) {
  std::vector<float> half(kWidth * kHeight, static_cast<float>(kDepth_m));
  for (std::uint32_t i = 0; i < half.size(); ++i)
    if (i % kWidth < kWidth / 2) half[i] = std::numeric_limits<float>::infinity();
  const std::vector<float> nothing(half.size(), std::numeric_limits<float>::infinity());
  ASSERT_TRUE(write_npy(folder_ / "half.npy", half, {kHeight, kWidth}).ok());
  ASSERT_TRUE(write_npy(folder_ / "none.npy", nothing, {kHeight, kWidth}).ok());
  const std::string terms =
      "range_m = [1, 4]\nlevel = { source_level_db = 200 }\nnoise = { level_db = 60 }\n";
  const auto points = [&](const std::string& detection) {
    const std::string device =
        sensor("kind = \"profiling\"\nazimuth_deg = 40\nelevation_deg = 1\nbins = [300, 64, 8]\n" +
               terms + detection);
    image(Words{"profiling", "--out", file("out"), "--sensor", device, "--depth", file("half.npy"),
                "--normals", file("z.npy"), "--intrinsics", "60,60,32,24"});
    return numbers_of(folder_ / "out" / "cloud.npy");
  };
  for (const char* detection : {"", "detection = { threshold = 0.9, floor_db = 40 }\n"}) {
    const auto cloud = points(detection);
    EXPECT_NEAR(double(cloud.size()) / 3, 32.0, 1.0) << detection;
    for (std::size_t i = 0; i < cloud.size(); i += 3) EXPECT_NEAR(cloud[i + 2], -kDepth_m, 0.03);
  }
  EXPECT_TRUE(points("detection = { floor_db = 120 }\n").empty());
  const auto first_return = [&](const char* depth) {
    image(
        Words{"echosounder", "--out", file("out"), "--sensor",
              sensor("kind = \"echosounder\"\nsemi_angle_deg = 10\nbins = [300, 32, 32]\n" + terms),
              "--depth", file(depth), "--normals", file("z.npy"), "--intrinsics", "60,60,32,24"});
    return facts()["echo"]["first_return_m"];
  };
  EXPECT_NEAR(first_return("half.npy").get<double>(), kDepth_m, 0.02);
  EXPECT_TRUE(first_return("none.npy").is_null());
}

TEST_F(Wall, WhatImagesCannotGiveIsRefusedByName) {
  const std::string base = "kind = \"imaging\"\nbandwidth_hz = 30e3\n";
  const auto with = [&](const std::string& kind, const std::string& text) {
    return Words{kind, "--out", file("out"), "--sensor", sensor(text)} + images();
  };
  expect_refused(with("imaging", base + "ghosts = { surface = true }\n"), "ghosts");
  expect_refused(with("imaging", base + "motion = { within_ping = true }\n"), "motion");
  expect_refused(with("imaging", base + "labels = { energy = true, coco = true }\n"), "coco");
  expect_refused(with("imaging", base + "position_m = [0, 1, 0]\n"), "position_m");
  expect_refused(with("imaging", base + "rangem = [0, 1]\n"), "range_m");
  expect_refused(with("imaging", base + "foo = 1\n"), "nearest known key: name");
  expect_refused(with("imaging", base + "gather = \"published\"\n"), "sensor.toml: gather");
  expect_refused(with("profiling", base), "kind");
  expect_refused(with("imaging", "kind = \"mechanical\"\n"), "mechanical");
  expect_refused(with("imaging", base) + Words{"--method", "reference"}, "--method");
  expect_refused(with("imaging", base) + Words{"--gather", "published"}, "--gather");
  expect_refused(
      with("imaging", base + "labels = { energy = true }\n") + Words{"--gather", "nearest"},
      "labels.energy");
  expect_refused(with("imaging", base) + Words{"--azimuth", "-10,30"}, "--azimuth");
  expect_refused(command("mechanical", images()), "mechanical");
  expect_refused(command("echosounder", images() + Words{"--azimuth", "20", "--elevation", "10"}),
                 "--elevation");
  expect_refused(command("imaging", images() + Words{"--picture", "p.png"}), "--picture");
  expect_refused(command("imaging", images() + Words{"--method", "image"}), "sidescan");
  expect_refused(command("sidescan", images() + Words{"--method", "image"}), "--picture");
  expect_refused(command("imaging", {"--intrinsics", "60,60,32,24"}), "--depth");
  expect_refused(command("imaging", images() + Words{"--backscatter-db", "500"}),
                 "--backscatter-db");
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Wall, EnergyLabelsNameTheClassOfThePixels) {
  const std::vector<std::uint16_t> classes(kWidth * kHeight, 7);
  ASSERT_TRUE(
      write_npy(folder_ / "labels.npy", std::span<const std::uint16_t>(classes), {kHeight, kWidth})
          .ok());
  const std::string file_name = sensor(
      "kind = \"imaging\"\nrange_m = [1, 4]\nazimuth_deg = 40\nelevation_deg = 20\n"
      "bins = [100, 50, 40]\nlabels = { energy = true }\n");
  image(Words{"imaging", "--out", file("out"), "--sensor", file_name, "--labels",
              file("labels.npy")} +
        images());
  const auto labels = numbers_of(folder_ / "out" / "sonar_labels.npy");
  EXPECT_GT(std::count(labels.begin(), labels.end(), 7.0), 50);
  EXPECT_EQ(sum(numbers_of(folder_ / "out" / "sonar_instances.npy")), 0.0);
  // The code for shadow there is no class.
  const std::vector<std::uint16_t> shadows(kWidth * kHeight, std::uint16_t{65534});
  ASSERT_TRUE(
      write_npy(folder_ / "labels.npy", std::span<const std::uint16_t>(shadows), {kHeight, kWidth})
          .ok());
  expect_refused(Words{"imaging", "--out", file("out"), "--sensor", file_name, "--labels",
                       file("labels.npy")} +
                     images(),
                 "class 65534");
}

}  // namespace
}  // namespace neritic
