// Named quality levels: what they set, what they leave, what they refuse.
#include "sonar/quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "engine/scene/sonar_file.hpp"
#include "sonar/beam_pattern.hpp"
#include "sonar/head.hpp"
#include "tests/support/support.hpp"

namespace neritic::sonar {
namespace {

using scene::SonarKind;

constexpr SonarKind kKinds[] = {SonarKind::kImaging, SonarKind::kProfiling, SonarKind::kEchoSounder,
                                SonarKind::kSideScan, SonarKind::kMechanical};

scene::Sonar sonar_of(SonarKind kind) {
  scene::Sonar sonar;
  sonar.name = "ears";
  sonar.kind = kind;
  sonar.range_min_m = 1.0;
  sonar.range_max_m = 16.0;
  sonar.bins_range = 5000;
  sonar.terms.range_spread = scene::SonarRangeSpread{};
  if (kind != SonarKind::kEchoSounder)
    sonar.terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(1.0)};
  return sonar;
}

TEST(SonarQuality, EveryMeasuredKindHasThreeLevelsUnderTheirBounds) {
  for (const SonarKind kind : kKinds) {
    const auto levels = quality_levels(kind);
    ASSERT_EQ(levels.size(), 3u) << scene::name_of(kind);
    const double bounds[] = {0.05, 0.02, 0.01};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(levels[i].error, bounds[i]) << scene::name_of(kind) << " " << levels[i].name;
      EXPECT_GT(levels[i].error, 0.0);
      if (i > 0) {
        EXPECT_GE(levels[i].ms, levels[i - 1].ms) << scene::name_of(kind);
      }
    }
  }
}

TEST(SonarQuality, WithoutANameNothingChanges) {
  for (const SonarKind kind : kKinds) {
    scene::Sonar sonar = sonar_of(kind);
    const scene::Sonar before = sonar;
    ASSERT_TRUE(apply_quality(sonar).ok());
    EXPECT_TRUE(scene::same_settings(before, sonar));
  }
}

TEST(SonarQuality, ALevelFillsWhatIsUnsetAndCanBePlanned) {
  for (const SonarKind kind : kKinds)
    for (const QualityLevel& level : quality_levels(kind)) {
      scene::Sonar sonar = sonar_of(kind);
      sonar.quality = level.name;
      const Status status = apply_quality(sonar);
      ASSERT_TRUE(status.ok()) << status.error().message;
      EXPECT_EQ(sonar.gbuffer_scale, level.gbuffer_scale);
      EXPECT_NE(sonar.bins_elevation, 500u);
      sonar.quality.clear();  // applied
      EXPECT_TRUE(plan_heads(sonar).ok()) << scene::name_of(kind) << " " << level.name;
    }
}

TEST(SonarQuality, ALevelWinsAndASecondTimeChangesNothing) {
  for (const SonarKind kind : kKinds) {
    scene::Sonar sonar = sonar_of(kind);
    sonar.quality = "standard";
    sonar.gbuffer_scale = 0.3;
    sonar.bins_elevation = 7777;
    ASSERT_TRUE(apply_quality(sonar).ok());
    EXPECT_NE(sonar.gbuffer_scale, 0.3);
    EXPECT_NE(sonar.bins_elevation, 7777u);
    const scene::Sonar once = sonar;
    ASSERT_TRUE(apply_quality(sonar).ok());
    EXPECT_TRUE(scene::same_settings(once, sonar)) << scene::name_of(kind);
  }
}

// A one-way pattern of that half-power width as a table of decibels, by its closed form.
scene::SonarPattern table_of(double half_power_rad) {
  const auto line = BeamPattern::of_half_power_width(BeamShape::kSinc, half_power_rad);
  EXPECT_TRUE(line.ok());
  scene::SonarPattern pattern{.shape = scene::BeamShape::kTable, .table = {}};
  for (int i = 0; i <= 40; ++i) {
    const double theta = i / 40.0 * half_power_rad;
    pattern.table.push_back({theta, 20.0 * std::log10(line->amplitude(theta))});
  }
  return pattern;
}

TEST(SonarQuality, ASecondTimeChangesNothingWhateverThePattern) {
  using Shape = scene::BeamShape;
  for (const SonarKind kind : kKinds)
    for (const QualityLevel& level : quality_levels(kind))
      for (const double width_deg : {0.3, 2.0, 40.0})
        for (const Shape shape : {Shape::kSinc, Shape::kHamming, Shape::kPiston, Shape::kTable}) {
          scene::Sonar sonar = sonar_of(kind);
          sonar.quality = level.name;
          sonar.terms.beam.azimuth =
              shape == Shape::kTable
                  ? table_of(radians(width_deg))
                  : scene::SonarPattern{
                        .shape = shape, .half_power_rad = radians(width_deg), .table = {}};
          ASSERT_TRUE(apply_quality(sonar).ok());
          const scene::Sonar once = sonar;
          ASSERT_TRUE(apply_quality(sonar).ok());
          EXPECT_TRUE(scene::same_settings(once, sonar))
              << scene::name_of(kind) << " " << level.name << " " << width_deg;
        }
}

