// The rays that `neritic tradeoff sonar` holds every term against, against closed forms, and the
// tables it writes of a kind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "engine/core/files.hpp"
#include "engine/gpu/device.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/support/support.hpp"
#include "tools/tradeoff/sonar_tradeoff.hpp"
#include "tools/tradeoff/term_judges.hpp"
#include "tools/tradeoff/term_truth.hpp"

namespace neritic::tools {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

std::unique_ptr<RayWorld> world_of(scene::Model model, const Vec3& at, double backscatter_db) {
  scene::Scene scene;
  scene.models.push_back(std::make_shared<scene::Model>(std::move(model)));
  scene::Object object;
  object.model = 0;
  object.mount.pose.position_m = at;
  object.backscatter_db = backscatter_db;
  scene.objects.push_back(object);
  auto world = make_triangle_world(flatten(scene, 0.0, Pose{}));
  return world.ok() ? std::move(*world) : nullptr;
}

scene::Sonar sonar_of(double range_min_m, double range_max_m, std::uint32_t bins) {
  scene::Sonar sonar;
  sonar.range_min_m = range_min_m;
  sonar.range_max_m = range_max_m;
  sonar.azimuth_rad = sonar.elevation_rad = radians(20.0);
  sonar.bins_range = bins;
  sonar.bins_azimuth = 32;
  sonar.terms.water.sound_speed_m_s = 1500.0;
  return sonar;
}

TermTruth trace(const RayWorld& world, const scene::Sonar& sonar, const TruthView& view = {}) {
  const auto truths = trace_terms(world, view, std::span(&sonar, 1), 0, {4.0, 12.0, 512});
  EXPECT_TRUE(truths.ok()) << truths.error().message;
  return truths.ok() ? truths->front() : TermTruth{};
}

double total(const TermTruth& t) {
  return std::accumulate(t.image.begin(), t.image.end(), 0.0);
}

double mean_range_m(const TermTruth& t) {
  double weighted = 0.0;
  for (std::size_t i = 0; i < t.image.size(); ++i)
    weighted += t.image[i] * t.grid.range_m(static_cast<std::uint32_t>(i / t.grid.bins.azimuth));
  return weighted / total(t);
}

TEST(TermTruth, ALambertWallSendsBackItsClosedForm) {
  const auto world = world_of(scene::make_box({60.0, 60.0, 1.0}), {0.0, 0.0, -10.5}, -27.0);
  scene::Sonar sonar = sonar_of(8.0, 14.0, 600);
  sonar.terms.level = scene::SonarLevel{.absorption = scene::SonarLevel::Absorption::kFixed,
                                        .absorption_db_per_m = 0.3};
  // mu SL times the integral of cos(i) / r^2 10^(-2 alpha r / 10), cos i = cos theta cos phi.
  double expected = 0.0;
  constexpr int kSteps = 400;
  const double step = radians(20.0) / kSteps;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double theta = radians(-10.0) + (i + 0.5) * step;
      const double phi = radians(-10.0) + (j + 0.5) * step;
      const double cosine = std::cos(theta) * std::cos(phi), r = 10.0 / cosine;
      expected += cosine / (r * r) * std::pow(10.0, -0.06 * r) * std::cos(phi) * step * step;
    }
  expected *= std::pow(10.0, 20.0 - 2.7);
  EXPECT_NEAR(total(trace(*world, sonar)) / expected, 1.0, 1e-4);
}

TEST(TermTruth, PatternsAndPulseKeepAWallsEnergy) {
  const auto world = world_of(scene::make_box({60.0, 60.0, 1.0}), {0.0, 0.0, -10.5}, -27.0);
  scene::Sonar sonar = sonar_of(8.0, 14.0, 600);
  const double plain = total(trace(*world, sonar));
  sonar.terms.range_spread = scene::SonarRangeSpread{};
  EXPECT_NEAR(total(trace(*world, sonar)) / plain, 1.0, 1e-3);
  sonar.terms.beam.azimuth =
      scene::SonarPattern{.shape = scene::BeamShape::kHamming, .half_power_rad = radians(1.0)};
  EXPECT_NEAR(total(trace(*world, sonar)) / plain, 1.0, 2e-3);
}

TEST(TermTruth, AConeHearsTheMeanCosineOfItsDisc) {
  const auto world = world_of(scene::make_box({60.0, 60.0, 1.0}), {0.0, 0.0, -10.5}, -27.0);
  scene::Sonar sonar = sonar_of(8.0, 14.0, 600);
  sonar.kind = scene::SonarKind::kEchoSounder;
  sonar.semi_angle_rad = radians(12.5);
  EXPECT_NEAR(total(trace(*world, sonar)), (1.0 + std::cos(radians(12.5))) / 2.0, 1e-3);
}

TEST(TermTruth, AGhostComesAtTheMeanOfBothWays) {
  const auto world = world_of(scene::make_sphere(0.1, 64), {0.0, 0.0, -5.0}, -27.0);
  scene::Sonar sonar = sonar_of(4.0, 8.0, 800);
  sonar.elevation_rad = radians(100.0);
  TruthView view;
  view.depth_m = 2.0;
  const TermTruth plain = trace(*world, sonar, view);
  sonar.terms.ghosts = scene::SonarGhosts{.surface = true};
  const TermTruth ghosts = trace(*world, sonar, view);
  const double more = total(ghosts) - total(plain);
  ASSERT_GT(more, 0.1 * total(plain));
  const double range =
      (mean_range_m(ghosts) * total(ghosts) - mean_range_m(plain) * total(plain)) / more;
  EXPECT_NEAR(range, (4.9 + std::hypot(5.0, 4.0) - 0.1) / 2.0, 0.05);
}

