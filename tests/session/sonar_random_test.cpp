// Speckle and noise: their statistics against closed forms, and what they may not share.
#include <algorithm>

#include "tests/session/sonar_pings.hpp"

namespace neritic::tools {
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
}  // namespace neritic::tools