TEST(SonarQuality, AConesColumnsAreThoseOfItsKindWhicheverPlaneNamesThePattern) {
  for (const QualityLevel& level : quality_levels(SonarKind::kEchoSounder)) {
    scene::Sonar sonar = sonar_of(SonarKind::kEchoSounder);
    sonar.quality = level.name;
    sonar.terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(12.0)};
    ASSERT_TRUE(apply_quality(sonar).ok());
    EXPECT_EQ(sonar.bins_azimuth, static_cast<std::uint32_t>(level.columns));
  }
}

TEST(SonarQuality, ATablesOwnWidthDecidesItsColumns) {
  for (const double width_deg : {0.2, 2.0}) {
    scene::Sonar closed = sonar_of(SonarKind::kMechanical), table = closed;
    closed.terms.beam.azimuth->half_power_rad = radians(width_deg);
    table.terms.beam.azimuth = table_of(radians(width_deg));
    closed.quality = table.quality = "standard";
    ASSERT_TRUE(apply_quality(closed).ok());
    ASSERT_TRUE(apply_quality(table).ok());
    EXPECT_EQ(table.terms.beam.samples, closed.terms.beam.samples) << width_deg;
  }
}

TEST(SonarQuality, RangeBinsGrowByAWholeNumberUntilTheyResolveThePulse) {
  scene::Sonar sonar = sonar_of(SonarKind::kMechanical);
  sonar.quality = "standard";
  sonar.bins_range = 70;
  ASSERT_TRUE(apply_quality(sonar).ok());
  EXPECT_EQ(sonar.bins_range % 70, 0u);
  const double cell_m = 1500.0 / (2.0 * sonar.terms.range_spread->bandwidth_hz);
  const double wanted = quality_levels(sonar.kind)[1].bins_a_cell * 15.0 / cell_m;
  EXPECT_GE(sonar.bins_range, 0.95 * wanted);
  EXPECT_LE(sonar.bins_range, 1.05 * wanted + 70);
}

// A level that nobody named keeps the bins that leave, makes nothing coarser, and fits.
TEST(SonarQuality, AChosenLevelKeepsTheOutputAndCoarsensNothing) {
  for (const SonarKind kind : kKinds)
    for (const std::uint32_t range_bins : {70u, 5000u, 16384u}) {
      scene::Sonar sonar = sonar_of(kind);
      sonar.bins_range = range_bins;
      sonar.bins_azimuth = kind == SonarKind::kImaging ? 2048 : 64;
      sonar.bins_elevation = 900;
      const scene::Sonar before = sonar;
      sonar.quality = "standard";
      sonar.quality_chosen = true;
      ASSERT_TRUE(apply_quality(sonar).ok());
      EXPECT_EQ(sonar.bins_range, range_bins);
      EXPECT_GE(sonar.bins_azimuth, before.bins_azimuth);
      EXPECT_GE(sonar.bins_elevation, before.bins_elevation);
      EXPECT_GE(sonar.terms.beam.samples, before.terms.beam.samples);
      EXPECT_EQ(sonar.gbuffer_scale, quality_levels(kind)[1].gbuffer_scale);
      EXPECT_TRUE(plan_heads(sonar).ok()) << scene::name_of(kind) << " " << range_bins;
      if (kind == SonarKind::kMechanical) {
        EXPECT_GT(sonar.terms.beam.samples, 1u) << scene::name_of(kind);
      }
      const scene::Sonar once = sonar;
      ASSERT_TRUE(apply_quality(sonar).ok());
      EXPECT_TRUE(scene::same_settings(once, sonar)) << scene::name_of(kind);
    }
}

// A ball of 3 cm at the end of the range fills a cell of each kind, as far as the count of samples
// allows.
TEST(SonarQuality, AChosenLevelIsFineEnoughForTheSmallestTarget) {
  for (const SonarKind kind : kKinds) {
    scene::Sonar sonar = sonar_of(kind);
    sonar.range_max_m = 15.0;
    sonar.bins_range = 500;
    sonar.quality = "standard";
    sonar.quality_chosen = true;
    scene::Sonar coarse = sonar;
    ASSERT_TRUE(apply_quality(coarse).ok());
    sonar.least_target_m = 0.03;
    ASSERT_TRUE(apply_quality(sonar).ok());
    const bool cone = kind == SonarKind::kEchoSounder;
    const double high_rad = cone ? 2.0 * sonar.semi_angle_rad : sonar.elevation_rad;
    EXPECT_LT(high_rad / sonar.bins_elevation * 15.0, 0.03 / std::sqrt(2.0))
        << scene::name_of(kind);
    EXPECT_GE(sonar.gbuffer_scale, 1.0) << scene::name_of(kind);
    EXPECT_GE(sonar.bins_elevation, coarse.bins_elevation);
    EXPECT_TRUE(plan_heads(sonar).ok()) << scene::name_of(kind);
    sonar.least_target_m = 1e-9;  // neither for ever
    ASSERT_TRUE(apply_quality(sonar).ok());
    EXPECT_TRUE(plan_heads(sonar).ok()) << scene::name_of(kind);
  }
}

