// Labels by energy through beam pattern and pulse, against pictures of each instance alone.
#include <algorithm>

#include "sonar/label_energy.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarLabels = test::GpuTest;

// Two boxes side by side and a sphere before them, over a floor: edges along range and across.
scene::Scene two_boxes_and_a_sphere() {
  scene::Sonar sonar = sonar_of(2.0, 8.0, 200);
  sonar.azimuth_rad = radians(40.0);
  sonar.bins_azimuth = 80;
  sonar.gbuffer_scale = 2.0;
  sonar.mount.pose.rotation = glm::angleAxis(radians(-12.0), Vec3(1, 0, 0));
  sonar.terms.beam.samples = 2;
  sonar.terms.beam.azimuth =
      scene::SonarPattern{.shape = scene::BeamShape::kHamming, .half_power_rad = radians(2.0)};
  sonar.terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 8e3};
  sonar.terms.level = plain_level();
  sonar.terms.labels.energy = true;
  scene::Scene scene;
  const auto add = [&](scene::Model model, const Vec3& at) {
    scene.objects.push_back(object_of(scene, std::move(model), at));
  };
  add(scene::make_plane(40.0, 40.0), {0.0, -1.5, 0.0});
  add(scene::make_box(Vec3(0.8, 0.8, 0.4)), {-0.5, -1.1, -5.0});
  add(scene::make_box(Vec3(0.8, 0.8, 0.4)), {0.4, -1.1, -5.3});
  add(scene::make_sphere(0.3, 64), {0.3, -1.0, -4.0});
  scene.sonars = {sonar};
  return scene;
}

TEST_F(SonarLabels, AreThoseOfMostEnergyBehindPatternAndPulse) {
  const scene::Scene scene = two_boxes_and_a_sphere();
  const SonarFrame frame = ping(device(), scene);
  ASSERT_TRUE(frame.label_energy);
  const auto& found = *frame.label_energy;
  // The echo of each instance alone: all others reflect nothing, but still occlude.
  std::vector<std::vector<float>> alone;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    scene::Scene one = scene;
    for (std::size_t k = 0; k < one.objects.size(); ++k)
      if (k != i) one.objects[k].reflectivity = 0.0f;
    alone.push_back(ping(device(), one).image.intensity);
  }
  const auto& whole = frame.image.intensity;
  const float loudest = *std::max_element(whole.begin(), whole.end());
  int compared = 0, mixed = 0, unlabelled = 0;
  double off = 0.0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    double all = 0.0, most = 0.0, second = 0.0;
    std::size_t best = 0;
    for (std::size_t k = 0; k < alone.size(); ++k) {
      const double e = alone[k][i];
      all += e;
      if (e > most)
        second = most, most = e, best = k;
      else
        second = std::max(second, e);
    }
    const bool labelled = found.classes[i] != sonar::kWater && found.classes[i] != sonar::kShadow;
    // Far side lobes fill no bin: 30 dB under what they belong to.
    if (!labelled) {
      EXPECT_LT(all, 4e-3 * loudest) << i;
      ++unlabelled;
      continue;
    }
    if (second > 0.97 * most || all < 1e-3 * loudest) continue;
    EXPECT_EQ(found.instances[i], scene.objects[best].instance) << i;
    // A ray's echo counts evenly over the bins that it spans, which the gather weighs.
    EXPECT_NEAR(found.fraction[i], most / all, 0.12) << i;
    off += std::abs(found.fraction[i] - most / all);
    ++compared;
    mixed += most < 0.9 * all;
  }
  EXPECT_LT(off / compared, 0.002);
  EXPECT_GT(compared, 2000);
  EXPECT_GT(mixed, 100);
  EXPECT_GT(unlabelled, 100);
}

// Terms that spread nothing leave labels as the rays bring them; those that do fill the bins
// between.
TEST_F(SonarLabels, ABinThatOnlyThePulseFillsIsNoWater) {
  scene::Sonar sonar = sonar_of(3.5, 4.5, 100);
  sonar.terms.labels.energy = true;
  scene::Scene scene = wall(4.0, sonar);
  scene.objects[0].mount.pose.position_m.z -= 0.005;  // to the middle of a bin
  const auto rows = [&](const SonarFrame& frame) {
    int heard = 0;
    for (std::uint32_t row = 0; row < 100; ++row)
      heard += frame.label_energy->instances[std::size_t{row} * 128 + 64] == 1;
    return heard;
  };
  const int plain = rows(ping(device(), scene));
  scene.sonars[0].terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 15e3};  // 5 bins
  const SonarFrame spread = ping(device(), scene);
  EXPECT_GE(rows(spread), plain + 6);
  // And before the wall that the pulse does not reach there is water.
  EXPECT_EQ(spread.label_energy->classes[std::size_t{10} * 128 + 64], sonar::kWater);
}

}  // namespace
}  // namespace neritic::testbed
