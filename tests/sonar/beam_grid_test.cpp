#include "sonar/beam_grid.hpp"

#include <gtest/gtest.h>

#include "engine/core/intrinsics.hpp"

namespace neritic {
namespace {

using sonar::BeamGrid;

TEST(SonarBins, AreFloorsOfTheHalfOpenInterval) {
  EXPECT_EQ(sonar::bin_index(1.0, 1.0, 5.0, 500), 0u);
  EXPECT_EQ(sonar::bin_index(2.75, 1.0, 5.0, 500), 218u);
  EXPECT_EQ(sonar::bin_index(4.9999999, 1.0, 5.0, 500), 499u);
  EXPECT_EQ(sonar::bin_index(std::nextafter(5.0, 0.0), 1.0, 5.0, 500), 499u);
  EXPECT_FALSE(sonar::bin_index(5.0, 1.0, 5.0, 500));
  EXPECT_FALSE(sonar::bin_index(0.9999, 1.0, 5.0, 500));
  EXPECT_FALSE(sonar::bin_index(std::nan(""), 1.0, 5.0, 500));
}

TEST(SonarBins, PointDeadAheadFallsInCentreBearingBin) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {500, 501, 29});
  const auto cell = sonar::cell_of(grid, Vec3(0, 0, -3));
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->azimuth, 250u);
  EXPECT_EQ(cell->elevation, 14u);
  EXPECT_EQ(cell->range, 250u);
  // Starboard is the last column, above the last row.
  EXPECT_GT(sonar::cell_of(grid, Vec3(1, 0, -3))->azimuth, 250u);
  EXPECT_GT(sonar::cell_of(grid, Vec3(0, .5, -3))->elevation, 14u);
  EXPECT_FALSE(sonar::cell_of(grid, Vec3(0, 0, 3)));
  EXPECT_FALSE(sonar::cell_of(grid, Vec3(0.0)));
}

// Every direction of the wedge, corners included, lies inside the frustum of exactly its sector.
void expect_covered(const BeamGrid& grid, std::size_t sectors_expected) {
  const auto sectors = sonar::plan_sectors(grid);
  ASSERT_EQ(sectors.size(), sectors_expected);
  std::uint32_t next = 0;
  for (const auto& sector : sectors) {
    EXPECT_EQ(sector.first_column, next);
    next = sector.end_column;
    const Mat3 view_from_sonar = glm::transpose(sonar::sonar_from_view(sector.yaw_rad));
    double reach_x = 0.0, reach_top = -1e9, reach_bottom = 1e9;
    for (int a = 0; a <= 40; ++a)
      for (int e = 0; e <= 40; ++e) {
        const double azimuth = glm::mix(sector.azimuth_min_rad, sector.azimuth_max_rad, a / 40.0);
        const double elevation =
            glm::mix(grid.limits.elevation_min_rad, grid.limits.elevation_max_rad, e / 40.0);
        const Vec3 d = view_from_sonar * sonar::direction(azimuth, elevation);
        ASSERT_LT(d.z, 0.0);
        const double x = d.x / -d.z, y = d.y / -d.z;
        EXPECT_GE(x, sector.tangents.left - 1e-9);
        EXPECT_LE(x, sector.tangents.right + 1e-9);
        EXPECT_GE(y, sector.tangents.bottom - 1e-9);
        EXPECT_LE(y, sector.tangents.top + 1e-9);
        reach_x = std::max(reach_x, std::abs(x));
        reach_top = std::max(reach_top, y);
        reach_bottom = std::min(reach_bottom, y);
      }
    // And the frustum wastes nothing: the wedge touches every side.
    EXPECT_NEAR(reach_x, sector.tangents.right, 1e-9);
    EXPECT_NEAR(reach_top, sector.tangents.top, 1e-9);
    EXPECT_NEAR(reach_bottom, sector.tangents.bottom, 1e-9);
    for (std::uint32_t c = sector.first_column; c < sector.end_column; ++c) {
      EXPECT_GE(grid.azimuth_rad(c), sector.azimuth_min_rad - 1e-12);
      EXPECT_LE(grid.azimuth_rad(c), sector.azimuth_max_rad + 1e-12);
    }
  }
  EXPECT_EQ(next, grid.bins.azimuth);
}

TEST(SonarSectors, CoverTheWedgeWithItsCorners) {
  expect_covered(sonar::symmetric_grid(1, 5, radians(90), radians(28), {5, 500, 5}), 1);
  expect_covered(sonar::symmetric_grid(1, 5, radians(170), radians(28), {5, 333, 5}), 2);
  expect_covered(sonar::symmetric_grid(1, 5, radians(360), radians(120), {5, 7, 5}), 4);
  expect_covered(sonar::symmetric_grid(1, 5, radians(360), radians(0.5), {5, 1, 5}), 4);
  expect_covered({{1, 5, radians(-20), radians(70), radians(-60), radians(-20)}, {5, 90, 5}}, 1);
  expect_covered({{1, 5, radians(-90), radians(70), radians(10), radians(50)}, {5, 90, 5}}, 2);
}

