#include "sonar/terrain_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/image_file.hpp"
#include "sonar/bottom_detection.hpp"
#include "sonar/point_cloud.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::Bathymetry;
using sonar::CompareAt;

const double kNan = std::nan("");

TEST(TerrainError, StatisticsAreThoseOfTheErrors) {
  std::vector<Vec3> points;
  for (int i = 1; i <= 100; ++i) points.emplace_back(i, -10.0 - 0.01 * i, 0.0);
  points.emplace_back(-50.0, -10.0, 0.0);  // where nothing is known
  const auto flat = [](double x, double) { return x < 0 ? kNan : 10.0; };
  const auto error = sonar::point_error(points, flat);
  EXPECT_EQ(error.count, 100u);
  EXPECT_NEAR(error.mean_m, 0.505, 1e-9);
  EXPECT_NEAR(error.rms_m, 0.01 * std::sqrt(101.0 * 201.0 / 6.0), 1e-9);
  EXPECT_NEAR(error.p95_m, 0.95, 1e-9);
  EXPECT_NEAR(error.max_m, 1.0, 1e-9);
  const auto none = sonar::point_error({}, flat);
  EXPECT_EQ(none.count, 0u);
  EXPECT_TRUE(std::isnan(none.rms_m));
}

TEST(TerrainError, AtTheCentroidASlopeIsExactAndAtTheCentreItScatters) {
  const auto slope = [](double x, double z) { return 20.0 + 0.5 * x - 0.25 * z; };
  Bathymetry bathymetry(1.0);
  for (int i = 0; i < 4000; ++i) {
    const double x = std::fmod(i * 0.618033988, 10.0), z = std::fmod(i * 0.414213562, 8.0);
    if (x > 3.0 && x < 4.0) continue;  // a column that nobody sounded
    bathymetry.add(Vec3(x, -slope(x, z), z));
  }
  const auto grid = bathymetry.grid().value();
  const auto at_centroid = sonar::grid_error(grid, slope, CompareAt::kCentroid);
  EXPECT_EQ(at_centroid.count, 72u);
  EXPECT_LT(at_centroid.max_m, 1e-4);
  EXPECT_NEAR(at_centroid.coverage, 0.9, 1e-9);
  EXPECT_GT(sonar::grid_error(grid, slope, CompareAt::kCellCentre).rms_m, 1e-3);
}

TEST(TerrainError, TheTrueDepthIsOnTheMeshsTriangles) {
  auto field = std::make_shared<scene::Heightfield>();
  field->columns = 9;
  field->rows = 7;
  field->cell_m = 2.0;
  for (int i = 0; i < 63; ++i) field->heights_m.push_back(static_cast<float>((i * 29) % 17) * 0.3f);
  field->heights_m[9 * 3 + 4] = NAN;
  const Vec3 position(1000.0, -40.0, -500.0);
  const auto truth = sonar::true_depth(field, position);
  // The mesh says itself where its surface is: each triangle at three inner points.
  const scene::Model model = scene::make_terrain(*field);
  const auto& primitive = model.meshes.at(0).primitives.at(0);
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
    const Vec3 a(primitive.positions[primitive.indices[i]]),
        b(primitive.positions[primitive.indices[i + 1]]),
        c(primitive.positions[primitive.indices[i + 2]]);
    for (const Vec3& w : {Vec3(0.6, 0.2, 0.2), Vec3(0.2, 0.6, 0.2), Vec3(0.1, 0.1, 0.8)}) {
      const Vec3 p = position + w.x * a + w.y * b + w.z * c;
      EXPECT_NEAR(truth(p.x, p.z), -p.y, 1e-5);
    }
  }
  EXPECT_TRUE(std::isnan(truth(1000.0 + 8.1, -500.0)));
  EXPECT_TRUE(std::isnan(truth(1000.0, -500.0)));  // the hole
  EXPECT_FALSE(std::isnan(truth(1008.0, -494.0)));
}

