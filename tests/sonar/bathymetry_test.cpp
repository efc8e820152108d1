#include "sonar/bathymetry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::Bathymetry;
using sonar::BathymetryGrid;

std::vector<Vec3> soundings(std::size_t n, const Vec3& about) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> across(-20.0, 20.0);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = across(random), z = across(random);
    points.push_back(about + Vec3(x, -10.0 - 0.1 * x + 0.3 * std::sin(z), z));
  }
  return points;
}

bool same(const BathymetryGrid& a, const BathymetryGrid& b) {
  const auto bits = [](const auto& u, const auto& v) {
    return u.size() == v.size() && std::memcmp(u.data(), v.data(), u.size() * sizeof u[0]) == 0;
  };
  return a.first_column == b.first_column && a.first_row == b.first_row && a.columns == b.columns &&
         a.rows == b.rows && a.count == b.count && bits(a.mean_m, b.mean_m) &&
         bits(a.deviation_m, b.deviation_m) && bits(a.centroid, b.centroid);
}

TEST(Bathymetry, TheOrderOfSoundingsChangesNoBit) {
  auto points = soundings(20000, Vec3(100e3, -3000.0, -100e3));
  Bathymetry first(0.5);
  first.add(points);
  const BathymetryGrid grid = first.grid().value();
  std::mt19937 random(3);
  for (int turn = 0; turn < 3; ++turn) {
    std::shuffle(points.begin(), points.end(), random);
    Bathymetry again(0.5);
    again.add(points);
    EXPECT_TRUE(same(grid, again.grid().value()));
  }
}

TEST(Bathymetry, MeanAndDeviationAreThoseOfACellsSoundings) {
  Bathymetry bathymetry(2.0);
  // Ten kilometres down, a spread of millimetres.
  const double offsets_m[] = {0.0, 0.001, 0.004, 0.002, -0.003};
  double mean = 0.0, squares = 0.0;
  for (const double o : offsets_m) {
    bathymetry.add(Vec3(-1.0, -10000.0 - o, 5.0));
    mean += o / 5.0;
  }
  for (const double o : offsets_m) squares += (o - mean) * (o - mean) / 5.0;
  bathymetry.add(Vec3(3.0, 2.0, 5.5));  // above the water: a negative depth
  const BathymetryGrid grid = bathymetry.grid().value();
  ASSERT_EQ(grid.columns, 3u);
  ASSERT_EQ(grid.rows, 1u);
  EXPECT_EQ(grid.west_m(), -2.0);
  EXPECT_EQ(grid.north_m(), 4.0);
  EXPECT_EQ(grid.count, (std::vector<std::uint32_t>{5, 0, 1}));
  EXPECT_NEAR(grid.mean_m[0], 10000.0 + mean, 2e-5);
  EXPECT_NEAR(grid.deviation_m[0], std::sqrt(squares), 2e-5);
  EXPECT_NEAR(grid.centroid[0][0], 0.5, 1e-5);
  EXPECT_TRUE(std::isnan(grid.mean_m[1]));
  EXPECT_TRUE(std::isnan(grid.deviation_m[1]));
  EXPECT_EQ(grid.mean_m[2], -2.0);
  EXPECT_EQ(grid.deviation_m[2], 0.0f);
}

TEST(Bathymetry, GrowsAnyWayAndLeavesOutWhatCannotBe) {
  Bathymetry bathymetry(1.0);
  EXPECT_EQ(bathymetry.grid()->cells(), 0u);
  for (const double x : {0.5, -33.5, 70.25}) bathymetry.add(Vec3(x, -1, x / 2));
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const Vec3& bad : {Vec3(nan, 0, 0), Vec3(0, inf, 0), Vec3(0, -2e6, 0), Vec3(1e30, 0, 0)})
    bathymetry.add(bad);
  EXPECT_EQ(bathymetry.soundings(), 3u);
  EXPECT_EQ(bathymetry.left_out(), 4u);
  const BathymetryGrid grid = bathymetry.grid().value();
  EXPECT_EQ(grid.columns, 105u);
  EXPECT_EQ(grid.rows, 53u);
  EXPECT_EQ(grid.first_column, -34);
  bathymetry.add(Vec3(-9e8, 0, -9e8));
  const auto wide = bathymetry.grid();
  ASSERT_FALSE(wide.ok());
  EXPECT_NE(wide.error().message.find("accepted"), std::string::npos);
}

TEST(Bathymetry, FilesHoldTheGrid) {
  Bathymetry bathymetry(1.0);
  bathymetry.add(soundings(5000, Vec3(0.0)));
  const BathymetryGrid grid = bathymetry.grid().value();
  const test::ScratchFolder folder;
  ASSERT_TRUE(sonar::write_bathymetry(folder.path(), grid, {{"seed", 1}}).ok());
  const NpyArray depth = read_npy(folder / "bathymetry.npy").value();
  EXPECT_EQ(depth.type, NpyType::kFloat64);
  EXPECT_EQ(depth.shape, (std::vector<std::size_t>{grid.rows, grid.columns}));
  EXPECT_EQ(std::memcmp(depth.bytes.data(), grid.mean_m.data(), depth.bytes.size()), 0);
  EXPECT_EQ(read_npy(folder / "bathymetry_count.npy")->type, NpyType::kUint32);
  const auto json = nlohmann::json::parse(read_text(folder / "bathymetry.json").value());
  EXPECT_EQ(json["soundings"], 5000);
  EXPECT_EQ(json["west_m"], grid.west_m());
  EXPECT_EQ(json["seed"], 1);
  EXPECT_TRUE(std::filesystem::exists(folder / "bathymetry.png"));
}

TEST(Bathymetry, TheChartIsDrawnForAnyGrid) {
  EXPECT_LE(sonar::draw_bathymetry({}, "NOTHING", 300).height, 300u);
  Bathymetry one(0.1);
  one.add(Vec3(0, -5, 0));
  EXPECT_EQ(sonar::draw_bathymetry(one.grid().value(), "ONE", 300).height, 300u);
  Bathymetry line(1.0);  // far wider than high
  for (int i = 0; i < 3000; ++i) line.add(Vec3(i, -5 - 0.001 * i, 0));
  const ImageU8 chart = sonar::draw_bathymetry(line.grid().value(), "LINE", 300);
  EXPECT_LT(chart.width, 800u);
  EXPECT_LT(chart.height, 200u);
}

// A bump is lit on the side of the light (north-west) and dark on the other.
TEST(Bathymetry, LightComesFromTheNorthWest) {
  Bathymetry bathymetry(1.0);
  for (int x = 0; x < 80; ++x)
    for (int z = 0; z < 80; ++z)
      bathymetry.add(Vec3(
          x + 0.5, -20.0 + 6.0 * std::exp(-((x - 40) * (x - 40) + (z - 40) * (z - 40)) / 200.0),
          z + 0.5));
  const ImageU8 chart = sonar::draw_bathymetry(bathymetry.grid().value(), "BUMP", 900);
  const auto brightness = [&](double x, double z) {  // mean over some pixels of the map
    double sum = 0.0;
    const double px = 738.0 / 80.0;
    for (int dy = -4; dy <= 4; ++dy)
      for (int dx = -4; dx <= 4; ++dx)
        for (std::uint32_t k = 0; k < 3; ++k)
          sum += chart.at(static_cast<std::uint32_t>(84 + x * px + dx),
                          static_cast<std::uint32_t>(92 + z * px + dy), k);
    return sum;
  };
  EXPECT_GT(brightness(33, 33), 1.3 * brightness(47, 47));
}

}  // namespace
}  // namespace neritic
