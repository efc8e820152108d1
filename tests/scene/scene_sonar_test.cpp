// A sonar's kinds and terms: each key becomes its value in SI units, and what is not named stays
// off. Presets load by include.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/scene_materials.hpp"
#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

Sonar sonar_of(const test::ScratchFolder& scratch, const std::string& keys) {
  Scene scene = scene_of(scratch, "[[sonars]]\n" + keys);
  return scene.sonars.empty() ? Sonar{} : scene.sonars[0];
}

TEST(SceneSonar, NothingNamedIsThePublishedModel) {
  const test::ScratchFolder scratch;
  Sonar wanted;
  wanted.quality = "standard";
  wanted.quality_chosen = true;
  EXPECT_TRUE(same_settings(sonar_of(scratch, ""), wanted));
  wanted.bins_range = 501;
  EXPECT_FALSE(same_settings(sonar_of(scratch, ""), wanted));
}

TEST(SceneSonar, WhatNamesNoSamplingGetsStandardAndOneNoteSaysSo) {
  const test::ScratchFolder scratch;
  const std::string open = "[[sonars]]\n";
  Scene scene = scene_of(scratch, open + open);
  EXPECT_EQ(scene.sonars[1].quality, "standard");
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_THAT(scene.notes[0],
              ::testing::EndsWith("sonar, sonar_1: no quality is named, so \"standard\" it is; "
                                  "quality = \"draft\" is faster"));
  for (const char* named : {"quality = \"draft\"", "max_error = 0.05", "gbuffer_scale = 0.5",
                            "gather = \"plane\"", "beam = { samples = 1 }"}) {
    scene = scene_of(scratch, open + named);
    EXPECT_FALSE(scene.sonars[0].quality_chosen) << named;
    EXPECT_THAT(scene.notes, ::testing::IsEmpty()) << named;
  }
  scene = scene_of(scratch, open + open + open + open + open + "quality = \"reference\"\n");
  EXPECT_EQ(scene.sonars[0].quality, "draft");
  EXPECT_EQ(scene.sonars[4].quality, "reference");
  EXPECT_EQ(scene.notes.size(), 1u);
}

TEST(SceneSonar, AChosenLevelKnowsTheSmallestTarget) {
  const test::ScratchFolder scratch;
  const std::string things =
      "[[objects]]\nshape = \"sphere\"\nradius_m = 0.02\n"
      "[[objects]]\nname = \"rod\"\nshape = \"box\"\nsize_m = [0.01, 9, 0.01]\n"
      "[[objects.sonars]]\nname = \"own\"\n"
      "[[objects]]\nshape = \"sphere\"\nradius_m = 0.001\ncopies = [[1, 0, 0], [2, 0, 0]]\n"
      "[[objects]]\nshape = \"plane\"\nsize_m = [9, 9]\n";
  const Scene scene = scene_of(scratch, things + "[[sonars]]\nname = \"free\"\n");
  for (const Sonar& sonar : scene.sonars)
    EXPECT_NEAR(sonar.least_target_m, sonar.name == "free" ? 0.01 : 0.04, 1e-9) << sonar.name;
  EXPECT_EQ(
      scene_of(scratch, things + "[[sonars]]\nquality = \"draft\"\n").sonars[0].least_target_m,
      0.0);
}

TEST(SceneSonar, EmptyTermsHaveTheirDefaults) {
  const test::ScratchFolder scratch;
  const Sonar sonar =
      sonar_of(scratch,
               "water = {}\nlevel = {}\nbeam = {}\nrange_spread = {}\n"
               "speckle = {}\nnoise = {}\nlabels = {}\noutput = {}\ndetection = {}\n"
               "kind = \"profiling\"");
  SonarTerms wanted;
  wanted.level.emplace();
  wanted.range_spread.emplace();
  wanted.speckle.emplace();
  wanted.noise.emplace();
  EXPECT_EQ(sonar.terms, wanted);
}

