// Levels do not depend on the width of the range bins: a floor, a sphere and noise against the
// sonar equation, from bins of 1 mm to bins of ten pulses, end to end.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/files.hpp"
#include "engine/core/math.hpp"
#include "sonar/quality.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarBinLevel = test::GpuTest;

constexpr double kFloorBelow_m = 1.0, kBinsFrom_m = 4.0, kBinsTo_m = 8.0;
constexpr double kSoundInWater_m_s = 1500.0;

struct BinnedDevice {
  std::string name;
  double resolution_m = 0.0;  // c / 2B
  double own_bin_m = 0.0;     // of its file
};

// Devices of assets/sensors whose bins are longer than the pulse, about as long, and a side-scan.
std::vector<BinnedDevice> binned_devices() {
  const test::ScratchFolder scratch;
  std::vector<BinnedDevice> found;
  for (const char* name :
       {"oculus_m750d", "gemini_720is", "oculus_m1200d", "blueview_p900_45", "starfish_450"}) {
    const auto file = scratch.path() / "scene.toml";
    EXPECT_TRUE(write_text(file, fmt::format("[[sonars]]\nname = \"sonar\"\ninclude = "
                                             "\"{}/assets/sensors/{}.toml\"\n",
                                             test::source_dir().string(), name))
                    .ok());
    const auto scene = scene::load_scene(file);
    EXPECT_TRUE(scene.ok()) << scene.error().message;
    if (!scene.ok()) return {};
    const scene::Sonar& sonar = scene->sonars[0];
    found.push_back({name, kSoundInWater_m_s / (2.0 * sonar.terms.range_spread->bandwidth_hz),
                     (sonar.range_max_m - sonar.range_min_m) / sonar.bins_range});
  }
  return found;
}

// A level head with the device's pulse and bins of about bin_m.
scene::Sonar with_bins(const BinnedDevice& device, double bin_m) {
  scene::Sonar sonar =
      sonar_of(kBinsFrom_m, kBinsTo_m,
               static_cast<std::uint32_t>(std::round((kBinsTo_m - kBinsFrom_m) / bin_m)));
  sonar.azimuth_rad = radians(4.0);
  sonar.elevation_rad = radians(40.0);
  sonar.bins_azimuth = 8;
  sonar.bins_elevation = 512;
  sonar.gbuffer_scale = 1.0;
  sonar.terms.water.sound_speed_m_s = kSoundInWater_m_s;
  sonar.terms.level = plain_level();
  sonar.terms.range_spread =
      scene::SonarRangeSpread{.bandwidth_hz = kSoundInWater_m_s / (2.0 * device.resolution_m)};
  return sonar;
}

scene::Scene over_a_floor(const scene::Sonar& sonar) {
  scene::Scene scene;
  scene.objects.push_back(
      object_of(scene, scene::make_box(Vec3(60.0, 1.0, 60.0)), {0.0, -kFloorBelow_m - 0.5, 0.0}));
  scene.objects[0].backscatter_db = -27.0;
  scene.sonars = {sonar};
  return scene;
}

// The mean over the beams of each bin, and the mean over the bin of EL = SL + 10 log mu + 20 log
// sin(grazing) + 10 log A - 40 log r - 2 alpha r, of the area A = r dtheta W that the pulse's
// length W cuts out. Bins that the ends of the range cut, or a pulse there, are left out.
struct BinPower {
  double heard = 0.0, equation = 0.0;
};
std::vector<BinPower> floor_by_bins(const SonarFrame& frame, double resolution_m) {
  const double pulse_m = 1.5 * resolution_m;  // Hann
  const double bin_m = frame.grid.range_step_m();
  std::vector<BinPower> out;
  for (std::uint32_t row = 0; row < frame.image.n_range; ++row) {
    const double middle_m = frame.grid.range_m(row);
    const double margin_m = 2.0 * bin_m + 3.0 * pulse_m;
    if (middle_m < kBinsFrom_m + margin_m || middle_m > kBinsTo_m - margin_m) continue;
    BinPower& bin = out.emplace_back();
    constexpr int kSteps = 50;
    for (int i = 0; i < kSteps; ++i) {
      const double r = middle_m + ((i + 0.5) / kSteps - 0.5) * bin_m, sine = kFloorBelow_m / r;
      bin.equation += std::pow(10.0, 20.0 - 2.7) * sine * sine * r * frame.grid.azimuth_step_rad() *
                      pulse_m / std::pow(r, 4) * std::pow(10.0, -0.2 * 0.3 * r) / kSteps;
    }
    for (std::uint32_t c = 0; c < frame.image.n_azimuth; ++c)
      bin.heard += frame.image.intensity[std::size_t{row} * frame.image.n_azimuth + c] /
                   frame.image.n_azimuth;
  }
  return out;
}

double floor_over_equation_db(const SonarFrame& frame, double resolution_m) {
  BinPower sum;
  for (const BinPower& bin : floor_by_bins(frame, resolution_m)) {
    sum.heard += bin.heard;
    sum.equation += bin.equation;
  }
  return 10.0 * std::log10(sum.heard / sum.equation);
}

