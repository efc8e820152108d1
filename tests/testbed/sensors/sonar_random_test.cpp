// Speckle and noise: their statistics against closed forms, and what they may not share.
#include <algorithm>

#include "sonar/beam_pattern.hpp"
#include "sonar/head.hpp"
#include "tests/support/support.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarRandom = test::GpuTest;

// A wall that fills every beam: speckle over the smooth image, bin by bin.
struct Ratios {
  std::vector<double> power;                               // of bins that hear the wall well
  double mean = 0.0, contrast = 0.0, second_moment = 0.0;  // contrast of the amplitude
};

Ratios ratios(const SonarFrame& smooth, const SonarFrame& speckled) {
  Ratios r;
  double amplitude = 0.0, square = 0.0;
  const auto& v = smooth.image.intensity;
  const float well = 0.2f * *std::max_element(v.begin(), v.end());
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (v[i] < well) continue;
    r.power.push_back(speckled.image.intensity[i] / smooth.image.intensity[i]);
    r.mean += r.power.back();
    amplitude += std::sqrt(r.power.back());
    square += r.power.back() * r.power.back();
  }
  const double n = static_cast<double>(r.power.size());
  r.mean /= n;
  amplitude /= n;
  r.contrast = std::sqrt(r.mean - amplitude * amplitude) / amplitude;
  r.second_moment = square / n / (r.mean * r.mean);
  return r;
}

scene::Scene speckled_wall() {
  scene::Sonar sonar = sonar_of(2.95, 3.05, 50);
  sonar.bins_azimuth = 1024;
  sonar.terms.frequency_hz = 900e3;
  return wall(3.0, sonar);
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t n = std::min(a.size(), b.size());
  double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < n; ++i) ma += a[i] / n, mb += b[i] / n;
  for (std::size_t i = 0; i < n; ++i) {
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
    ab += (a[i] - ma) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

TEST_F(SonarRandom, FullyDevelopedSpeckleIsRayleighAndKeepsTheMean) {
  scene::Scene scene = speckled_wall();
  const SonarFrame smooth = ping(device(), scene);
  scene.sonars[0].terms.speckle = scene::SonarSpeckle{};
  const Ratios r = ratios(smooth, ping(device(), scene));
  ASSERT_GT(r.power.size(), 5000u);
  EXPECT_NEAR(r.mean, 1.0, 0.05);
  EXPECT_NEAR(r.contrast, 0.5227, 0.015);   // Rayleigh
  EXPECT_NEAR(r.second_moment, 2.0, 0.15);  // exponential power
}

// A floor at grazing: a bin is a strip much smaller than a patch of the texture, and there are many
// patches.
TEST_F(SonarRandom, FewScatterersAreKDistributed) {
  scene::Sonar sonar = sonar_of(2.5, 4.0, 500);
  sonar.azimuth_rad = radians(60.0);
  sonar.bins_azimuth = 512;
  sonar.bins_elevation = 1024;
  sonar.terms.frequency_hz = 900e3;
  sonar.mount.pose.rotation = glm::angleAxis(radians(-18.0), Vec3(1, 0, 0));
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_plane(20.0, 20.0), {0.0, -1.0, 0.0}));
  scene.sonars = {sonar};
  const SonarFrame smooth = ping(device(), scene);
  for (const double shape : {0.5, 2.0, 10.0}) {
    scene.sonars[0].terms.speckle = scene::SonarSpeckle{.shape = shape, .texture_m = 0.03};
    const Ratios r = ratios(smooth, ping(device(), scene));
    EXPECT_NEAR(r.mean, 1.0, 0.1) << shape;
    EXPECT_NEAR(r.second_moment / (2.0 * (1.0 + 1.0 / shape)), 1.0, 0.12) << shape;
  }
}