TEST(SceneSonar, EveryTermCarriesItsValues) {
  const test::ScratchFolder scratch;
  const Sonar sonar = sonar_of(scratch, R"(
frequency_hz = 450e3
quality = "draft"
kind = "profiling"
[sonars.water]
temperature_c = -1.5
salinity_psu = 12
ph = 7.5
depth_m = 300
sound_speed_m_s = 1490
[sonars.level]
source_level_db = 210
absorption = "ainslie-mccolm"
spreading = false
tvg = 30
tvg_absorption = true
gain_db = -6
[sonars.beam]
azimuth = "hamming"
azimuth_deg = 0.5
elevation = "sinc"
elevation_deg = 20
samples = 4
steering = "flat"
two_way = true
[sonars.range_spread]
bandwidth_hz = 1e5
window = "none"
[sonars.speckle]
scatterer_m = 0.01
shape = 2.5
texture_m = 0.75
[sonars.noise]
level_db = 71
[sonars.ghosts]
surface = true
bottom_m = 25
surface_reflection = 0.9
bottom_reflection = 0.2
[sonars.sound_speed]
profile = [[0, 1520], [100, 1490.5]]
rays = "bent"
[sonars.motion]
within_ping = true
doppler = true
pulse_s = 2e-3
[sonars.labels]
energy = true
coco = true
[sonars.output]
bits = 16
floor_db = 20
span_db = 96
[sonars.detection]
threshold = 0.3
floor_db = 12
)");
  SonarTerms t;
  t.frequency_hz = 450e3;
  t.water = {-1.5, 12, 7.5, 300, 1490};
  t.level = SonarLevel{210, SonarLevel::Absorption::kAinslieMcColm, 0, false, 30, true, {}, -6};
  t.beam.azimuth = SonarPattern{BeamShape::kHamming, radians(0.5), {}};
  t.beam.elevation = SonarPattern{BeamShape::kSinc, radians(20.0), {}};
  t.beam.samples = 4;
  t.beam.steering = SonarBeam::Steering::kFlat;
  t.beam.two_way = true;
  t.range_spread = SonarRangeSpread{1e5, SonarRangeSpread::Window::kNone};
  t.speckle = SonarSpeckle{0.01, 2.5, 0.75};
  t.noise = SonarNoise{71};
  t.ghosts = SonarGhosts{true, 25, 0.9, 0.2};
  t.profile = SonarProfile{{{0, 1520}, {100, 1490.5}}, true};
  t.motion = SonarMotion{true, true, 2e-3};
  t.labels = {true, true};
  t.output = {16, 20, 96, true};
  t.detection.threshold = 0.3;
  t.detection.floor_db = 12;
  EXPECT_EQ(sonar.terms, t);
  EXPECT_EQ(sonar.quality, "draft");
  EXPECT_EQ(sonar.max_error, 0.0);
}

TEST(SceneSonar, NoiseIsOneLevelOrAmbientAndSelf) {
  const test::ScratchFolder scratch;
  const std::string level = "level = {}\nbandwidth_hz = 2e4\n";
  EXPECT_EQ(
      sonar_of(scratch, level + "noise = {wind_m_s = 12, shipping = 1, self_db = 55}").terms.noise,
      (SonarNoise{.wind_m_s = 12, .shipping = 1, .self_db = 55}));
  EXPECT_EQ(sonar_of(scratch, level + "noise = {level_db = 71}").terms.noise, SonarNoise{71});
}

TEST(SceneSonar, DetectionAndPatternsOfSomeKinds) {
  const test::ScratchFolder scratch;
  EXPECT_EQ(
      sonar_of(scratch, "kind = 'profiling'\ndetection = {quality = 0.4}").terms.detection.quality,
      0.4);
  EXPECT_EQ(sonar_of(scratch, "kind = 'sidescan'\ndetection = {pings = 9}").terms.detection.pings,
            9u);
  EXPECT_EQ(sonar_of(scratch, "kind = 'echosounder'\nbeam = {elevation = 'piston'}")
                .terms.beam.elevation->shape,
            BeamShape::kPiston);
}

TEST(SceneSonar, TablesComeFromFilesBesideTheScene) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "tvg.csv", "range_m,db\n1,0\n10,40\n").ok());
  ASSERT_TRUE(write_text(scratch / "beam.csv", "# measured\n0,0\n2,-3.5\n5,-40").ok());
  ASSERT_TRUE(write_text(scratch / "svp.csv", "0,1500\n30,1480.25").ok());
  const Sonar sonar = sonar_of(scratch, R"(
level = { tvg = "tvg.csv", absorption = 0.05 }
beam = { elevation = "beam.csv", azimuth = [[-3, -20], [0, 0], [3, -21]] }
sound_speed = { profile = "svp.csv" }
)");
  EXPECT_EQ(sonar.terms.level->tvg_table, (SonarTable{{1, 0}, {10, 40}}));
  EXPECT_EQ(sonar.terms.level->tvg_log, 0.0);
  EXPECT_EQ(sonar.terms.level->absorption, SonarLevel::Absorption::kFixed);
  EXPECT_EQ(sonar.terms.level->absorption_db_per_m, 0.05);
  EXPECT_EQ(sonar.terms.beam.elevation->shape, BeamShape::kTable);
  EXPECT_EQ(sonar.terms.beam.elevation->table,
            (SonarTable{{0, 0}, {radians(2.0), -3.5}, {radians(5.0), -40}}));
  EXPECT_EQ(sonar.terms.beam.azimuth->table,
            (SonarTable{{radians(-3.0), -20}, {0, 0}, {radians(3.0), -21}}));
  EXPECT_EQ(sonar.terms.profile->table, (SonarTable{{0, 1500}, {30, 1480.25}}));
  EXPECT_FALSE(sonar.terms.profile->bent);
}