TEST_F(SonarBinLevel, AFloorReadsTheSonarEquationInBinsOfAnyWidth) {
  for (const BinnedDevice& d : binned_devices())
    for (const double bin_m : {0.001, d.own_bin_m, 0.0125, 0.05, 15.0 * d.resolution_m}) {
      const SonarFrame frame = ping(device(), over_a_floor(with_bins(d, bin_m)));
      EXPECT_NEAR(floor_over_equation_db(frame, d.resolution_m), 0.0, 0.1)
          << d.name << ", bins of " << bin_m << " m";
    }
}

// Each bin by itself: where a row is a part of a bin high, bins that hold one row more than their
// neighbours do not ripple.
TEST_F(SonarBinLevel, EachBinOfAFloorReadsTheSonarEquation) {
  for (const BinnedDevice& d : binned_devices())
    for (const double pulses : {0.5, 1.0, 2.0, 5.0, 10.0})
      for (const std::uint32_t rows : {512u, 800u}) {
        const double bin_m = pulses * 1.5 * d.resolution_m;
        scene::Sonar sonar = with_bins(d, bin_m);
        sonar.bins_elevation = rows;
        const SonarFrame frame = ping(device(), over_a_floor(sonar));
        double least_db = INFINITY, most_db = -INFINITY;
        for (const BinPower& bin : floor_by_bins(frame, d.resolution_m)) {
          const double off_db = 10.0 * std::log10(bin.heard / bin.equation);
          least_db = std::min(least_db, off_db);
          most_db = std::max(most_db, off_db);
        }
        EXPECT_GT(least_db, -0.1) << d.name << ", bins of " << pulses << " pulses, " << rows;
        EXPECT_LT(most_db, 0.1) << d.name << ", bins of " << pulses << " pulses, " << rows;
      }
}

// The same of both sides of a side-scan.
TEST_F(SonarBinLevel, ASideScansFloorReadsTheSonarEquationInBinsOfAnyWidth) {
  const BinnedDevice d = binned_devices().back();
  ASSERT_EQ(d.name, "starfish_450");
  for (const double bin_m : {0.0025, 0.006, 0.025, 15.0 * d.resolution_m}) {
    scene::Sonar sonar = with_bins(d, bin_m);
    sonar.kind = scene::SonarKind::kSideScan;
    sonar.depression_rad = 0.0;
    const auto sides = pings(device(), over_a_floor(sonar));
    ASSERT_EQ(sides.size(), 2u);
    for (const SonarFrame& side : sides)
      EXPECT_NEAR(floor_over_equation_db(side, d.resolution_m), 0.0, 0.1)
          << side.head << ", bins of " << bin_m << " m";
  }
}

// Bins add what the pulse leaves: times their width over the pulse's length, a sphere's strength.
TEST_F(SonarBinLevel, ASpheresStrengthIsTheSameInBinsOfAnyWidth) {
  const BinnedDevice imager = binned_devices().at(0);
  const double pulse_m = 1.5 * imager.resolution_m;
  for (const double bin_m : {0.001, 0.006, 0.0125, 0.06}) {
    scene::Sonar sonar = with_bins(imager, bin_m);
    sonar.azimuth_rad = sonar.elevation_rad = radians(4.0);
    sonar.bins_azimuth = sonar.bins_elevation = 256;
    sonar.gbuffer_scale = 2.0;
    scene::Scene scene;
    scene.objects.push_back(object_of(scene, scene::make_sphere(0.1, 256), {0.0, 0.0, -6.0}));
    scene.sonars = {sonar};
    const SonarFrame frame = ping(device(), scene);
    const double level_db = 10.0 * std::log10(total(frame) * frame.grid.range_step_m() / pulse_m);
    // 40 log 6 m + 2 * 0.3 dB/m * 6 m; its near side is a tenth nearer.
    EXPECT_NEAR(level_db, 200.0 - 40.0 * std::log10(6.0) - 3.6 - 26.02, 0.25) << bin_m;
  }
}

TEST_F(SonarBinLevel, NoiseIsTheSameInBinsOfAnyWidth) {
  const BinnedDevice imager = binned_devices().at(0);
  for (const double bin_m : {0.001, 0.006, 0.06}) {
    scene::Sonar sonar = with_bins(imager, bin_m);
    sonar.bins_azimuth = 128;
    sonar.terms.noise = scene::SonarNoise{.level_db = 60.0};
    scene::Scene empty;
    empty.sonars = {sonar};
    const SonarFrame frame = ping(device(), empty);
    EXPECT_NEAR(10.0 * std::log10(total(frame) / static_cast<double>(frame.image.intensity.size())),
                60.0, 0.2)
        << bin_m;
  }
}

// Quality names more range bins where they are longer than the pulse; the level stays within what
// the level of quality states as its error.
TEST_F(SonarBinLevel, NamingAQualityKeepsTheLevel) {
  for (const BinnedDevice& d : binned_devices()) {
    scene::Sonar sonar = with_bins(d, d.own_bin_m);
    const double plain_db =
        floor_over_equation_db(ping(device(), over_a_floor(sonar)), d.resolution_m);
    sonar.quality = "draft";
    NERITIC_ASSERT_OK(const sonar::QualityLevel* level, sonar::quality_level(sonar));
    const double draft_db =
        floor_over_equation_db(ping(device(), over_a_floor(sonar)), d.resolution_m);
    EXPECT_NEAR(draft_db, plain_db, 10.0 * std::log10(1.0 + level->error)) << d.name;
  }
}

}  // namespace
}  // namespace neritic::testbed