// The swath's image of a bottom by marching each beam's ray onto the heightfield: no code of the
// sonar's.
std::vector<float> survey_image(const sonar::BeamGrid& grid, const Pose& pose,
                                const sonar::TrueDepth& truth) {
  std::vector<float> image(std::size_t{grid.bins.range} * grid.bins.azimuth);
  constexpr int kAcross = 8;
  for (std::uint32_t beam = 0; beam < grid.bins.azimuth; ++beam)
    for (int i = 0; i < kAcross; ++i) {
      const double a =
          grid.azimuth_rad(beam) + ((i + 0.5) / kAcross - 0.5) * grid.azimuth_step_rad();
      const Vec3 d = pose.rotation * Vec3(std::sin(a), 0.0, -std::cos(a));
      const auto below = [&](double r) {
        const Vec3 p = pose.position_m + r * d;
        return -p.y - truth(p.x, p.z);
      };
      double r = grid.limits.range_min_m;
      const double step = 0.5;
      while (r < grid.limits.range_max_m && below(r) < 0.0) r += step;
      double low = r - step, high = r;
      for (int k = 0; k < 40; ++k) (below((low + high) / 2) < 0.0 ? low : high) = (low + high) / 2;
      if (const auto row = sonar::bin_index(low, grid.limits.range_min_m, grid.limits.range_max_m,
                                            grid.bins.range))
        image[*row * grid.bins.azimuth + beam] += 1.0f / kAcross;
    }
  return image;
}

// A lawn-mower track over real soundings, each ping's image by rays: what bottom detection, cloud
// and chart add is below half a range bin at nadir.
TEST(TerrainError, ALawnMowerSurveyOfARealBottomIsWithinHalfABinAtNadir) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto file = shared / "data" / "bathymetry" / "bathy-jd211" / "jd211_crop_a.asc";
  auto read = scene::read_heightfield(file, {});
  ASSERT_TRUE(read.ok()) << read.error().message;
  auto field = std::make_shared<const scene::Heightfield>(std::move(read).value());
  const auto truth = sonar::true_depth(field, Vec3(0.0));
  const double here = truth(0.3, 0.3);
  ASSERT_FALSE(std::isnan(here));
  const double altitude = 40.0;
  const sonar::BeamGrid grid =
      sonar::symmetric_grid(5.0, 105.0, radians(90), radians(0.5), {500, 180, 1});
  Bathymetry bathymetry(1.0);
  std::vector<Vec3> nadir;
  for (int line = -1; line <= 1; ++line)
    for (int ping = -30; ping <= 30; ++ping) {
      const double yaw = line % 2 == 0 ? 0.0 : kPi;
      const Pose pose{Vec3(line * 40.0, -here + altitude, ping * 1.0),
                      from_yaw_pitch_roll(yaw, radians(-90), 0.0)};
      const auto found = sonar::detect_bottom(grid, survey_image(grid, pose, truth));
      sonar::PointCloud cloud, below;
      sonar::append(cloud, grid, found, pose);
      sonar::append(below, grid, sonar::nadir_detections(grid, found, pose, radians(3)), pose);
      bathymetry.add(cloud.positions_m);
      nadir.insert(nadir.end(), below.positions_m.begin(), below.positions_m.end());
    }
  const auto chart = bathymetry.grid().value();
  const auto error = sonar::grid_error(chart, truth, CompareAt::kCentroid);
  const auto at_nadir = sonar::point_error(nadir, truth);
  fmt::print("grid: rms {:.3f} mean {:.3f} p95 {:.3f} max {:.3f} m, {} cells; nadir rms {:.3f} m\n",
             error.rms_m, error.mean_m, error.p95_m, error.max_m, error.count, at_nadir.rms_m);
  EXPECT_GT(error.count, 8000u);
  EXPECT_LT(at_nadir.rms_m, 0.5 * grid.range_step_m());
  EXPECT_LT(error.rms_m, grid.range_step_m());
  if (const char* keep = std::getenv("NERITIC_KEEP_PICTURES")) {
    ASSERT_TRUE(scene::write_png8(std::filesystem::path(keep) / "bathymetry.png",
                                  sonar::draw_bathymetry(chart))
                    .ok());
  }
}

}  // namespace
}  // namespace neritic