// A wall's total power with speckle, through pattern and pulse, however many columns
// sample a beam and however near the wall is.
double speckled_over_smooth(gpu::Device& device, double distance_m, std::uint32_t samples) {
  scene::Sonar sonar = sonar_of(0.9 * distance_m, 1.5 * distance_m, 0);
  sonar.bins_range = static_cast<std::uint32_t>(std::lround(0.6 * distance_m / 0.0075));
  sonar.azimuth_rad = sonar.elevation_rad = radians(60.0);
  sonar.bins_azimuth = 120;
  sonar.bins_elevation = 96;
  sonar.terms.frequency_hz = 720e3;
  sonar.terms.beam.samples = samples;
  sonar.terms.beam.azimuth =
      scene::SonarPattern{.shape = scene::BeamShape::kHamming, .half_power_rad = radians(1.0)};
  sonar.terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 30e3};
  scene::Scene scene = wall(distance_m, sonar);
  const double smooth = total(ping(device, scene));
  scene.sonars[0].terms.speckle = scene::SonarSpeckle{};
  double speckled = 0.0;
  // Near, the wall is few resolution cells deep: the mean of as many more worlds.
  const int seeds = static_cast<int>(std::lround(std::max(4.0, 32.0 / distance_m)));
  Pinger pinger(device, scene);
  for (int i = 0; i < seeds; ++i)
    speckled += total(pinger.ping(static_cast<std::uint64_t>(i) + 1)) / seeds;
  return speckled / smooth;
}

TEST_F(SonarRandom, SpeckleKeepsTheLevelHoweverABeamIsSampled) {
  std::vector<double> distances_m{1.0, 8.0};
  if (test::is_thorough()) distances_m.push_back(2.0);
  for (const double distance_m : distances_m)
    for (const std::uint32_t samples : {1u, 4u, 16u})
      EXPECT_NEAR(speckled_over_smooth(device(), distance_m, samples), 1.0, 0.05)
          << distance_m << " m, " << samples << " samples a beam";
}

// A head that turns hears echoes between two columns: as loud as on them.
TEST_F(SonarRandom, TurningDarkensNoRange) {
  scene::Sonar sonar = sonar_of(4.0, 12.0, 800);
  sonar.azimuth_rad = radians(40.0);
  sonar.bins_azimuth = 400;
  sonar.bins_elevation = 512;
  sonar.terms.water.sound_speed_m_s = 1500.0;
  sonar.terms.motion = scene::SonarMotion{.within_ping = true};
  sonar.mount.pose.rotation = glm::angleAxis(radians(-20.0), Vec3(1, 0, 0));
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_plane(60.0, 60.0), {0.0, -2.5, 0.0}));
  scene.sonars = {sonar};
  const Quat pitch = sonar.mount.pose.rotation;
  scene.sonars[0].mount.track = scene::Track{{{0.0, Vec3(0.0)}},
                                             {{-1.0, glm::angleAxis(-1.0, Vec3(0, 1, 0)) * pitch},
                                              {1.0, glm::angleAxis(1.0, Vec3(0, 1, 0)) * pitch}}};
  const SonarFrame smooth = ping(device(), scene);
  scene.sonars[0].terms.speckle = scene::SonarSpeckle{};
  const SonarFrame speckled = ping(device(), scene);
  // Columns turned until a range: 2 r / c over a column's tenth of a degree, times the part of the
  // turn that is about the head's own axis.
  const double columns_per_m = 2.0 / 1500.0 / radians(0.1) * std::cos(radians(20.0));
  constexpr int kParts = 5;
  double heard[kParts] = {}, wanted[kParts] = {};
  for (std::uint32_t row = 0; row < 800; ++row) {
    const double turned = columns_per_m * smooth.grid.range_m(row);
    const int part = static_cast<int>(kParts * (turned - std::floor(turned)));
    for (std::uint32_t beam = 40; beam < 360; ++beam) {
      heard[part] += speckled.image.intensity[row * 400 + beam];
      wanted[part] += smooth.image.intensity[row * 400 + beam];
    }
  }
  for (int i = 0; i < kParts; ++i) EXPECT_NEAR(heard[i] / wanted[i], 1.0, 0.05) << i;
}