TEST(SceneSonar, KindsHaveTheirAngles) {
  const test::ScratchFolder scratch;
  EXPECT_EQ(sonar_of(scratch, "kind = 'profiling'").kind, SonarKind::kProfiling);
  const Sonar echo = sonar_of(scratch, "kind = 'echosounder'\nsemi_angle_deg = 4\nazimuth_deg = 8");
  EXPECT_EQ(echo.kind, SonarKind::kEchoSounder);
  EXPECT_DOUBLE_EQ(echo.semi_angle_rad, radians(4.0));
  const Sonar side = sonar_of(scratch, "kind = 'sidescan'\ndepression_deg = 20");
  EXPECT_EQ(side.kind, SonarKind::kSideScan);
  EXPECT_DOUBLE_EQ(side.depression_rad, radians(20.0));
  const Sonar scan = sonar_of(scratch, "kind = 'mechanical'\nstep_deg = 1.8");
  EXPECT_EQ(scan.kind, SonarKind::kMechanical);
  EXPECT_DOUBLE_EQ(scan.step_rad, radians(1.8));
  EXPECT_DOUBLE_EQ(
      sonar_of(scratch, "kind = 'mechanical'\nazimuth_deg = 360\nbins = [9, 400, 9]").step_rad,
      radians(0.9));
  EXPECT_DOUBLE_EQ(sonar_of(scratch, "kind = 'mechanical'\nazimuth_deg = 360").step_rad,
                   radians(1.0));
  EXPECT_DOUBLE_EQ(sonar_of(scratch, "kind = 'mechanical'\nazimuth_deg = 0.5").step_rad,
                   radians(0.5));
  EXPECT_DOUBLE_EQ(sonar_of(scratch, "kind = 'mechanical'\nazimuth_deg = 9\nstep_deg = 9").step_rad,
                   radians(9.0));
}

TEST(SceneSonar, ADevicesBandwidthNamesItsRangeSpread) {
  const test::ScratchFolder scratch;
  EXPECT_EQ(sonar_of(scratch, "bandwidth_hz = 5e4").terms.range_spread,
            SonarRangeSpread{.bandwidth_hz = 5e4});
  EXPECT_EQ(
      sonar_of(scratch, "bandwidth_hz = 5e4\nrange_spread = {window = 'none'}").terms.range_spread,
      (SonarRangeSpread{5e4, SonarRangeSpread::Window::kNone}));
  EXPECT_EQ(sonar_of(scratch, "bandwidth_hz = 5e4\nrange_spread = {bandwidth_hz = 2e4}")
                .terms.range_spread->bandwidth_hz,
            2e4);
}

TEST(SceneSonar, ExtremesAreAccepted) {
  const test::ScratchFolder scratch;
  for (const char* keys :
       {"range_m = [0, 0.05]", "range_m = [0.05, 10000]", "azimuth_deg = 0.1", "azimuth_deg = 360",
        "bins = [500, 1, 1]", "bins = [500, 4096, 500]", "frequency_hz = 1", "frequency_hz = 1e7",
        "kind = 'echosounder'\nsemi_angle_deg = 60", "max_error = 1", "max_error = 0.02",
        "kind = 'sidescan'\ndepression_deg = 90", "level = {tvg = 'none', absorption = 'none'}",
        "level = {}\noutput = {bits = 8}"})
    sonar_of(scratch, keys);
}

TEST(SceneSonar, EveryPresetLoadsByInclude) {
  std::size_t loaded = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_dir() / "assets" / "sensors")) {
    if (entry.path().extension() != ".toml") continue;
    const test::ScratchFolder scratch;
    const Sonar sonar = sonar_of(scratch, "include = '" + entry.path().string() + "'");
    EXPECT_EQ(sonar.terms.beam.elevation.has_value(), entry.path().stem() != "imaging_90x28");
    ++loaded;
  }
  EXPECT_GE(loaded, 13u);
}

TEST(SceneSonar, ObjectsHaveAMaterialOrAStrength) {
  const test::ScratchFolder scratch;
  std::string text;
  for (const std::string_view name : kMaterialNames)
    text += fmt::format("[[objects]]\nshape = 'sphere'\nmaterial = '{}'\n", name);
  const Scene scene =
      scene_of(scratch, text + "[[objects]]\nshape = 'sphere'\nbackscatter_db = -27.5");
  for (std::size_t i = 0; i < kMaterialNames.size(); ++i) {
    EXPECT_EQ(scene.objects[i].material, kMaterialNames[i]);
    EXPECT_FALSE(scene.objects[i].backscatter_db);
  }
  EXPECT_EQ(scene.objects.back().backscatter_db, -27.5);
  EXPECT_EQ(scene.objects.back().material, "");
}

}  // namespace
}  // namespace neritic::scene