TEST(TermTruth, HeardRangesFollowTheProfileAndTheMotion) {
  const auto world = world_of(scene::make_box({60.0, 60.0, 1.0}), {0.0, 0.0, -10.5}, -27.0);
  scene::Sonar sonar = sonar_of(9.0, 11.0, 2000);
  sonar.azimuth_rad = sonar.elevation_rad = radians(1.0);
  const double still = mean_range_m(trace(*world, sonar));
  for (const bool bent : {false, true}) {
    sonar.terms.profile = scene::SonarProfile{{{0.0, 1530.0}, {90.0, 1530.0}}, bent};
    EXPECT_NEAR(mean_range_m(trace(*world, sonar)) / still, 1500.0 / 1530.0, 1e-4);
  }
  sonar.terms.profile.reset();
  sonar.terms.motion = scene::SonarMotion{.within_ping = true};
  TruthView view;
  view.velocity_m_s = {0.0, 0.0, -15.0};
  // Out r, back to where the sonar is by then: 2 r / (c + v).
  EXPECT_NEAR(mean_range_m(trace(*world, sonar, view)) / still, 1500.0 / 1515.0, 1e-4);
}

// A ray's pattern counts where it leaves, atan(r g / 2 c) below the line to a point level with the
// sonar in a gradient g.
TEST(TermTruth, ABentRaysPatternIsThatOfWhereItLeaves) {
  const auto world = world_of(scene::make_sphere(0.4, 64), {0.0, 0.0, -80.0}, -27.0);
  scene::Sonar sonar = sonar_of(70.0, 90.0, 100);
  sonar.azimuth_rad = radians(4.0);
  sonar.terms.beam.elevation = scene::SonarPattern{.half_power_rad = radians(7.0)};
  sonar.terms.profile = scene::SonarProfile{{{0.0, 1250.0}, {200.0, 1750.0}}, false};
  TruthView view;
  view.depth_m = 100.0;
  const double straight = total(trace(*world, sonar, view));
  sonar.terms.profile->bent = true;
  const double leaves_rad = std::atan(80.0 * 2.5 / 3000.0);
  const auto pattern =
      sonar::BeamPattern::of_half_power_width(sonar::BeamShape::kSinc, radians(7.0));
  ASSERT_TRUE(pattern.ok());
  EXPECT_NEAR(total(trace(*world, sonar, view)) / straight, pattern->two_way_power(leaves_rad),
              0.03 * pattern->two_way_power(leaves_rad));
  view.world_from_head = glm::mat3_cast(glm::angleAxis(-leaves_rad, Vec3(1, 0, 0)));
  EXPECT_NEAR(total(trace(*world, sonar, view)) / straight, 1.0, 0.03);
}

TEST(TermJudges, SpeckleMomentsOfAnExponentialAreRayleighs) {
  std::vector<float> smooth(20000, 2.0f), speckled;
  for (std::size_t i = 0; i < smooth.size(); ++i)  // its quantiles
    speckled.push_back(static_cast<float>(-2.0 * std::log((i + 0.5) / 20000.0)));
  SpeckleMoments moments;
  moments.add(speckled, smooth);
  EXPECT_NEAR(moments.found().contrast, kRayleighContrast, 1e-3);
  EXPECT_NEAR(moments.found().mean, 1.0, 1e-3);
  EXPECT_NEAR(moments.found().departure, 2.0 / std::exp(1.0), 1e-3);
}

TEST(TradeoffSonar, WritesAKindsKnobsTermsAndPicture) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  SonarTradeoffOptions options;
  options.scene = test::source_dir() / "assets/scenes/harbour.toml";
  options.quick = true;
  options.kind = "echosounder";
  std::uint64_t done = 0;
  options.step = [&] { ++done; };
  std::vector<std::string> doing, parts;
  options.now = [&](const std::string& what) { doing.push_back(what); };
  const test::ScratchFolder folder;
  options.part_done = [&](const std::string& part, const SonarTradeoff& so_far) -> Status {
    parts.push_back(part);
    const auto drawn = write_last_kind(folder.path(), so_far);
    return drawn.ok() ? Status() : Status(drawn.error());
  };
  const auto tradeoff = run_sonar_tradeoff(options);
  ASSERT_TRUE(tradeoff.ok()) << tradeoff.error().message;
  EXPECT_EQ(done, steps(options));
  EXPECT_EQ(parts, std::vector<std::string>{"echosounder"});
  EXPECT_THAT(doing, Contains(HasSubstr("echosounder, gbuffer_scale 0.25")));
  EXPECT_THAT(doing, Contains(HasSubstr("search for the levels")));
  ASSERT_EQ(tradeoff->kinds.size(), 1u);
  for (const KindPoint& p : tradeoff->kinds[0].points) {
    EXPECT_LT(p.error, 0.2) << p.sweep << " " << p.setting;
    EXPECT_GT(p.ms(), 0.0) << p.sweep << " " << p.setting;
  }
  for (const TermPoint& p : tradeoff->kinds[0].terms)
    if (p.term == "range spread" || p.term == "elevation pattern" || p.term == "level") {
      EXPECT_LT(p.error_with, 0.3 * p.error_without) << p.term;
    }
  for (const char* name : {"echosounder.csv", "echosounder_terms.csv", "echosounder.png",
                           "quality.json", "tradeoff.md"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  // A quick run names no levels, and says why.
  const auto text = read_text(folder / "tradeoff.md"), levels = read_text(folder / "quality.json");
  ASSERT_TRUE(text.ok() && levels.ok());
  EXPECT_THAT(*text, HasSubstr("Made with --quick"));
  EXPECT_THAT(*text, Not(HasSubstr("none")));
  EXPECT_THAT(*levels, Not(HasSubstr("draft")));
}

}  // namespace
}  // namespace neritic::tools
