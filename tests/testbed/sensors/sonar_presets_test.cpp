// The devices of assets/sensors in a scene, end to end: what their beams hear beyond half power.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "sonar/beam_pattern.hpp"
#include "sonar/detection.hpp"
#include "sonar/head.hpp"
#include "testbed/output/survey.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarPresets = test::GpuTest;

// A flat bottom at bottom_m and the device at depth 5 m; keys: more of its own.
Result<scene::Scene> over_a_flat_bottom(const std::filesystem::path& folder,
                                        const std::string& device, double bottom_m,
                                        const std::string& keys) {
  const auto file = folder / (device + ".toml");
  NERITIC_TRY_STATUS(write_text(
      file, fmt::format("[[objects]]\nname = \"bottom\"\nshape = \"plane\"\nsize_m = [400, 400]\n"
                        "class = \"seabed\"\nposition_m = [0, {}, 0]\n"
                        "[[sonars]]\nname = \"sonar\"\ninclude = \"{}/assets/sensors/{}.toml\"\n"
                        "position_m = [0, -5, 0]\n{}\n",
                        -bottom_m, test::source_dir().string(), device, keys)));
  return scene::load_scene(file);
}

std::vector<double> altitudes_of(gpu::Device& device, const scene::Scene& scene) {
  auto session = Session::create(device, scene);
  EXPECT_TRUE(session.ok()) << session.error().message;
  const test::ScratchFolder out;
  Survey survey((*session)->scene(), out.path());
  FrameRequest request;
  request.sonars = {0};
  request.capture = request.capture.without_geometry();
  for (request.frame = 0; request.frame < 5; ++request.frame) {
    request.time_s = request.frame * 0.2;
    auto result = (*session)->render(request);
    EXPECT_TRUE(result.ok()) << result.error().message;
    const Status added = survey.add(*result, request.frame, request.time_s);
    EXPECT_TRUE(added.ok()) << (added.ok() ? "" : added.error().message);
  }
  EXPECT_TRUE(survey.write({}).ok());
  auto npy = read_npy(out / "track" / "sonar" / "sidescan_altitude.npy");
  EXPECT_TRUE(npy.ok()) << npy.error().message;
  return npy->to_doubles();
}

// Down on the bottom at 5 m/min, by the device's own bins, pattern and pulse, in noise: the most
// that first and strongest return are off the true depth, in bins.
std::pair<double, double> most_off_on_the_way_down(gpu::Device& device, const scene::Scene& flat) {
  scene::Scene scene = flat;
  constexpr double kRate = 5.0 / 60.0, kBottom_m = 30.0;
  const Quat down = glm::angleAxis(-kPi / 2.0, Vec3(1, 0, 0));
  scene.sonars[0].mount.track = scene::Track{
      scene::places_of({{Vec3(0, -5.0, 0), Vec3(0, -25.0, 0)}, kRate, 0.0}), {{0.0, down}}};
  auto session = Session::create(device, scene);
  EXPECT_TRUE(session.ok()) << session.error().message;
  FrameRequest request;
  request.sonars = {0};
  request.capture = request.capture.without_geometry();
  double first = 0.0, strongest = 0.0;
  const std::uint32_t every = test::is_thorough() ? 1 : 4;
  for (request.frame = 0; request.frame < 60; request.frame += every) {
    request.time_s = request.frame * 3.7;
    auto result = (*session)->render(request);
    EXPECT_TRUE(result.ok()) << result.error().message;
    const SonarFrame& frame = result->sonars[0];
    sonar::EchoTrace trace(sonar::echo_trace_options(
        frame.grid, frame.terms, sonar::detection_floor(frame.terms.detection, frame.noise_power)));
    trace.append(frame.image.intensity, request.time_s, 0.0);
    const double truth = kBottom_m - 5.0 - kRate * request.time_s, bin = frame.grid.range_step_m();
    first = std::max(first, std::abs(trace.pings()[0].first_m - truth) / bin);
    strongest = std::max(strongest, std::abs(trace.pings()[0].strongest_m - truth) / bin);
  }
  return {first, strongest};
}

TEST_F(SonarPresets, AnEchoSounderComesDownWithinABinByPatternAndPulseInNoise) {
  const test::ScratchFolder scratch;
  for (const char* terms : {"", "level = { source_level_db = 200 }\nnoise = { level_db = 60 }",
                            "level = { source_level_db = 200 }\nnoise = { level_db = 60 }\n"
                            "bins = [600, 32, 32]"}) {
    NERITIC_ASSERT_OK(const scene::Scene scene,
                      over_a_flat_bottom(scratch.path(), "ping2", 30.0, terms));
    const auto [first, strongest] = most_off_on_the_way_down(device(), scene);
    EXPECT_LT(first, 1.0) << terms;
    EXPECT_LT(strongest, 1.0) << terms;
  }
  // Speckle's draws are loud and faint bins: what holds at every ping is three bins or so.
  NERITIC_ASSERT_OK(
      const scene::Scene scene,
      over_a_flat_bottom(
          scratch.path(), "ping2", 30.0,
          "level = { source_level_db = 200 }\nnoise = { level_db = 60 }\nspeckle = {}"));
  const auto [first, strongest] = most_off_on_the_way_down(device(), scene);
  EXPECT_LT(first, 3.0);
  EXPECT_LT(strongest, 4.0);
}