// An elevation pattern is heard far beyond the aperture: its rows are as fine as the target needs,
// not spread thinner. A ball of 1 cm at 10 m was missing from a third of an M1200d's pings.
TEST(SonarQuality, RowsBeyondTheApertureDoNotThinThoseThatASmallTargetNeeds) {
  const auto loaded =
      scene::load_sonar(test::source_dir() / "assets" / "sensors" / "oculus_m1200d.toml");
  ASSERT_TRUE(loaded.ok());
  scene::Sonar sonar = *loaded;
  sonar.quality = "standard";
  sonar.quality_chosen = true;
  sonar.least_target_m = 0.01;
  ASSERT_TRUE(apply_quality(sonar).ok());
  const auto heads = plan_heads(sonar);
  ASSERT_TRUE(heads.ok());
  const BeamGrid& grid = heads->front().samples;
  EXPECT_GT(grid.limits.elevation_max_rad, radians(40.0));
  // A lattice whose cells' half diagonal is shorter than the ball's radius.
  EXPECT_LT(10.0 * std::hypot(grid.azimuth_step_rad(), grid.elevation_step_rad()), 0.01);
  EXPECT_LT(static_cast<double>(grid.bins.azimuth) * grid.bins.elevation, 9.5e6);
  sonar.least_target_m = 0.3;
  EXPECT_LE(plan_heads(sonar)->front().samples.bins.elevation, 1536u);
}

// Every device that comes with the program can be had at every level, over all its range.
TEST(SonarQuality, EveryPresetTakesEveryLevel) {
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_dir() / "assets" / "sensors")) {
    if (entry.path().extension() != ".toml") continue;
    const auto loaded = scene::load_sonar(entry.path());
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    // "standard" is between; ALevelFillsWhatIsUnsetAndCanBePlanned takes it for every kind.
    for (const char* level : {"draft", "reference"}) {
      scene::Sonar sonar = *loaded;
      sonar.quality = level;
      const Status applied = apply_quality(sonar);
      EXPECT_TRUE(applied.ok()) << applied.error().message;
      EXPECT_TRUE(plan_heads(sonar).ok()) << sonar.name << " " << level;
    }
  }
}

TEST(SonarQuality, MoreRangeThanBinsCanSampleIsRefused) {
  scene::Sonar sonar = sonar_of(SonarKind::kMechanical);
  sonar.quality = "reference";
  sonar.range_max_m = 5000.0;
  const Status applied = apply_quality(sonar);
  ASSERT_FALSE(applied.ok());
  EXPECT_NE(applied.error().message.find("accepted: at most 16384"), std::string::npos)
      << applied.error().message;
}

TEST(SonarQuality, ColumnsFollowTheBeamsWidth) {
  scene::Sonar narrow = sonar_of(SonarKind::kMechanical), wide = narrow;
  narrow.terms.beam.azimuth->half_power_rad = radians(0.2);
  wide.terms.beam.azimuth->half_power_rad = radians(60.0);
  narrow.quality = wide.quality = "reference";
  ASSERT_TRUE(apply_quality(narrow).ok());
  ASSERT_TRUE(apply_quality(wide).ok());
  EXPECT_GT(narrow.terms.beam.samples, 1u);
  EXPECT_EQ(wide.terms.beam.samples, 1u);
}

TEST(SonarQuality, AnErrorTakesTheCheapestLevelThatKeepsIt) {
  for (const SonarKind kind : kKinds) {
    const auto levels = quality_levels(kind);
    for (const QualityLevel& level : levels) {
      scene::Sonar by_error = sonar_of(kind), by_name = by_error;
      by_error.max_error = level.error;
      by_name.quality = level.name;
      ASSERT_TRUE(apply_quality(by_error).ok());
      ASSERT_TRUE(apply_quality(by_name).ok());
      by_error.max_error = 0.0;
      by_name.quality.clear();
      EXPECT_TRUE(scene::same_settings(by_error, by_name)) << scene::name_of(kind);
    }
  }
}

TEST(SonarQuality, RefusalsNameWhatIsAccepted) {
  const auto refused = [](auto change, const char* names) {
    scene::Sonar sonar = sonar_of(SonarKind::kMechanical);
    change(sonar);
    const Status status = apply_quality(sonar);
    ASSERT_FALSE(status.ok()) << names;
    EXPECT_EQ(status.error().code, ErrorCode::kBadInput);
    EXPECT_NE(status.error().message.find(names), std::string::npos) << status.error().message;
    EXPECT_NE(status.error().message.find("ears"), std::string::npos) << status.error().message;
  };
  refused([](auto& s) { s.quality = "superb"; }, "draft, standard or reference");
  refused([](auto& s) { s.max_error = 1e-6; }, "max_error");
  refused(
      [](auto& s) {
        s.quality = "draft";
        s.max_error = 0.02;
      },
      "one of them");
  refused(
      [](auto& s) {
        s.quality = "reference";
        s.range_max_m = 10000.0;
      },
      "range bins");
}

}  // namespace
}  // namespace neritic::sonar
