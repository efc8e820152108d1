// Sonars read the profile of the water's layers, unless they name water of their own.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "sonar/head_pattern.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kHalocline =
    "[water]\ntemperature_c = 20\nsalinity_psu = 0\n[[water.layers]]\ndepth_m = 6\nthickness_m = "
    "1\nsalinity_psu = 35\ntemperature_c = 10\n";

Result<scene::Scene> loaded(const std::string& text) {
  const test::ScratchFolder scratch;
  EXPECT_TRUE(write_text(scratch / "layers.toml", text).ok());
  return scene::load_scene(scratch / "layers.toml");
}

TEST(SonarLayers, AreTheSoundSpeedOfSonarsThatNameNoWaterOfTheirOwn) {
  const auto named = [&](const std::string& keys) {
    const auto scene = loaded(std::string(kHalocline) +
                              "[[sonars]]\nname = \"s\"\nposition_m = [0, -3, 0]\n" + keys);
    EXPECT_TRUE(scene.ok()) << scene.error().message;
    return scene->sonars[0];
  };
  const scene::Sonar own = named("water = { temperature_c = 4 }\n"), hears = named("");
  EXPECT_FALSE(own.terms.water.column.has_value());
  // Mackenzie's equation, by hand: 20 C, 0 psu, 3 m and 10 C, 35 psu, 20 m.
  EXPECT_NEAR(sonar::sound_speed_of(hears.terms.water, 3.0), 1481.787, 0.01);
  EXPECT_NEAR(sonar::sound_speed_of(hears.terms.water, 20.0), 1490.129, 0.01);
  const scene::Sonar bent = named("sound_speed = { profile = \"layers\", rays = \"bent\" }\n");
  ASSERT_TRUE(bent.terms.profile.has_value());
  for (const scene::SonarRow& row : bent.terms.profile->table)
    EXPECT_NEAR(row.y, sonar::sound_speed_of(hears.terms.water, row.x), 1e-9);
  EXPECT_GT(bent.terms.profile->table.size(), 33u);
}

TEST(SonarLayers, RefuseWhatNoWaterCanBe) {
  const auto refused = [&](const std::string& text, const char* words) {
    const auto scene = loaded(text);
    ASSERT_FALSE(scene.ok()) << text;
    EXPECT_NE(scene.error().message.find(words), std::string::npos) << scene.error().message;
  };
  const std::string water = "[water]\nsalinity_psu = 30\n";
  refused(water + "[[water.layers]]\ndepth_m = 5\nsalinity_psu = 10\n", "lighter than that above");
  refused(water + "[[water.layers]]\nsalinity_psu = 35\n", "no depth_m");
  refused(water + "[[water.layers]]\ndepth_m = 5\n[[water.layers]]\ndepth_m = 4\n",
          "a depth below that of the layer above");
  refused(water + "[[water.layers]]\ndepth_m = 5\nwavelength_m = [2, 1]\n", "shortest, longest");
  refused("[[sonars]]\nname = \"s\"\nsound_speed = { profile = \"layers\" }\n",
          "without any; accepted: [[water.layers]]");
  std::string many = water;
  for (int i = 1; i <= 5; ++i) many += fmt::format("[[water.layers]]\ndepth_m = {}\n", i);
  refused(many, "at most 4 tables");
}

}  // namespace
}  // namespace neritic::testbed