// A floor that a narrow beam meets at 45 degrees, so that its bins are strips.
scene::Scene tilted_floor(double range_m, const scene::Sonar& sonar) {
  scene::Scene scene;
  const double down_m = range_m * std::sin(radians(45.0));
  scene.objects.push_back(object_of(scene, scene::make_plane(60.0, 60.0), {0.0, -down_m, 0.0}));
  scene.sonars = {sonar};
  scene.sonars[0].mount.pose.rotation = glm::angleAxis(radians(-45.0), Vec3(1, 0, 0));
  return scene;
}

// Correlation of a beam's power before and after the sonar has moved x_m across, of dense points at
// random on a line across at the range: |<f f'*>|^2, each with the pattern at its bearing and the
// phase of its path there and back.
double expected_correlation(double x_m, double range_m, double half_power_rad, double turns_per_m) {
  const auto pattern =
      sonar::BeamPattern::of_half_power_width(sonar::BeamShape::kHamming, half_power_rad);
  double real = 0.0, imaginary = 0.0, power = 0.0;
  for (double at_m = -0.6; at_m <= 0.6; at_m += 1e-4) {
    const auto amplitude = [&](double off_m) {
      return pattern->amplitude(std::atan2(off_m, range_m));
    };
    const double before = amplitude(at_m), after = amplitude(at_m - x_m);
    const double turns =
        turns_per_m * (std::hypot(range_m, at_m - x_m) - std::hypot(range_m, at_m));
    real += before * after * std::cos(2.0 * kPi * turns);
    imaginary += before * after * std::sin(2.0 * kPi * turns);
    power += before * before;
  }
  return (real * real + imaginary * imaginary) / (power * power);
}

// The same along range, of a field without grain: by how much a window of one bin overlaps itself a
// part of a bin on, drawn out by the pulse's taps (of amplitudes).
double expected_correlation_along(double part, const std::vector<float>& taps) {
  double same = 0.0, next = 0.0;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    same += double{taps[i]} * taps[i];
    if (i > 0) next += double{taps[i - 1]} * taps[i];
  }
  const double of_amplitude = (1.0 - part) + (taps.empty() ? 0.0 : part * next / same);
  return of_amplitude * of_amplitude;
}

TEST_F(SonarRandom, SpeckleBelongsToTheWorld) {
  scene::Scene scene = speckled_wall();
  const SonarFrame smooth = ping(device(), scene);
  scene.sonars[0].terms.speckle = scene::SonarSpeckle{.scatterer_m = 0.02};
  const SonarFrame here = ping(device(), scene);
  const Ratios at_home = ratios(smooth, here);
  const auto moved = [&](double x_m) {
    scene.sonars[0].mount.pose.position_m = {x_m, 0.0, 0.0};
    return ratios(smooth, ping(device(), scene));
  };
  EXPECT_GT(correlation(at_home.power, moved(1e-6).power), 0.99);
  EXPECT_LT(std::abs(correlation(at_home.power, moved(0.06).power)), 0.1);
  scene.sonars[0].mount.pose.position_m = {0.0, 0.0, 0.0};
  EXPECT_EQ(ping(device(), scene, 7).image.intensity, here.image.intensity);  // it came back
  // Far from the origin the same world gives statistics as good.
  scene.objects[0].mount.pose.position_m += Vec3(1e5, -200.0, 1e5);
  scene.sonars[0].mount.pose.position_m = {1e5, -200.0, 1e5};
  EXPECT_NEAR(ratios(smooth, ping(device(), scene)).contrast, 0.5227, 0.02);
}

