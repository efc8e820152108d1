// Goldens: every case of cases.json rendered and compared with what lies here: pictures, the sums
// of sonars, and the state's hash where physics moves the scene. A failure writes actual, golden
// and an amplified difference to build/.../golden/. NERITIC_UPDATE_GOLDEN=1 (see tools/golden)
// writes the goldens anew.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "testbed/instruments/wrist_displays.hpp"
#include "testbed/loop/loop.hpp"
#include "tests/golden/compare.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = test::source_dir() / "tests" / "golden";

struct Case {
  std::string name, scene, water;
  std::uint32_t width = 0, height = 0;
  double time_s = 0.0;
  bool physics = false;
  test::PictureLimits limits;
  // Cameras that accept larger patches in the diver's pixels (README.md).
  std::map<std::string, std::size_t> diver_patch_px;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.scene;
}  // for GoogleTest's listings

std::vector<Case> read_cases() {
  const auto text = read_text(kFolder / "cases.json");
  if (!text.ok()) return {};
  std::vector<Case> cases;
  const nlohmann::json file = parse_json(*text).value();
  const nlohmann::json& limits = file["limits"];
  for (const nlohmann::json& entry : file["cases"])
    cases.push_back({entry["name"],
                     entry["scene"],
                     entry.value("water", ""),
                     entry["size"][0],
                     entry["size"][1],
                     entry["time_s"],
                     entry.value("physics", false),
                     {limits["level"], limits["fraction_of_pixels"], limits["mean_difference"],
                      limits["patch_pixels"]},
                     entry.value("diver_patch_pixels", std::map<std::string, std::size_t>{})});
  return cases;
}

class Golden : public test::GpuTest, public ::testing::WithParamInterface<Case> {
 protected:
  // The pictures were made by Mesa's CPU driver: they are compared on it where it is present.
  static void SetUpTestSuite() {
    const auto devices = gpu::list_devices();
    if (!devices.ok()) return;
    for (const gpu::DeviceInfo& device : *devices)
      if (device.usable && device.name.find("llvmpipe") != std::string::npos)
        ::setenv("NERITIC_TEST_DEVICE", "llvmpipe", 0);
  }
};

void write_picture(const std::string& file, const ImageU8& image) {
  const fs::path folder = fs::path(NERITIC_BINARY_DIR) / "golden";
  NERITIC_ASSERT_STATUS(make_folder(folder));
  NERITIC_ASSERT_STATUS(scene::write_png8(folder / file, image));
}

// As grey: of a level its decibels, 1.5 a grey level up to 140 dB re 1 uPa; of the plain cosine
// 1/16 and more is white, with a square root so that weak echoes show.
ImageU8 grey_sonar(const SonarFrame& frame) {
  const sonar::SonarImage& image = frame.image;
  ImageU8 out(image.n_azimuth, image.n_range, 1);
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const double power = image.intensity[i];
    const double part = !frame.level  ? std::sqrt(std::min(16.0 * power, 1.0))
                        : power > 0.0 ? std::clamp(10.0 * std::log10(power) / 140.0, 0.0, 1.0)
                                      : 0.0;
    out.data[i] = static_cast<std::uint8_t>(std::lround(255.0 * part));
  }
  return out;
}

// A picture of so few values would be matched by nearly anything.
void expect_shades(const ImageU8& grey, const std::string& name) {
  EXPECT_GE(std::set<std::uint8_t>(grey.data.begin(), grey.data.end()).size(), 8u) << name;
}

bool update_goldens() {
  const char* update = std::getenv("NERITIC_UPDATE_GOLDEN");
  return update && std::string(update) == "1";
}

// The difference 16 times amplified, so that one level shows.
ImageU8 amplified_difference(const ImageU8& actual, const ImageU8& golden) {
  ImageU8 out(actual.width, actual.height, actual.channels);
  for (std::size_t i = 0; i < out.data.size(); ++i)
    out.data[i] = static_cast<std::uint8_t>(
        std::min(255, 16 * std::abs(int(actual.data[i]) - int(golden.data[i]))));
  return out;
}

// sensor: the part of name that says whose picture it is.
void expect_like_golden(const ImageU8& actual, const std::string& sensor, const Case& c,
                        const std::vector<bool>& diver = {}) {
  const std::string name = c.name + "." + sensor;
  const fs::path golden_path = kFolder / (name + ".png");
  if (update_goldens()) {
    NERITIC_ASSERT_STATUS(scene::write_png8(golden_path, actual));
    return;
  }
  const auto read = scene::read_image8(golden_path, actual.channels);
  if (!read.ok() || read->width != actual.width || read->height != actual.height) {
    write_picture(name + ".actual.png", actual);
    ADD_FAILURE() << name << ": "
                  << (read.ok() ? "the golden has another size" : read.error().message)
                  << "; see golden/" << name << ".actual.png in the build folder";
    return;
  }
  test::PictureLimits limits = c.limits;
  if (const auto own = c.diver_patch_px.find(sensor); own != c.diver_patch_px.end())
    limits.masked_patch_px = own->second;
  const auto faults =
      test::faults_of(test::difference_of(actual, *read, limits.level, diver), limits);
  if (faults.empty()) return;
  for (const std::string& fault : faults) ADD_FAILURE() << name << ": " << fault;
  write_picture(name + ".actual.png", actual);
  write_picture(name + ".golden.png", *read);
  write_picture(name + ".difference.png", amplified_difference(actual, *read));
}

