// Targets much smaller than a sonar's cells: heard at any place, with the level of the sonar
// equation.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/files.hpp"
#include "sonar/head_pattern.hpp"
#include "sonar/sound_speed_profile.hpp"
#include "testbed/sensors/small_targets.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {
namespace small {

constexpr double kRadius_m = 0.005, kNearest_m = 7.0, kApart_m = 0.1, kMargin_m = 0.4;
constexpr int kPings = 5, kAPing = 12, kPlaces = kPings * kAPing;
constexpr double kAperture_rad = radians(12.0);
constexpr double kSound_m_s = 1500.0;

// A device of assets/sensors over 7 to 13 m with its own bins, beams and pattern, at the level that
// a scene gets.
scene::Sonar device_of(const std::string& preset) {
  const test::ScratchFolder scratch;
  const auto file = scratch.path() / "scene.toml";
  EXPECT_TRUE(write_text(file, fmt::format("[[sonars]]\nname = \"sonar\"\nquality = \"standard\"\n"
                                           "include = \"{}/assets/sensors/{}.toml\"\n",
                                           test::source_dir().string(), preset))
                  .ok());
  const auto scene = scene::load_scene(file);
  EXPECT_TRUE(scene.ok()) << scene.error().message;
  scene::Sonar sonar = scene->sonars[0];
  const double bin_m = (sonar.range_max_m - sonar.range_min_m) / sonar.bins_range;
  sonar.range_min_m = kNearest_m - kMargin_m;
  sonar.range_max_m = kNearest_m + kPlaces * kApart_m + kMargin_m;
  sonar.bins_range =
      static_cast<std::uint32_t>(std::round((sonar.range_max_m - sonar.range_min_m) / bin_m));
  // A part of the beams is as good as all.
  sonar.bins_azimuth = static_cast<std::uint32_t>(
      std::round(sonar.bins_azimuth * kAperture_rad / sonar.azimuth_rad));
  sonar.azimuth_rad = kAperture_rad;
  sonar.terms.water.sound_speed_m_s = kSound_m_s;
  sonar.terms.level = plain_level();
  return sonar;
}

struct Ball {
  double range_m, azimuth_rad, elevation_rad;
};

// Those of one ping, side by side; no two have the same part of a cell.
std::vector<Ball> balls(const scene::Sonar& sonar, int ping_number) {
  std::vector<Ball> out;
  for (int k = 0; k < kAPing; ++k) {
    const int i = ping_number * kAPing + k;
    const auto golden = [&](double step) { return std::fmod(0.5 + i * step, 1.0) - 0.5; };
    const double place = (k + 0.5 + 0.4 * golden(0.7548776662)) / kAPing - 0.5;
    out.push_back({kNearest_m + i * kApart_m, 0.9 * sonar.azimuth_rad * place,
                   0.7 * sonar.elevation_rad * golden(0.5698402910)});
  }
  return out;
}

scene::Scene scene_of(const scene::Sonar& sonar, const std::vector<Ball>& places) {
  scene::Scene scene;
  for (const Ball& ball : places)
    scene.objects.push_back(
        object_of(scene, scene::make_sphere(kRadius_m, 32),
                  ball.range_m * sonar::direction(ball.azimuth_rad, ball.elevation_rad)));
  scene.sonars = {sonar};
  return scene;
}

// Each ball's energy over all beams, over what SL - 40 log r - 2 alpha r + 10 log a^2 / 4 gives
// through the patterns; 0: silent.
std::vector<double> over_closed_form(const SonarFrame& frame, const scene::Sonar& sonar,
                                     const std::vector<Ball>& places) {
  const auto patterns = sonar::head_patterns(sonar);
  EXPECT_TRUE(patterns.ok());
  const double bin_m = frame.grid.range_step_m();
  const double pulse_m = 1.5 * kSound_m_s / (2.0 * sonar.terms.range_spread->bandwidth_hz);
  std::vector<double> out;
  for (const Ball& ball : places) {
    double heard = 0.0, beams = 0.0;
    for (std::uint32_t row = 0; row < frame.image.n_range; ++row) {
      if (std::abs(frame.grid.range_m(row) - ball.range_m) > kApart_m / 2.0) continue;
      for (std::uint32_t c = 0; c < frame.image.n_azimuth; ++c)
        heard += frame.image.intensity[std::size_t{row} * frame.image.n_azimuth + c];
    }
    for (std::uint32_t c = 0; c < frame.image.n_azimuth; ++c) {
      const double a =
          patterns->across(ball.azimuth_rad - frame.grid.azimuth_rad(c), frame.grid.azimuth_rad(c));
      beams += a * a;
    }
    const double r = ball.range_m - kRadius_m / 2.0;
    const double echo = std::pow(10.0, 20.0 - 0.2 * 0.3 * r) / std::pow(r, 4) * kRadius_m *
                        kRadius_m / 4.0 * patterns->power(ball.azimuth_rad, ball.elevation_rad) *
                        beams;
    out.push_back(heard * bin_m / pulse_m / echo);
  }
  return out;
}

// The same balls as copies of one object.
scene::Scene as_copies(scene::Scene scene) {
  scene::Object one = scene.objects.front();
  for (const scene::Object& object : scene.objects)
    one.copies.push_back(glm::translate(Mat4(1.0), object.mount.pose.position_m));
  one.mount.pose = {};
  scene.objects = {one};
  return scene;
}

// The same balls with skins: the joint of each has moved its vertices from far away.
scene::Scene as_skinned(scene::Scene scene) {
  for (const auto& shared : scene.models) {
    scene::Model& model = const_cast<scene::Model&>(*shared);
    const Vec3 far_m(0.0, 3.0, 0.0);
    const int joint = static_cast<int>(model.nodes.size());
    model.nodes.push_back({});
    model.roots.push_back(joint);
    scene::Skin skin;
    skin.joints = {joint};
    skin.inverse_bind = {glm::translate(Mat4(1.0), -far_m)};
    model.skins.push_back(skin);
    model.nodes.front().skin = 0;
    for (scene::Mesh& mesh : model.meshes)
      for (scene::Primitive& primitive : mesh.primitives) {
        for (auto& position : primitive.positions) position += Vec3f(far_m);
        primitive.joints.assign(primitive.positions.size(), {0, 0, 0, 0});
        primitive.weights.assign(primitive.positions.size(), Vec4f(1.0f, 0.0f, 0.0f, 0.0f));
      }
  }
  return scene;
}

class SmallTargets : public test::GpuTest, public testing::WithParamInterface<const char*> {};

TEST_P(SmallTargets, ABallOfOneCentimetreIsHeardAtItsLevelInEveryPlace) {
  const scene::Sonar sonar = device_of(GetParam());
  std::vector<double> ratios;
  for (int number = 0; number < kPings; ++number) {
    const std::vector<Ball> places = balls(sonar, number);
    for (const double ratio :
         over_closed_form(ping(device(), scene_of(sonar, places)), sonar, places))
      ratios.push_back(ratio);
  }
  double mean = 0.0, least = 1e9, most = 0.0;
  for (const double ratio : ratios) {
    mean += ratio / kPlaces;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  fmt::print("{}: {:.2f} to {:.2f} dB, mean {:.2f} dB of the closed form\n", GetParam(),
             10.0 * std::log10(least), 10.0 * std::log10(most), 10.0 * std::log10(mean));
  EXPECT_GT(10.0 * std::log10(least), -1.2);
  EXPECT_LT(10.0 * std::log10(most), 1.2);
  EXPECT_NEAR(10.0 * std::log10(mean), 0.0, 0.4);
}

INSTANTIATE_TEST_SUITE_P(Devices, SmallTargets,
                         testing::Values("oculus_m1200d", "oculus_m750d", "gemini_720is",
                                         "blueview_p900_45"),
                         [](const auto& info) { return std::string(info.param); });

using SmallTargetsOfAKind = test::GpuTest;

TEST_F(SmallTargetsOfAKind, CopiesAndSkinnedBallsAreAsLoudAsSingleOnes) {
  const scene::Sonar sonar = device_of("blueview_p900_45");
  const std::vector<Ball> places = balls(sonar, 1);
  const scene::Scene single = scene_of(sonar, places);
  const auto plain = over_closed_form(ping(device(), single), sonar, places);
  const auto copies = over_closed_form(ping(device(), as_copies(single)), sonar, places);
  const auto skinned = over_closed_form(ping(device(), as_skinned(single)), sonar, places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(10.0 * std::log10(copies[i] / plain[i]), 0.0, 0.05) << i;
    EXPECT_NEAR(10.0 * std::log10(skinned[i]), 0.0, 1.2) << i;
  }
}

// A copy that no object stands for is met too, and a crowd of many keeps its size.
TEST_F(SmallTargetsOfAKind, ACrowdKeepsItsSize) {
  const scene::Sonar sonar = device_of("blueview_p900_45");
  scene::Scene crowd = as_copies(scene_of(sonar, balls(sonar, 1)));
  EXPECT_NEAR(least_object_m(crowd), 2.0 * kRadius_m, 1e-8);
  crowd.objects[0].copies.resize(render::kMostDrawnLarger + 1, Mat4(1.0));
  EXPECT_EQ(least_object_m(crowd), 0.0);
}

using SmallTargetsOnABottom = test::GpuTest;

// A thing that is drawn larger grows away from the bottom, which would hide half of it.
TEST_F(SmallTargetsOnABottom, ABallThatLiesOnTheBottomIsAsLoudAsOneInOpenWater) {
  const scene::Sonar sonar = device_of("blueview_p900_45");
  const std::vector<Ball> places{{8.0, 0.01, radians(-4.0)}};
  scene::Scene scene = scene_of(sonar, places);
  const double open = over_closed_form(ping(device(), scene), sonar, places).front();
  const double bottom_m = 8.0 * std::sin(radians(-4.0)) - kRadius_m;
  scene.objects.push_back(
      object_of(scene, scene::make_box(Vec3(60.0, 1.0, 60.0)), {0.0, bottom_m - 0.5, 0.0}));
  scene.objects.back().backscatter_db = -150.0;
  const double lying = over_closed_form(ping(device(), scene), sonar, places).front();
  EXPECT_NEAR(10.0 * std::log10(lying / open), 0.0, 0.7);
}

// It is drawn over fifteen degrees, and heard by the water on the way to where it is.
TEST_F(SmallTargetsOfAKind, ABallIsHeardByTheSpeedOfTheWaterOnTheWayToIt) {
  constexpr double kBall_m = 0.25, kShallow_m = 5.0;
  const Vec3 at(0.0, -20.0, -100.0);
  const double centre_m = glm::length(at), down_rad = std::asin(at.y / centre_m);
  scene::Sonar sonar = sonar_of(97.0, 107.0, 2000);
  sonar.azimuth_rad = sonar.elevation_rad = radians(60.0);
  sonar.bins_azimuth = 61;
  sonar.bins_elevation = 300;
  sonar.mount.pose.position_m = {0.0, -kShallow_m, 0.0};
  sonar.terms.water.sound_speed_m_s = 1525.0;
  sonar.terms.level = plain_level();
  const scene::SonarTable speeds{{0.0, 1525.0}, {14.0, 1525.0}, {16.0, 1490.0}, {100.0, 1490.0}};
  const auto profile = sonar::SoundSpeedProfile::of_table(
      {{0.0, 1525.0}, {14.0, 1525.0}, {16.0, 1490.0}, {100.0, 1490.0}});
  ASSERT_TRUE(profile.ok());
  scene::Scene scene;
  scene.objects = {
      object_of(scene, scene::make_sphere(kBall_m, 64), at - Vec3(0.0, kShallow_m, 0.0))};
  for (const bool bent : {false, true}) {
    sonar.terms.profile = scene::SonarProfile{speeds, bent};
    scene.sonars = {sonar};
    // Lambert's sphere echoes from three quarters of its radius before its centre, on average.
    const double nearer_m = 0.75 * kBall_m;
    double heard_m = 1525.0 * profile->straight_time_s(kShallow_m, down_rad, centre_m - nearer_m);
    if (bent) {  // by Fermat: the fastest way through ten metres of either water
      double least_s = 1.0;
      for (double x = 40.0; x < 90.0; x += 0.01)
        least_s =
            std::min(least_s, std::hypot(x, 10.0) / 1525.0 + std::hypot(at.z + x, 10.0) / 1490.0);
      heard_m = 1525.0 * least_s * (1.0 - nearer_m / centre_m);
    }
    EXPECT_NEAR(mean_range_m(ping(device(), scene)), heard_m, bent ? 0.05 : 0.03) << bent;
  }
}

TEST(SmallTargetPlaces, NeighboursGrowNoFartherThanToEachOther) {
  // One above another, one beside, one behind.
  const auto place = [](double azimuth, double elevation) {
    return render::DrawnPlace{
        azimuth,         0.02, 0.001, elevation - 0.001, elevation - 0.001, elevation + 0.001,
        elevation + 0.05};
  };
  render::DrawnPlace upright[] = {place(0.0, 0.0), place(0.0, 0.01)};
  render::keep_apart(upright);
  EXPECT_LE(upright[0].high_rad, upright[1].low_rad + 1e-12);
  EXPECT_GE(upright[0].high_rad, upright[0].own_high_rad);
  EXPECT_DOUBLE_EQ(upright[1].high_rad, 0.06);
  render::DrawnPlace level[] = {place(0.0, 0.0), place(0.01, 0.0)};
  render::keep_apart(level);
  EXPECT_LE(level[0].half_wide_rad + level[1].half_wide_rad, 0.01 + 1e-12);
  render::DrawnPlace behind[] = {place(0.0, 0.0), place(0.0005, 0.0005)};
  render::keep_apart(behind);
  for (const render::DrawnPlace& p : behind) {
    EXPECT_EQ(p.high_rad, p.own_high_rad);
    EXPECT_EQ(p.half_wide_rad, p.own_half_wide_rad);
  }
}

}  // namespace small
}  // namespace
}  // namespace neritic::testbed
