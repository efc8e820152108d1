// The gathers against rays, and the parts of `neritic tradeoff sonar`.
#include "tools/tradeoff/sonar_tradeoff.hpp"

#include <gtest/gtest.h>

#include "engine/gpu/device.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
namespace {

sonar::BeamGrid grid_of(std::uint32_t bins) {
  return sonar::symmetric_grid(1, 5, radians(90), radians(28), {bins, bins, bins});
}

std::vector<sonar::SonarInput> images_of(const RayWorld& world, const sonar::BeamGrid& grid,
                                         double scale) {
  std::vector<sonar::SonarInput> images;
  for (const sonar::Sector& sector : sonar::plan_sectors(grid)) {
    const auto size = sonar::gbuffer_size(grid, sector, scale);
    images.push_back(cast_gbuffer(world, sector, size.width, size.height));
  }
  return images;
}

TEST(SonarAgainstRays, TheGpuIsNoWorseThanTheReferenceWhereEveryCellHasAPixel) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  const auto device = gpu::Device::create({.validation = gpu::validation_layer_present()});
  ASSERT_TRUE(device.ok()) << device.error().message;
  const auto world = make_analytic_world();
  const sonar::BeamGrid grid = grid_of(200);
  const auto truth = trace_truth(*world, grid, {grid.bins}, 8);
  const auto images = images_of(*world, grid, 1.3);
  const auto reference = compare(sonar::reference_image(grid, images).intensity, truth[0], 4.0);
  for (const sonar::Gather gather : {sonar::Gather::kNearest, sonar::Gather::kPlane}) {
    const auto point = measure_gather(**device, grid, images, gather, truth[0], 1);
    ASSERT_TRUE(point.ok()) << point.error().message;
    EXPECT_LE(point->error.l1, reference.l1) << name_of(gather);
    EXPECT_LE(point->error.shift_mm, reference.shift_mm) << name_of(gather);
    EXPECT_LT(std::abs(point->error.energy), 0.01) << name_of(gather);
  }
}

TEST(SonarAgainstRays, ThePlaneGatherNeedsHalfTheResolution) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  const auto device = gpu::Device::create({.validation = gpu::validation_layer_present()});
  ASSERT_TRUE(device.ok()) << device.error().message;
  const auto world = make_analytic_world();
  const sonar::BeamGrid grid = grid_of(250);
  const auto truth = trace_truth(*world, grid, {grid.bins}, 8);
  const auto coarse = images_of(*world, grid, 0.5), fine = images_of(*world, grid, 1.0);
  const auto plane = measure_gather(**device, grid, coarse, sonar::Gather::kPlane, truth[0], 1);
  const auto nearest = measure_gather(**device, grid, fine, sonar::Gather::kNearest, truth[0], 1);
  ASSERT_TRUE(plane.ok() && nearest.ok());
  EXPECT_LE(plane->error.l1, nearest->error.l1);
  EXPECT_LE(plane->error.shift_mm, 1.1 * nearest->error.shift_mm);
}

TEST(RayTruth, AWallOfTrianglesGivesTheClosedForm) {
  // A 40 x 40 m wall at 3 m: column theta returns the mean over elevation of cos(theta) cos(phi)
  // from 3 / (cos theta cos phi).
  scene::Scene scene;
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_plane(40, 40)));
  scene::Object wall;
  wall.model = 0;
  wall.mount.pose = {Vec3(0, 0, -3), glm::angleAxis(kPi / 2.0, Vec3(1, 0, 0))};  // +y turned to +z
  wall.reflectivity = 0.5f;
  scene.objects.push_back(wall);
  auto world = make_triangle_world(flatten(scene, 0.0, Pose{}));
  ASSERT_TRUE(world.ok());
  const sonar::BeamGrid grid = grid_of(50);
  const Truth truth = trace_truth(**world, grid, {grid.bins}, 4).front();
  for (const std::uint32_t c : {0u, 13u, 25u, 49u}) {
    const double theta = grid.azimuth_rad(c);
    double sum = 0.0;
    for (std::uint32_t r = 0; r < 50; ++r) {
      const double value = truth.intensity[r * 50 + c];
      sum += value;
      if (value > 0.0) {
        const double nearest = 3.0 / std::cos(std::abs(theta) - grid.azimuth_step_rad() / 2);
        const double farthest =
            3.0 / std::cos(std::abs(theta) + grid.azimuth_step_rad() / 2) / std::cos(radians(14));
        EXPECT_GE(grid.range_m(r), nearest - grid.range_step_m());
        EXPECT_LE(grid.range_m(r), farthest + grid.range_step_m());
      }
    }
    EXPECT_NEAR(sum, 0.5 * std::cos(theta) * std::sin(radians(14)) / radians(14), 1e-3) << c;
  }
}

TEST(Knee, IsWhereTheCurveBends) {
  const std::vector<double> cost{1, 2, 3, 4, 5, 6}, error{10, 4, 1.2, 1.1, 1.05, 1.0};
  EXPECT_EQ(knee_of(cost, error), 2u);
}

TEST(TradeoffSonar, WritesTableCurveAndSummary) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  SonarTradeoffOptions options;
  options.quick = true;
  std::uint64_t done = 0;
  options.step = [&] { ++done; };
  const auto tradeoff = run_sonar_tradeoff(options);
  ASSERT_TRUE(tradeoff.ok()) << tradeoff.error().message;
  EXPECT_EQ(done, steps(options));
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_plain(folder.path(), *tradeoff).ok());
  for (const char* name : {"tradeoff.csv", "tradeoff.png", "tradeoff.json", "plain.md"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
}

}  // namespace
}  // namespace neritic::tools
