// Golden images: every case of cases.json rendered and compared with its pictures here. A failure
// writes actual, golden and an amplified difference to build/.../golden/. NERITIC_UPDATE_GOLDEN=1
// (see tools/golden) writes the goldens anew.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "testbed/sensors/session.hpp"
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
  double time_s = 0.0, max_fraction = 0.0;
  int max_difference = 0;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.scene;
}  // for GoogleTest's listings

std::vector<Case> read_cases() {
  const auto text = read_text(kFolder / "cases.json");
  if (!text.ok()) return {};
  std::vector<Case> cases;
  const nlohmann::json listed = parse_json(*text).value();
  for (const nlohmann::json& entry : listed)
    cases.push_back({entry["name"], entry["scene"], entry.value("water", ""), entry["size"][0],
                     entry["size"][1], entry["time_s"], entry["max_fraction_of_pixels"],
                     entry["max_channel_difference"]});
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

void expect_like_golden(const ImageU8& actual, const std::string& name, const Case& c) {
  const fs::path golden_path = kFolder / (name + ".png");
  if (update_goldens()) {
    NERITIC_ASSERT_STATUS(scene::write_png8(golden_path, actual));
    return;
  }
  const auto read = scene::read_image8(golden_path, actual.channels);
  if (!read.ok() || read->width != actual.width || read->height != actual.height) {
    // Nothing to compare with: all of the picture differs.
    write_picture(name + ".actual.png", actual);
    write_picture(name + ".difference.png", actual);
    ADD_FAILURE() << name << ": "
                  << (read.ok() ? "the golden has another size" : read.error().message)
                  << "; see golden/" << name
                  << ".actual.png and .difference.png in the build folder";
    return;
  }
  const ImageU8& golden = *read;
  std::size_t off = 0;
  int worst = 0;
  ImageU8 difference(actual.width, actual.height, actual.channels);
  for (std::size_t pixel = 0; pixel < std::size_t{actual.width} * actual.height; ++pixel) {
    int most = 0;
    for (std::uint32_t ch = 0; ch < actual.channels; ++ch) {
      const std::size_t i = pixel * actual.channels + ch;
      const int d = std::abs(int(actual.data[i]) - int(golden.data[i]));
      most = std::max(most, d);
      difference.data[i] = static_cast<std::uint8_t>(std::min(255, d * 16));
    }
    worst = std::max(worst, most);
    off += most > c.max_difference;
  }
  const double fraction = double(off) / (double(actual.width) * actual.height);
  EXPECT_LE(fraction, c.max_fraction)
      << name << ": " << off << " pixels differ by more than " << c.max_difference << ", worst "
      << worst << "; see golden/" << name
      << ".actual.png, .golden.png and .difference.png in the build folder";
  if (fraction <= c.max_fraction) return;
  write_picture(name + ".actual.png", actual);
  write_picture(name + ".golden.png", golden);
  write_picture(name + ".difference.png", difference);
}

TEST(GoldenCases, CanBeRead) {
  ASSERT_FALSE(read_cases().empty());
}

TEST(GoldenCases, NameEveryScene) {
  std::set<std::string> named, there;
  for (const Case& c : read_cases()) named.insert(fs::path(c.scene).filename());
  for (const auto& entry : fs::directory_iterator(test::source_dir() / "assets/scenes"))
    if (entry.path().extension() == ".toml") there.insert(entry.path().filename());
  EXPECT_EQ(named, there);
}

TEST_P(Golden, SceneLooksAndSoundsAsItDid) {
  const Case& c = GetParam();
  NERITIC_ASSERT_OK(scene::Scene scene, scene::load_scene(test::source_dir() / c.scene));
  for (scene::Camera& camera : scene.cameras) camera.width = c.width, camera.height = c.height;
  if (!c.water.empty()) scene.water->type = c.water;
  FrameRequest request;
  request.time_s = c.time_s;
  request.next_time_s = c.time_s + 1.0 / 30.0;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) request.cameras.push_back(i);
  for (std::size_t i = 0; i < scene.sonars.size(); ++i) request.sonars.push_back(i);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  ASSERT_FALSE(result.cameras.empty() && result.sonars.empty());
  for (const CameraFrame& camera : result.cameras)
    for (std::size_t e = 0; e < camera.eyes.size(); ++e)
      expect_like_golden(camera.eyes[e].color, c.name + "." + camera.name + (e ? ".right" : ""), c);
  for (const SonarFrame& sonar : result.sonars) {
    const std::string name =
        c.name + "." + sonar.name + (sonar.head.empty() ? "" : "." + sonar.head);
    const ImageU8 grey = grey_sonar(sonar);
    expect_shades(grey, name);
    expect_like_golden(grey, name, c);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Golden, ::testing::ValuesIn(read_cases()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace neritic::tools