TEST_F(SonarPresets, ASideScansAltitudeIsTheBottomsHeight) {
  const test::ScratchFolder scratch;
  for (const char* terms :
       {"", "level = { source_level_db = 210 }",
        "level = { source_level_db = 210, tvg = 30, tvg_absorption = true }",
        "level = { source_level_db = 210, tvg = 30, tvg_absorption = true }\nspeckle = {}\n"
        "noise = { level_db = 60 }"}) {
    NERITIC_ASSERT_OK(
        const scene::Scene scene,
        over_a_flat_bottom(scratch.path(), "starfish_450", 15.0,
                           fmt::format("range_m = [1, 40]\nbins = [800, 8, 256]\n{}", terms)));
    const auto altitudes = altitudes_of(device(), scene);
    ASSERT_EQ(altitudes.size(), 5u);
    for (const double altitude : altitudes) EXPECT_NEAR(altitude, 10.0, 0.1) << terms;
  }
}

// Half a metre above a floor it is met at a degree. Rows that are too coarse lose parts of it,
// which then look like shadows. Decibels over the closed form, up to a constant of the beam's own:
// least and most over all beams and ranges from nearest_m on.
std::pair<double, double> spread_over_closed_form_db(const SonarFrame& frame, double height_m,
                                                     double nearest_m) {
  const auto pattern = sonar::BeamPattern::of_half_power_width(
      sonar::BeamShape::kSinc, frame.terms.beam.elevation->half_power_rad);
  EXPECT_TRUE(pattern.ok());
  const sonar::SonarImage& image = frame.image;
  double least = 1e9, most = -1e9;
  constexpr std::uint32_t kAveraged = 16;
  for (std::uint32_t row = 0; row + kAveraged <= image.n_range; row += kAveraged) {
    const double r = (frame.grid.range_m(row) + frame.grid.range_m(row + kAveraged - 1)) / 2.0;
    if (r < nearest_m) continue;
    // Lambert's mu cos^2(i) dA of a ring's piece r dr dphi, over r^4 and the water, there and back
    // through the pattern.
    const double down = height_m / r, beam = pattern->amplitude(std::asin(down));
    const double closed = std::pow(beam, 4) * down * down / (r * r * r) *
                          std::pow(10.0, -0.2 * *frame.absorption_db_per_m * r);
    for (std::uint32_t c = 0; c < image.n_azimuth; ++c) {
      double sum = 0.0;
      for (std::uint32_t i = 0; i < kAveraged; ++i)
        sum += image.intensity[std::size_t{row + i} * image.n_azimuth + c];
      const double db = 10.0 * std::log10(sum / kAveraged / closed);
      least = std::min(least, db);
      most = std::max(most, db);
    }
  }
  return {least, most};
}

TEST_F(SonarPresets, HalfAMetreAboveAFloorItIsWholeAndAsLoudAsItsClosedForm) {
  const test::ScratchFolder scratch;
  std::vector<const char*> names{"oculus_m750d", "oculus_m1200d_high", "gemini_720is",
                                 "aris_explorer_3000", "ping360"};
  if (test::is_thorough())
    names.insert(names.end(), {"oculus_m750d_high", "oculus_m1200d", "blueview_p900_45",
                               "aris_explorer_3000_low"});
  for (const char* name : names) {
    NERITIC_ASSERT_OK(scene::Scene scene, over_a_flat_bottom(scratch.path(), name, 5.5,
                                                             "level = { source_level_db = 210 }"));
    // A quarter of the beams, since each is held by itself.
    scene::Sonar& sonar = scene.sonars[0];
    if (const std::uint32_t beams = sonar.bins_azimuth / 4; beams > 0 && !test::is_thorough()) {
      sonar.azimuth_rad *= double(beams) / sonar.bins_azimuth;
      sonar.bins_azimuth = beams;
    }
    const auto frames = pings(device(), scene);
    ASSERT_EQ(frames.size(), 1u);
    // Within the half-power width, where the pattern is smooth over sixteen bins.
    const double nearest_m =
        0.5 / std::sin(frames[0].terms.beam.elevation->half_power_rad / 2.0) + 0.5;
    const auto [least, most] = spread_over_closed_form_db(frames[0], 0.5, nearest_m);
    EXPECT_LT(most - least, 1.0) << name << ": " << least << " to " << most << " dB";
  }
}

}  // namespace
}  // namespace neritic::testbed