// Across the beam a scatterer passes from column to column and stays: what fades is what leaves the
// beam, and what turns by its own path. Against a field of points at random, in double.
TEST_F(SonarRandom, SpeckleFadesWithTheWayAcross) {
  constexpr double kRange_m = 5.0, kWidth_rad = radians(1.0);
  scene::Sonar sonar = sonar_of(4.9, 5.1, 40);
  sonar.azimuth_rad = radians(8.0);
  sonar.elevation_rad = radians(3.0);
  sonar.bins_azimuth = 32;
  sonar.bins_elevation = 64;
  sonar.terms.frequency_hz = 750e3;
  sonar.terms.water.sound_speed_m_s = 1500.0;
  sonar.terms.beam.samples = 2;
  sonar.terms.beam.azimuth =
      scene::SonarPattern{.shape = scene::BeamShape::kHamming, .half_power_rad = kWidth_rad};
  sonar.terms.speckle = scene::SonarSpeckle{.scatterer_m = 0.01};
  scene::Scene scene = tilted_floor(kRange_m, sonar);
  scene::Scene plain = scene;
  plain.sonars[0].terms.speckle.reset();
  const SonarFrame smooth = ping(device(), plain);
  Pinger pinger(device(), scene);
  const auto powers_at = [&](double x_m) {
    scene.sonars[0].mount.pose.position_m.x = x_m;
    pinger.replace(scene.sonars[0]);
    std::array<std::vector<double>, 5> powers;
    for (std::size_t i = 0; i < 5; ++i) powers[i] = ratios(smooth, pinger.ping(i + 1)).power;
    return powers;
  };
  const auto home = powers_at(0.0);
  const auto measured = [&](double x_m) {
    const auto there = powers_at(x_m);
    double sum = 0.0;
    for (std::size_t i = 0; i < 5; ++i) sum += correlation(home[i], there[i]);
    return sum / 5.0;
  };
  for (const double x_m : {0.002, 0.01, 0.02, 0.03, 0.055}) {
    // Off the axis the way across is one along range too: by x sin(azimuth), of bins of 5 mm.
    double along = 0.0;
    for (int beam = 0; beam < 32; ++beam)
      along += expected_correlation_along(
                   x_m * std::abs(std::sin(radians((beam - 15.5) / 4.0))) / 0.005, {}) /
               32.0;
    const double expected =
        along * expected_correlation(x_m, kRange_m, kWidth_rad, 2.0 * 750e3 / 1500.0);
    const double found = measured(x_m);
    EXPECT_LT(found, expected + 0.06) << x_m << " m";
    EXPECT_GT(found, 0.85 * expected - 0.06) << x_m << " m";
  }
}

// A head that looks down a floor at 45 degrees, so that its bins are strips; here, and moved on
// ahead.
class AlongRange {
 public:
  static constexpr std::uint32_t kBins = 48, kEdge = 8, kColumns = 64, kSeeds = 4;

  AlongRange(gpu::Device& device, bool pulse) {
    scene::Sonar sonar = sonar_of(4.88, 5.12, kBins);
    sonar.azimuth_rad = radians(16.0);
    sonar.elevation_rad = radians(4.0);
    sonar.bins_azimuth = kColumns;
    sonar.terms.frequency_hz = 750e3;
    sonar.terms.water.sound_speed_m_s = 1500.0;
    if (pulse) sonar.terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 60e3};
    scene_ = tilted_floor(5.0, sonar);
    pinger_.emplace(device, scene_);
    home_ = powers_at(0.0);
  }
  // Power over the smooth image's at home and so many bins ahead, a seed after the other; rows
  // start as many bins nearer.
  struct Powers {
    std::vector<double> bins[kSeeds];  // [kBins][kColumns]
  };
  Powers powers_at(double bins) {
    const Vec3 ahead(0.0, -std::sin(radians(45.0)), -std::cos(radians(45.0)));
    scene::Sonar& sonar = scene_.sonars[0];
    sonar.mount.pose.position_m = ahead * (bins * 0.24 / kBins);
    sonar.terms.speckle.reset();
    pinger_->replace(sonar);
    const SonarFrame smooth = pinger_->ping(0);
    sonar.terms.speckle = scene::SonarSpeckle{};
    pinger_->replace(sonar);
    Powers out;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const SonarFrame speckled = pinger_->ping(seed + 1);
      for (std::size_t i = 0; i < smooth.image.intensity.size(); ++i)
        out.bins[seed].push_back(speckled.image.intensity[i] / smooth.image.intensity[i]);
    }
    return out;
  }
  // Correlation of a bin at home with the bin `rows` nearer after the way ahead.
  double correlation_with(const Powers& moved, std::uint32_t rows) const {
    std::vector<double> before, after;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed)
      for (std::uint32_t i = kEdge * kColumns; i < (kBins - kEdge) * kColumns; ++i) {
        before.push_back(home_.bins[seed][i]);
        after.push_back(moved.bins[seed][i - rows * kColumns]);
      }
    return correlation(before, after);
  }
  std::vector<float> taps() const {
    const auto heads = sonar::plan_heads(scene_.sonars[0]);
    return heads.ok() ? (*heads)[0].receiver.range.weights : std::vector<float>{};
  }

 private:
  scene::Scene scene_;
  std::optional<Pinger> pinger_;
  Powers home_;
};

