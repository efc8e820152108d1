// A sonar whose scene names nothing of its sampling hears simple shapes as an independent ray
// caster does, and small ones in every ping.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/scene/shapes.hpp"
#include "sonar/quality.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"
#include "tools/tradeoff/flatten.hpp"
#include "tools/tradeoff/kind_bench.hpp"
#include "tools/tradeoff/kind_truth.hpp"
#include "tools/tradeoff/term_judges.hpp"

namespace neritic::tools {
namespace {

using SonarDefault = test::GpuTest;

// A shape 6 m away, and the bearings that it lies between.
struct Target {
  const char* name;
  double from_deg, to_deg;
  const char* object;
};

const Target kTargets[] = {
    {"tilted_wall", -30, -19,
     "shape = \"box\"\nsize_m = [1.0, 0.9, 0.1]\nposition_m = [-2.54, -9.9, -5.44]\nyaw_deg = 50\n"
     "pitch_deg = 15"},
    {"ball", -19, -9,
     "shape = \"sphere\"\nradius_m = 0.2\nsegments = 96\nposition_m = [-1.45, -10.2, -5.82]"},
    {"pole", -9, 1,
     "shape = \"cylinder\"\nradius_m = 0.05\nheight_m = 0.9\nposition_m = [-0.42, -10, -5.99]\n"
     "roll_deg = 8"},
    {"lying_pipe", 1, 14,
     "shape = \"cylinder\"\nradius_m = 0.12\nheight_m = 1\nposition_m = [0.73, -10.2, -5.95]\n"
     "roll_deg = 90\nyaw_deg = 20"},
    {"cube", 14, 25,
     "shape = \"box\"\nsize_m = [0.5, 0.5, 0.5]\nposition_m = [2.05, -10.1, -5.64]\nyaw_deg = 35"},
    {"floor", 25, 30, "shape = \"plane\"\nsize_m = [40, 40]\nposition_m = [0, -10.9, 0]"}};
constexpr double kAperture_deg = 60.0;
constexpr std::uint32_t kBeams = 240;

std::string scene_text() {
  std::string text;
  for (const Target& target : kTargets)
    text += fmt::format("[[objects]]\nname = \"{}\"\n{}\n", target.name, target.object);
  return text +
         fmt::format(
             "[[sonars]]\nname = \"sonar\"\nposition_m = [0, -10, 0]\nrange_m = [4.5, 8]\n"
             "azimuth_deg = {}\nelevation_deg = 18\nbins = [280, {}, 100]\nbandwidth_hz = 30e3\n"
             "beam = {{ azimuth = \"hamming\", azimuth_deg = 0.7 }}\n",
             kAperture_deg, kBeams);
}

// The beams between two bearings of [range][beam].
template <class T>
std::vector<T> between(const std::vector<T>& image, const Target& target) {
  std::vector<T> out;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const double bearing_deg = (i % kBeams + 0.5) / kBeams * kAperture_deg - kAperture_deg / 2.0;
    if (bearing_deg > target.from_deg && bearing_deg < target.to_deg) out.push_back(image[i]);
  }
  return out;
}

TEST_F(SonarDefault, HearsSixShapesAsRaysDo) {
  const test::ScratchFolder scratch;
  const auto file = scratch.path() / "scene.toml";
  NERITIC_ASSERT_STATUS(write_text(file, scene_text()));
  NERITIC_ASSERT_OK(const scene::Scene scene, scene::load_scene(file));
  std::vector<scene::Sonar> sonars{scene.sonars[0]};
  NERITIC_ASSERT_STATUS(sonar::apply_quality(sonars[0]));
  const Vec3 origin_m = scene.sonars[0].mount.pose.position_m;
  NERITIC_ASSERT_OK(const auto world,
                    make_triangle_world(flatten(scene, 0.0, Pose{-origin_m, Quat(1, 0, 0, 0)})));
  const KindSetting kind{sonars[0], {}, {{scene.sonars[0].mount.pose, 0}}};
  KindBench bench(kind);
  NERITIC_ASSERT_STATUS(bench.open(device(), scene));
  NERITIC_ASSERT_OK(const auto rendered, bench.render(sonars[0], 0));
  NERITIC_ASSERT_OK(const KindTruth truth,
                    trace_kind(*world, origin_m, bench.placed(), sonars, {4.0, 6.0, 1500}));
  double mean = 0.0;
  for (const Target& target : kTargets) {
    const double error =
        difference(between(rendered.image, target), between(truth.images[0], target)).l1;
    fmt::print("{:>11}: {:.4f}, rays {:.4f}\n", target.name, error, truth.uncertain);
    EXPECT_LT(error, 0.03) << target.name;
    mean += error / static_cast<double>(std::size(kTargets));
  }
  EXPECT_LT(mean, 0.02);
}

}  // namespace
}  // namespace neritic::tools