TEST(SonarSectors, APixelACellIsAsFineAsTheCellOnTheAxis) {
  const BeamGrid grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {500, 500, 500});
  const auto sector = sonar::plan_sectors(grid).at(0);
  EXPECT_EQ(sector.yaw_rad, 0.0);
  const auto size = sonar::gbuffer_size(grid, sector, 1.0);
  EXPECT_EQ(size.width, 637u);   // 2 tan 45 / (90 degrees / 500)
  EXPECT_EQ(size.height, 722u);  // 2 tan 14 / cos 45 / (28 degrees / 500)
  EXPECT_EQ(sonar::gbuffer_size(grid, sector, 1e6, 4096).width, 4096u);
}

// All of the wedge lies within leaning sides, at the same pixels a cell, and rows are shifted by
// parts of a pixel that never come close to repeating.
TEST(SonarSectors, ALeaningViewCoversTheWedgeAndItsRowsFillEachOthersGaps) {
  for (const BeamGrid& grid :
       {sonar::symmetric_grid(1, 5, radians(90), radians(28), {5, 500, 500}),
        sonar::symmetric_grid(1, 5, radians(360), radians(20), {5, 900, 64}),
        sonar::symmetric_grid(1, 5, radians(90), radians(1), {5, 512, 8}),
        sonar::symmetric_grid(1, 5, radians(1), radians(60), {5, 4, 2000}),
        BeamGrid{{1, 5, radians(-20), radians(70), radians(-60), radians(-20)}, {5, 90, 200}}}) {
    const auto sector = sonar::plan_sectors(grid).at(0);
    const FrustumTangents& t = sector.tangents;
    for (const double scale : {0.5, 1.4}) {
      const auto upright = sonar::gbuffer_size(grid, sector, scale);
      const auto leaning = sonar::leaning_view(grid, sector, scale);
      for (const double x : {t.left, t.right})
        for (const double y : {t.bottom, t.top}) {
          EXPECT_GE(x - leaning.lean * y, leaning.tangents.left - 1e-12);
          EXPECT_LE(x - leaning.lean * y, leaning.tangents.right + 1e-12);
        }
      EXPECT_EQ(leaning.size.height, upright.height);
      EXPECT_LE(leaning.size.width, 1.25 * upright.width + 6.0);
      const auto k = intrinsics_of(leaning.tangents, leaning.size.width, leaning.size.height);
      const double fx = upright.width / (t.right - t.left);
      EXPECT_GE(k.fx / fx, 1.0 - 1e-12);
      EXPECT_LE(k.fx / fx, 1.0 + 1.0 / upright.width);
      // Shifts of the first rows, in order: no gap is much wider than the mean.
      const double shift = k.fx * leaning.lean / k.fy;
      const auto rows = static_cast<int>(std::ceil(8.0 / shift));
      std::vector<double> shifts;
      for (int row = 0; row < rows; ++row) shifts.push_back(std::fmod(row * shift, 1.0));
      std::sort(shifts.begin(), shifts.end());
      double widest = 1.0 - shifts.back();
      for (int i = 1; i < rows; ++i) widest = std::max(widest, shifts[i] - shifts[i - 1]);
      EXPECT_LT(widest * rows, 2.7 / shift / 4.0) << shift;
    }
  }
}

TEST(SonarLimits, ThatCannotBeAreRefusedByName) {
  auto grid = sonar::symmetric_grid(1, 5, radians(90), radians(28), {500, 500, 500});
  EXPECT_TRUE(sonar::validate(grid).ok());
  auto wrong = grid;
  wrong.limits.range_max_m = 0.5;
  EXPECT_NE(sonar::validate(wrong).error().message.find("range"), std::string::npos);
  wrong = grid;
  wrong.limits.azimuth_max_rad = 7.0;
  EXPECT_NE(sonar::validate(wrong).error().message.find("azimuth"), std::string::npos);
  wrong = grid;
  wrong.limits.elevation_min_rad = std::nan("");
  EXPECT_NE(sonar::validate(wrong).error().message.find("elevation"), std::string::npos);
  wrong = grid;
  wrong.bins.elevation = 0;
  EXPECT_NE(sonar::validate(wrong).error().message.find("elevation"), std::string::npos);
}

}  // namespace
}  // namespace neritic
