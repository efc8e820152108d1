// Sonars at the ends of what they accept, every kind with every term: finite, never negative, right
// where a closed form exists.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/shapes.hpp"
#include "sonar/acoustics.hpp"
#include "tests/testbed/sensors/sonar_sea.hpp"

namespace neritic::testbed {
namespace {

using scene::SonarKind;
using SonarExtremes = test::GpuTest;

// Checks that hold for any sonar; returns the total.
double expect_sane(const std::vector<SonarFrame>& frames, const std::string& of) {
  double total = 0.0;
  EXPECT_FALSE(frames.empty()) << of;
  for (const SonarFrame& frame : frames) {
    EXPECT_EQ(frame.image.intensity.size(),
              std::size_t{frame.grid.bins.range} * frame.grid.bins.azimuth)
        << of;
    std::size_t wrong = 0;
    for (const float v : frame.image.intensity) {
      wrong += !std::isfinite(v) || v < 0.0f;
      total += v;
    }
    EXPECT_EQ(wrong, 0u) << of;
    EXPECT_TRUE(std::isfinite(frame.absorption_db_per_m.value_or(0.0))) << of;
    if (frame.label_energy) {
      for (const float part : frame.label_energy->fraction)
        EXPECT_TRUE(part >= 0.0f && part <= 1.0f) << of << ": " << part;
    }
  }
  return total;
}

// A narrow sonar on a wall that lies across its axis.
scene::Scene wall_at(double distance_m, scene::Sonar sonar) {
  scene::Scene scene;
  const double half = distance_m;
  add_object(scene, scene::make_box({half, half, half}), {0.0, 0.0, -distance_m - half / 2.0}, 1);
  sonar.azimuth_rad = sonar.elevation_rad = radians(1.0);
  scene.sonars = {std::move(sonar)};
  return scene;
}

// For an aperture of a degree: patterns as wide as those of every_term() would reach far beyond it,
// with thousands of rows.
scene::SonarTerms every_term_of_a_degree() {
  scene::SonarTerms terms = every_term();
  terms.beam.azimuth->half_power_rad = radians(0.5);
  terms.beam.elevation->half_power_rad = radians(2.0);
  return terms;
}

TEST_F(SonarExtremes, EveryKindWithEveryTermIsFinite) {
  for (const SonarKind kind : kSonarKinds) {
    scene::Sonar sonar = small_sonar(kind);
    sonar.terms = every_term();
    EXPECT_GT(expect_sane(pings(device(), some_sea(sonar), 3), scene::name_of(kind)), 0.0);
  }
}

TEST_F(SonarExtremes, TheLoudestThatIsAcceptedIsAFiniteFloat) {
  for (const SonarKind kind : kSonarKinds)
    for (const bool speckle : {false, true})
      for (const double absorption : {0.0, 1000.0}) {
        if (speckle != (absorption > 0.0) && !test::is_thorough()) continue;
        scene::Sonar sonar = small_sonar(kind);
        sonar.range_min_m = 0.0;
        sonar.terms = every_term();
        if (!speckle) sonar.terms.speckle.reset();
        sonar.terms.noise = scene::SonarNoise{200.0};
        sonar.terms.level = scene::SonarLevel{.source_level_db = 260.0,
                                              .absorption = scene::SonarLevel::Absorption::kFixed,
                                              .absorption_db_per_m = absorption,
                                              .tvg_log = 60.0,
                                              .tvg_absorption = true,
                                              .gain_db = 120.0};
        scene::Scene sea = some_sea(sonar);
        for (scene::Object& object : sea.objects) object.backscatter_db = 20.0;
        EXPECT_GT(expect_sane(pings(device(), sea), scene::name_of(kind)), 0.0);
      }
}

TEST_F(SonarExtremes, FromFiveCentimetresToTenKilometres) {
  for (const double distance_m : {0.05, 10000.0}) {
    scene::Sonar sonar = small_sonar();
    sonar.range_min_m = 0.8 * distance_m;
    sonar.range_max_m = distance_m / 0.9;
    sonar.near_m = std::min(0.02, sonar.near_m);
    scene::Scene scene = wall_at(distance_m, sonar);
    const auto plain = pings(device(), scene);
    expect_sane(plain, fmt::format("{} m", distance_m));
    EXPECT_NEAR(mean_range_m(plain.at(0)) / distance_m, 1.0, 2e-3) << distance_m;
    EXPECT_NEAR(total(plain[0]), 32.0, 0.01) << distance_m;  // 1 a beam, cos of half a degree
    scene.sonars[0].terms.level = scene::SonarLevel{
        .absorption = scene::SonarLevel::Absorption::kFixed, .absorption_db_per_m = 1e-3};
    const auto level = pings(device(), scene);
    // mu dOmega / r^2 10^(-2 alpha r / 10).
    const double solid_angle = radians(1.0) * 2.0 * std::sin(radians(0.5));
    const double db = 10.0 * std::log10(solid_angle) - 27.0 - 20.0 * std::log10(distance_m) -
                      2e-3 * distance_m + 200.0;
    EXPECT_NEAR(10.0 * std::log10(total(level.at(0))), db, 0.1) << distance_m;
    scene.sonars[0].terms = every_term_of_a_degree();
    expect_sane(pings(device(), scene), fmt::format("{} m, every term", distance_m));
  }
}

TEST_F(SonarExtremes, AperturesOfATenthDegreeAndAFullTurn) {
  for (const SonarKind kind : kSonarKinds)
    for (const double aperture_deg : {0.1, 360.0}) {
      scene::Sonar sonar = small_sonar(kind);
      sonar.azimuth_rad = radians(aperture_deg);
      if (aperture_deg < 1.0) {
        sonar.elevation_rad = sonar.azimuth_rad;
        sonar.semi_angle_rad = radians(0.05);
        sonar.bins_elevation = 8;  // patterns reach beyond it, by as many rows a degree
      }
      sonar.terms = every_term();
      if (aperture_deg < 1.0) {
        sonar.terms.beam.azimuth->half_power_rad = radians(0.1);
        sonar.terms.beam.elevation->half_power_rad = radians(0.3);
      }
      expect_sane(pings(device(), some_sea(sonar)),
                  fmt::format("{} {} degrees", scene::name_of(kind), aperture_deg));
    }
  // A tenth of a degree across a wall: one beam's solid angle, mu dOmega / r^2, at its range.
  {
    scene::Sonar narrow = small_sonar();
    narrow.range_min_m = 4.0;
    narrow.range_max_m = 6.0;
    narrow.bins_range = 512;
    narrow.terms.level = scene::SonarLevel{.absorption = scene::SonarLevel::Absorption::kFixed,
                                           .absorption_db_per_m = 0.1};
    scene::Scene wall = wall_at(5.0, narrow);
    wall.sonars[0].azimuth_rad = wall.sonars[0].elevation_rad = radians(0.1);
    const auto heard = pings(device(), wall);
    const double db = 10.0 * std::log10(radians(0.1) * 2.0 * std::sin(radians(0.05))) - 27.0 -
                      20.0 * std::log10(5.0) - 2.0 * 0.1 * 5.0 + 200.0;
    EXPECT_NEAR(10.0 * std::log10(total(heard.at(0))), db, 0.02);
    EXPECT_NEAR(mean_range_m(heard[0]), 5.0, 2.0 / 512.0);
  }
  // Inside a ball every beam of a full turn hears the same.
  scene::Sonar sonar = small_sonar();
  sonar.azimuth_rad = 2.0 * kPi;
  sonar.gbuffer_scale = 2.0;
  sonar.terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(20.0)};
  scene::Scene scene;
  scene::Model ball = scene::make_sphere(6.0, 256);
  scene::turn_inside_out(ball);
  add_object(scene, std::move(ball), {0, 0, 0}, 12);
  scene.sonars = {sonar};
  const auto frames = pings(device(), scene);
  const sonar::SonarImage& image = frames.at(0).image;
  for (std::uint32_t c = 0; c < image.n_azimuth; ++c) {
    double sum = 0.0;
    for (std::uint32_t row = 0; row < image.n_range; ++row)
      sum += image.intensity[std::size_t{row} * image.n_azimuth + c];
    EXPECT_NEAR(sum, 1.0, 3e-3) << c;
  }
}

TEST_F(SonarExtremes, FromOneBeamTo4096) {
  double plain[2], spread[2];
  int i = 0;
  for (const std::uint32_t beams : {1u, 4096u}) {
    scene::Sonar sonar = small_sonar();
    sonar.bins_azimuth = beams;
    sonar.bins_range = 64;
    sonar.bins_elevation = 32;
    sonar.gbuffer_scale = beams == 1 ? 16.0 : 0.25;
    plain[i] =
        expect_sane(pings(device(), some_sea(sonar)), fmt::format("{} beams", beams)) / beams;
    sonar.terms.beam.samples = beams == 1 ? 128 : 1;
    spread[i] =
        expect_sane(pings(device(), some_sea(sonar)), fmt::format("{} beams", beams)) / beams;
    sonar.terms = every_term();
    if (beams > 1) sonar.terms.beam.azimuth->half_power_rad = radians(0.1);
    expect_sane(pings(device(), some_sea(sonar)), fmt::format("{} beams, every term", beams));
    ++i;
  }
  // The mean over a beam of all bearings is the mean of many beams.
  EXPECT_NEAR(spread[0] / spread[1], 1.0, 0.02);
  EXPECT_NEAR(plain[1] / spread[1], 1.0, 0.02);
}

TEST_F(SonarExtremes, AbsorptionFromOneHertzToTenMegahertz) {
  double heard[2];
  int i = 0;
  for (const double frequency_hz : {1.0, 10e6}) {
    scene::Sonar sonar = small_sonar();
    sonar.range_min_m = 0.9;
    sonar.range_max_m = 1.1;
    sonar.terms.frequency_hz = frequency_hz;
    sonar.terms.level = scene::SonarLevel{};
    sonar.terms.water.depth_m = 0.0;
    const scene::Scene scene = wall_at(1.0, sonar);
    const auto frames = pings(device(), scene);
    heard[i++] = expect_sane(frames, fmt::format("{} Hz", frequency_hz));
    const double wanted = sonar::absorption_db_m(sonar::AbsorptionModel::kFrancoisGarrison,
                                                 {10.0, 35.0, 0.0, 8.0}, frequency_hz);
    EXPECT_DOUBLE_EQ(frames.at(0).absorption_db_per_m.value_or(-1.0), wanted);
    EXPECT_GE(wanted, 0.0);
    scene::Scene every = scene;
    every.sonars[0].terms = every_term_of_a_degree();
    every.sonars[0].terms.frequency_hz = frequency_hz;
    expect_sane(pings(device(), every), fmt::format("{} Hz, every term", frequency_hz));
    if (i == 2) {
      EXPECT_NEAR(10.0 * std::log10(heard[0] / heard[1]), 2.0 * wanted, 0.5);
    }
  }
}

TEST_F(SonarExtremes, NoReturnAtAllIsSilenceOrNoise) {
  for (const SonarKind kind : kSonarKinds) {
    scene::Sonar sonar = small_sonar(kind);
    scene::Scene empty;
    sonar.terms = every_term();
    sonar.terms.noise.reset();
    empty.sonars = {sonar};
    for (const SonarFrame& frame : pings(device(), empty)) EXPECT_EQ(total(frame), 0.0);
    empty.sonars[0].terms.noise = scene::SonarNoise{60.0};
    empty.sonars[0].terms.level = scene::SonarLevel{};
    for (const SonarFrame& frame : pings(device(), empty)) {
      const double n = static_cast<double>(frame.image.intensity.size());
      // Exponential: the mean of n is off by 1 / sqrt(n).
      EXPECT_NEAR(total(frame) / n / 1e6, 1.0, 4.0 / std::sqrt(n)) << scene::name_of(kind);
    }
  }
}

TEST_F(SonarExtremes, AFloorFillsEveryBin) {
  for (const SonarKind kind : {SonarKind::kImaging, SonarKind::kSideScan}) {
    scene::Sonar sonar = small_sonar(kind);
    sonar.range_min_m = 1.8;
    sonar.elevation_rad = radians(80.0);
    sonar.depression_rad = radians(40.0);
    sonar.range_max_m = 6.0;
    sonar.bins_elevation = 4096;  // steps of less than half a bin at the farthest
    scene::Scene scene;
    add_object(scene, scene::make_box({200.0, 1.0, 200.0}), {0.0, -1.5, 0.0}, 1);
    scene.sonars = {sonar};
    const auto silent_bins = [&](const scene::Scene& s) {
      std::size_t silent = 0;
      for (const SonarFrame& frame : pings(device(), s))
        for (const float v : frame.image.intensity) silent += !(v > 0.0f);
      return silent;
    };
    EXPECT_EQ(silent_bins(scene), 0u) << scene::name_of(kind);
    scene.sonars[0].terms = every_term();
    scene.sonars[0].terms.speckle.reset();  // which may cancel to nothing
    EXPECT_EQ(silent_bins(scene), 0u) << scene::name_of(kind);
  }
}

TEST_F(SonarExtremes, AFloorSeenAtAHundredthOfADegree) {
  // Rows from level to 0.02 degrees down; the floor, 2 mm below, is met at 2 mm / sin.
  constexpr double kHeight_m = 0.002, kFar_m = 50.0;
  scene::Sonar sonar = small_sonar();
  sonar.azimuth_rad = radians(2.0);
  sonar.elevation_rad = radians(0.02);
  sonar.bins_elevation = 512;
  sonar.range_min_m = 1.0;
  sonar.range_max_m = kFar_m;
  sonar.near_m = 0.5;
  sonar.mount.pose.rotation = glm::angleAxis(radians(-0.01), Vec3(1, 0, 0));
  scene::Scene scene;
  add_object(scene, scene::make_box({300.0, 1.0, 300.0}), {0.0, -0.5 - kHeight_m, 0.0}, 1);
  scene.sonars = {sonar};
  const auto frames = pings(device(), scene);
  expect_sane(frames, "grazing");
  const double nearest = radians(0.02), farthest = kHeight_m / kFar_m;
  const double mean =
      (std::cos(farthest) - std::cos(nearest)) / radians(0.02);  // of sin over all rows
  EXPECT_NEAR(total(frames.at(0)) / frames[0].image.n_azimuth / mean, 1.0, 0.05);
  // Patterns reach a thousand apertures beyond it, by as many rows a degree.
  scene.sonars[0].bins_elevation = 16;
  scene.sonars[0].terms = every_term();
  expect_sane(pings(device(), scene), "grazing, every term");
}

TEST_F(SonarExtremes, AHundredKilometresFromTheOriginItSoundsTheSame) {
  for (const SonarKind kind : kSonarKinds) {
    scene::Sonar sonar = small_sonar(kind);
    sonar.terms = every_term();
    // Scatterers belong to their place in the world; all else goes with the sonar.
    sonar.terms.speckle.reset();
    sonar.terms.noise.reset();
    scene::Scene here = some_sea(sonar), there = here;
    for (scene::Object& object : there.objects) object.mount.pose.position_m.x += 1e5;
    there.sonars[0].mount.pose.position_m.x += 1e5;
    for (auto& place : there.sonars[0].mount.track->places) place.position_m.x += 1e5;
    const auto a = pings(device(), here), b = pings(device(), there);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t head = 0; head < a.size(); ++head) {
      double difference = 0.0;
      for (std::size_t i = 0; i < a[head].image.intensity.size(); ++i)
        difference += std::abs(double{a[head].image.intensity[i]} - b[head].image.intensity[i]);
      EXPECT_LE(difference, 2e-3 * total(a[head])) << scene::name_of(kind);
    }
    there.sonars[0].terms = every_term();
    expect_sane(pings(device(), there), fmt::format("{} far away", scene::name_of(kind)));
  }
}

}  // namespace
}  // namespace neritic::testbed
