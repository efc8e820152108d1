// The presets of real devices in assets/sensors: well-formed, possible, and with their sources.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>

#include "engine/core/files.hpp"
#include "engine/core/math.hpp"
#include "engine/core/toml.hpp"
#include "engine/scene/scene.hpp"
#include "sonar/acoustics.hpp"
#include "sonar/acoustics_pulse.hpp"
#include "sonar/head.hpp"
#include "sonar/head_pattern.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;
constexpr double kSoundSpeed_m_s = 1500.0;

struct Preset {
  std::string name, text, kind;
  TomlValue values;

  double number(const char* key) const { return values.find(key)->value.number; }
  double item(const char* key, std::size_t i) const {
    return values.find(key)->value.items[i].number;
  }
  const TomlValue& beam(const char* key) const {
    return values.find("beam")->value.find(key)->value;
  }
  std::uint32_t bins(std::size_t i) const { return static_cast<std::uint32_t>(item("bins", i)); }
};

// Devices only: the published algorithm's defaults have no frequency.
std::vector<Preset> devices() {
  std::vector<Preset> found;
  for (const auto& entry : fs::directory_iterator(test::source_dir() / "assets" / "sensors")) {
    if (entry.path().extension() != ".toml" || entry.path().stem() == "imaging_90x28") continue;
    Preset preset;
    preset.name = entry.path().stem().string();
    preset.text = read_text(entry.path()).value();
    auto values = parse_toml(preset.text, preset.name, 0);
    EXPECT_TRUE(values.ok()) << values.error().message;
    preset.values = std::move(values).value();
    preset.kind = preset.values.find("kind")->value.text;
    found.push_back(std::move(preset));
  }
  return found;
}

// The device as a scene takes it.
scene::Sonar sonar_of(const std::string& preset) {
  const test::ScratchFolder folder;
  const auto file = folder / "scene.toml";
  EXPECT_TRUE(write_text(file, fmt::format("[[sonars]]\nname = \"sonar\"\ninclude = "
                                           "\"{}/assets/sensors/{}.toml\"\n",
                                           test::source_dir().string(), preset))
                  .ok());
  auto scene = scene::load_scene(file);
  EXPECT_TRUE(scene.ok()) << scene.error().message;
  return scene->sonars.at(0);
}

TEST(SonarPresets, CoverEveryKindAndTheNamedDevices) {
  std::map<std::string, std::string> kinds;
  for (const Preset& preset : devices()) kinds[preset.name] = preset.kind;
  for (const char* name :
       {"oculus_m750d", "oculus_m750d_high", "oculus_m1200d", "oculus_m1200d_high", "gemini_720is",
        "blueview_p900_45", "aris_explorer_3000", "aris_explorer_3000_low"})
    EXPECT_EQ(kinds[name], "imaging") << name;
  EXPECT_EQ(kinds["profiling_90x0_5"], "profiling");
  EXPECT_EQ(kinds["ping2"], "echosounder");
  EXPECT_EQ(kinds["starfish_450"], "sidescan");
  EXPECT_EQ(kinds["ping360"], "mechanical");
}

TEST(SonarPresets, HoldTheSameKeysAndNameTheirSources) {
  const std::set<std::string> keys = {"kind",          "range_m",      "azimuth_deg",
                                      "elevation_deg", "bins",         "rate_hz",
                                      "frequency_hz",  "bandwidth_hz", "beam"};
  for (const Preset& preset : devices()) {
    std::set<std::string> found;
    for (const auto& entry : preset.values.entries) found.insert(entry.key);
    found.erase("depression_deg");  // of side-scans only
    EXPECT_EQ(found, keys) << preset.name;
    for (const char* part : {"\n# Source: ", "\n# Published", "\n# Estimates: "})
      EXPECT_NE(preset.text.find(part), std::string::npos) << preset.name << part;
    const bool product = preset.text.find("not a product") == std::string::npos;
    EXPECT_EQ(preset.text.find("http") != std::string::npos, product) << preset.name;
  }
}

TEST(SonarPresets, ArePhysicallyPossible) {
  for (const Preset& preset : devices()) {
    SCOPED_TRACE(preset.name);
    const double nearest_m = preset.item("range_m", 0), farthest_m = preset.item("range_m", 1);
    EXPECT_LT(0.0, nearest_m);
    EXPECT_LT(nearest_m, farthest_m);
    // An echo is back before the next ping.
    EXPECT_LE(preset.number("rate_hz"), kSoundSpeed_m_s / (2 * farthest_m));
    EXPECT_LE(preset.bins(0), scene::kMaxSonarBins);
    EXPECT_LE(preset.bins(1), 512u);
    EXPECT_LE(preset.bins(2), 256u);
    const double frequency_hz = preset.number("frequency_hz");
    EXPECT_GE(frequency_hz, 100e3);
    EXPECT_LE(frequency_hz, 3e6);
    EXPECT_LE(preset.number("bandwidth_hz"), 0.3 * frequency_hz);
    // Absorption alone there and back, which a receiver of 120 dB could still bear.
    const double absorption =
        sonar::absorption_db_m(sonar::AbsorptionModel::kFrancoisGarrison, {}, frequency_hz);
    EXPECT_LT(2 * absorption * farthest_m, 60.0);
  }
}

TEST(SonarPresets, HearBeyondHalfPowerAndKeepThePulsesEnergy) {
  for (const Preset& preset : devices()) {
    SCOPED_TRACE(preset.name);
    const scene::Sonar sonar = sonar_of(preset.name);
    const auto heads = sonar::plan_heads(sonar);
    ASSERT_TRUE(heads.ok()) << heads.error().message;
    const auto patterns = sonar::head_patterns(sonar);
    ASSERT_TRUE(patterns.ok() && patterns->upright());
    for (const sonar::Head& head : *heads) {
      const sonar::Limits &gathered = head.samples.limits, &own = head.beams.limits;
      // The half-power width is the aperture; what is gathered ends at the second null, or where a
      // pinhole does: the first side lobe is heard.
      const double reach = std::min(patterns->upright()->second_null_rad(), radians(60.0));
      EXPECT_GE(gathered.elevation_max_rad, reach - head.samples.elevation_step_rad());
      EXPECT_NEAR(gathered.elevation_min_rad, -gathered.elevation_max_rad, 1e-12);
      EXPECT_NEAR(patterns->upright()->two_way_power(own.elevation_max_rad), 0.25, 1e-6);
      // "standard", which a sonar without a named quality has, samples no coarser than the bins.
      EXPECT_LE(head.samples.elevation_step_rad(),
                own.elevation_max_rad * 2 / preset.bins(2) + 1e-12);
      EXPECT_LE(head.samples.bins.elevation, 2800u);
    }
    const double resolution_m =
        sonar::range_resolution_m(kSoundSpeed_m_s, preset.number("bandwidth_hz"));
    const auto pulse = sonar::range_spread(sonar::PulseShape::kHann, resolution_m,
                                           heads->front().beams.range_step_m());
    ASSERT_TRUE(pulse.ok());
    EXPECT_LE(pulse->reach, 16u);
  }
}

}  // namespace
}  // namespace neritic