// Along range the picture of speckle comes nearer with the world, and is the same picture: bin for
// bin after whole bins, as a window that slides over the field after parts of one. A slice that a
// bin's edge cuts holds two amplitudes, not a field: without a pulse its correlation is 0.67 where
// the field's is 0.56.
TEST_F(SonarRandom, SpeckleComesNearerWithTheWorld) {
  for (const bool pulse : {false, true}) {
    AlongRange head(device(), pulse);
    const double expected = expected_correlation_along(0.25, head.taps());
    const double quarter = head.correlation_with(head.powers_at(0.25), 0);
    EXPECT_GT(quarter, expected - 0.05) << pulse;
    EXPECT_LT(quarter, expected + (pulse ? 0.05 : 0.16)) << pulse;
    EXPECT_GT(head.correlation_with(head.powers_at(1.0), 1), 0.95) << pulse;
    const auto far = head.powers_at(5.0);
    EXPECT_GT(head.correlation_with(far, 5), 0.85) << pulse;
    EXPECT_LT(std::abs(head.correlation_with(far, 0)), 0.1)
        << pulse;  // the sonar has none of its own
  }
}

scene::Sonar noisy(scene::SonarKind kind) {
  scene::Sonar sonar = sonar_of(1.0, 2.0, 2000);
  sonar.kind = kind;
  sonar.terms.level = plain_level();
  sonar.terms.noise = scene::SonarNoise{60.0};
  return sonar;
}

TEST_F(SonarRandom, NoiseIsExponentialInPowerAndItsOwnInEveryBeam) {
  const scene::Scene scene = wall(50.0, noisy(scene::SonarKind::kImaging));
  const SonarFrame frame = ping(device(), scene);
  const auto& v = frame.image.intensity;
  const double n = static_cast<double>(v.size()), mean = total(frame) / n;
  EXPECT_NEAR(10.0 * std::log10(mean), 60.0, 0.03);
  double variance = 0.0, across = 0.0, along = 0.0;
  const std::size_t row = frame.image.n_azimuth;
  for (std::size_t i = 0; i + row < v.size(); ++i) {
    variance += (v[i] - mean) * (v[i] - mean);
    across += (v[i] - mean) * (v[i + 1] - mean);
    along += (v[i] - mean) * (v[i + row] - mean);
  }
  EXPECT_NEAR(variance / n / mean / mean, 1.0, 0.02);
  EXPECT_LT(std::abs(across / variance), 0.01);
  EXPECT_LT(std::abs(along / variance), 0.01);
  EXPECT_NE(v, ping(device(), scene, 1).image.intensity);  // another ping
  EXPECT_EQ(v, ping(device(), scene, 0).image.intensity);
}

TEST_F(SonarRandom, TheSidesOfASideScanShareNoNoise) {
  scene::Sonar sonar = noisy(scene::SonarKind::kSideScan);
  sonar.bins_azimuth = 1;
  sonar.bins_range = 8000;
  const scene::Scene scene = wall(50.0, sonar);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  FrameRequest request;
  request.sonars = {0};
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  const auto of = [&](int side) {
    const auto& v = result.sonars[static_cast<std::size_t>(side)].image.intensity;
    return std::vector<double>(v.begin(), v.end());
  };
  EXPECT_LT(std::abs(correlation(of(0), of(1))), 0.05);
}

}  // namespace
}  // namespace neritic::testbed