// The sums of each sonar and, of a case with physics, step and hash of the state.
void expect_like_golden_numbers(const nlohmann::json& actual, const Case& c) {
  if (actual["state"].is_null() && actual["sonars"].empty()) return;
  const fs::path path = kFolder / (c.name + ".json");
  if (update_goldens()) {
    NERITIC_ASSERT_STATUS(write_text(path, json_text(actual, -1) + "\n"));
    return;
  }
  NERITIC_ASSERT_OK(const std::string text, read_text(path));
  NERITIC_ASSERT_OK(const nlohmann::json golden, parse_json(text));
  EXPECT_EQ(actual["state"], golden["state"]) << c.name;
  ASSERT_EQ(actual["sonars"].size(), golden["sonars"].size()) << c.name;
  for (const auto& [sonar, sums] : actual["sonars"].items()) {
    ASSERT_TRUE(golden["sonars"].contains(sonar)) << c.name << "." << sonar;
    for (const std::string& fault :
         test::faults_of(test::sums_from(sums), test::sums_from(golden["sonars"][sonar]), {}))
      ADD_FAILURE() << c.name << "." << sonar << ": " << fault;
  }
}

class LastFrame final : public FrameSink {
 public:
  Status accept(const FrameResult& frame) override {
    result = frame;
    return {};
  }
  Status finish() override { return {}; }
  FrameResult result;
};

TEST(GoldenCases, CanBeRead) {
  ASSERT_FALSE(read_cases().empty());
}

TEST(GoldenCases, NameEveryScene) {
  std::set<std::string> named, there;
  for (const Case& c : read_cases()) named.insert(fs::path(c.scene).filename());
  for (const auto& entry : fs::directory_iterator(test::source_dir() / "assets/scenes"))
    if (entry.path().extension() == ".toml") there.insert(entry.path().filename());
  there.erase("talk.toml");  // dive.toml with modems and a buoy
  EXPECT_EQ(named, there);
}

// At least: a mission, a dive, an uncontrolled ascent.
TEST(GoldenCases, RunPhysics) {
  std::size_t run = 0;
  for (const Case& c : read_cases()) run += c.physics;
  EXPECT_GE(run, 3u);
}

TEST_P(Golden, SceneLooksAndSoundsAsItDid) {
  const Case& c = GetParam();
  NERITIC_ASSERT_OK(scene::Scene scene, scene::load_scene(test::source_dir() / c.scene));
  std::uint16_t diver = 0;
  for (const auto& [id, name] : scene.class_names)
    if (name == "diver") diver = id;
  for (scene::Camera& camera : scene.cameras) camera.width = c.width, camera.height = c.height;
  if (!c.water.empty()) scene.water->type = c.water;
  LoopSensors sensors;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) sensors.cameras.push_back(i);
  for (std::size_t i = 0; i < scene.sonars.size(); ++i) sensors.sonars.push_back(i);
  nlohmann::json numbers{{"state", nullptr}, {"sonars", nlohmann::json::object()}};
  std::unique_ptr<LivePhysics> physics;
  if (c.physics) {
    NERITIC_ASSERT_OK(physics, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
    physics->reach(c.time_s);
    const auto& state = physics->newest();
    numbers["state"] = {{"step", state.step}, {"hash", fmt::format("{:016x}", state.hash)}};
  }
  const auto displays = wrist_displays(physics.get(), hud::Units::kMetric);
  NERITIC_ASSERT_OK(const auto session,
                    Session::create(device(), std::move(scene), picture_places(displays.get())));
  sensors.session = session.get();
  LastFrame last;
  Loop loop({.clock = Clock::simulated(c.time_s, 1.0 / 30.0),
             .physics = physics.get(),
             .sensors = sensors,
             .pictures = displays.get(),
             .frame_sinks = {&last},
             .stop = {.frames = 1}});
  NERITIC_ASSERT_STATUS(loop.run());
  const FrameResult& result = last.result;
  ASSERT_FALSE(result.cameras.empty() && result.sonars.empty());
  for (const CameraFrame& camera : result.cameras)
    for (std::size_t e = 0; e < camera.eyes.size(); ++e)
      expect_like_golden(camera.eyes[e].color, camera.name + (e ? ".right" : ""), c,
                         test::mask_of(camera.eyes[e].labels, diver));
  for (const SonarFrame& sonar : result.sonars) {
    const std::string name = sonar.name + (sonar.head.empty() ? "" : "." + sonar.head);
    const ImageU8 grey = grey_sonar(sonar);
    expect_shades(grey, c.name + "." + name);
    expect_like_golden(grey, name, c);
    numbers["sonars"][name] = test::to_json(
        test::sums_of(sonar.image.intensity, sonar.image.n_range, sonar.image.n_azimuth));
  }
  expect_like_golden_numbers(numbers, c);
}

// Suites whose cases share a process, and with it the device's pipelines, which cost half of a
// case: those of quick runs, and the others, which ctest begins beside suites as long.
std::vector<Case> cases_of(bool of_quick_runs) {
  std::vector<Case> cases = read_cases();
  std::erase_if(cases, [&](const Case& c) {
    return (c.name == "wreck" || c.name == "sonars" || c.name == "dive") != of_quick_runs;
  });
  return cases;
}
std::string case_name(const ::testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(QuickCases, Golden, ::testing::ValuesIn(cases_of(true)), case_name);
INSTANTIATE_TEST_SUITE_P(Cases, Golden, ::testing::ValuesIn(cases_of(false)), case_name);

}  // namespace
}  // namespace neritic::tools
