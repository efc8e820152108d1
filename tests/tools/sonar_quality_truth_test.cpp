// Named quality levels keep what they promise: the sensors that they were measured with, sampled as
// the levels say, rendered, and held against rays through the same scene.
#include <gtest/gtest.h>

#include "sonar/quality.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"
#include "tools/tradeoff/flatten.hpp"
#include "tools/tradeoff/kind_sweep.hpp"
#include "tools/tradeoff/kind_truth.hpp"
#include "tools/tradeoff/term_judges.hpp"

namespace neritic::tools {
namespace {

struct QualityCase {
  scene::SonarKind kind;
  std::size_t
      shots;  // of the kind's, for time's sake, and fewer rays than the levels were found by
  TruthRays rays;
  std::uint32_t part = 1;  // of the aperture, with its beams: one by so many
};
void PrintTo(const QualityCase& c, std::ostream* out) {
  *out << scene::name_of(c.kind);
}

class QualityTruth : public test::GpuTest, public ::testing::WithParamInterface<QualityCase> {};

TEST_P(QualityTruth, EachLevelStaysUnderItsBound) {
  NERITIC_ASSERT_OK(const scene::Scene scene,
                    scene::load_scene(test::source_dir() / "assets/scenes/harbour.toml"));
  const Vec3 origin_m = place_of(scene).position_m;
  NERITIC_ASSERT_OK(const auto world,
                    make_triangle_world(flatten(scene, 0.0, Pose{-origin_m, Quat(1, 0, 0, 0)})));
  auto kinds = kind_settings(scene, world->cast(Vec3(0, -1, 0)).t);
  KindSetting& kind =
      *std::ranges::find_if(kinds, [](const auto& k) { return k.base.kind == GetParam().kind; });
  ASSERT_GE(kind.shots.size(), GetParam().shots);
  kind.shots.resize(GetParam().shots);
  kind.base.azimuth_rad /= GetParam().part;
  kind.base.bins_azimuth /= GetParam().part;
  KindBench bench(kind);
  NERITIC_ASSERT_STATUS(bench.open(device(), scene));
  std::vector<scene::Sonar> sonars;
  for (const ErrorLevel& level : kErrorLevels) {
    sonars.push_back(kind.base);
    sonars.back().quality = level.name;
    NERITIC_ASSERT_STATUS(sonar::apply_quality(sonars.back()));
  }
  std::vector<std::vector<float>> images;
  for (const scene::Sonar& sonar : sonars) {
    NERITIC_ASSERT_OK(const auto rendered, bench.render(sonar, 0));
    images.push_back(rendered.image);
  }
  NERITIC_ASSERT_OK(const KindTruth truth,
                    trace_kind(*world, origin_m, bench.placed(), sonars, GetParam().rays));
  // The rays' own error, from their two halves, is small beside what they are to tell.
  EXPECT_LT(truth.uncertain, 0.003);
  for (std::size_t i = 0; i < sonars.size(); ++i) {
    const ErrorLevel& level = kErrorLevels[i];
    const ImageDifference found = difference(images[i], truth.images[i]);
    fmt::print("{} {}: error {:.4f}, of the rays {:.4f}\n", scene::name_of(kind.base.kind),
               level.name, found.l1, truth.uncertain);
    EXPECT_LT(found.l1, level.max_error) << level.name;
    EXPECT_LT(std::abs(found.energy), level.max_error) << level.name;
    // A profiler's nearest pixels differ from its cells' middles by less than its bins.
    if (kind.base.kind == scene::SonarKind::kProfiling) continue;
    // A sensor without the levels' sampling would be far off: the bound is no matter of course.
    scene::Sonar coarse = sonars[i];
    coarse.gather = "nearest";
    NERITIC_ASSERT_OK(const auto rendered, bench.render(coarse, 0));
    EXPECT_GT(difference(rendered.image, truth.images[i]).l1, found.l1) << level.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sonar, QualityTruth,
    ::testing::Values(QualityCase{scene::SonarKind::kImaging, 1, {6.0, 16.0, 2500}, 2},
                      QualityCase{scene::SonarKind::kProfiling, 1, {8.0, 24.0, 256}},
                      QualityCase{scene::SonarKind::kEchoSounder, 6, {8.0, 24.0, 512}},
                      QualityCase{scene::SonarKind::kSideScan, 2, {8.0, 16.0, 4000}},
                      QualityCase{scene::SonarKind::kMechanical, 2, {32.0, 32.0, 2000}}),
    [](const auto& info) { return std::string(scene::name_of(info.param.kind)); });

}  // namespace
}  // namespace neritic::tools
