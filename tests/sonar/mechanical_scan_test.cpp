#include "sonar/mechanical_scan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::MechanicalScan;
using sonar::MechanicalScanOptions;
using sonar::ScanStep;

const MechanicalScanOptions kOptions{
    .n_range = 400, .range_min_m = 0.0, .range_max_m = 20.0, .beam_rad = radians(2.0)};

// Range to the wall of a round tank of radius 12 m about the world's origin, from p along d, seen
// from above.
double tank_range(const Vec3& p, const Vec3& d) {
  const double a = d.x * d.x + d.z * d.z, b = p.x * d.x + p.z * d.z,
               c = p.x * p.x + p.z * p.z - 144.0;
  return (-b + std::sqrt(b * b - a * c)) / a;
}

// A full turn of a head on a vehicle that moves by way_m, turns by turn_rad and pitches.
MechanicalScan tank_scan(double way_m, double turn_rad, double pitch_rad = 0.0) {
  MechanicalScan scan(kOptions);
  for (int i = 0; i < 180; ++i) {
    const double part = i / 179.0;
    ScanStep step;
    step.heading_rad = radians(-180.0 + 2.0 * i);
    step.time_s = 0.1 * i;
    step.world_from_sonar = {Vec3(-way_m / 2 + way_m * part, -3.0, 1.0),
                             from_yaw_pitch_roll(turn_rad * part, pitch_rad, 0.0)};
    const Vec3 d = step.world_from_sonar.rotation *
                   Vec3(std::sin(step.heading_rad), 0.0, -std::cos(step.heading_rad));
    std::vector<float> profile(400, 0.002f);
    const double r = tank_range(step.world_from_sonar.position_m, d);
    const auto wall = static_cast<std::size_t>(r / 0.05);
    for (std::size_t k = wall; k < std::min<std::size_t>(wall + 10, 400); ++k)
      profile[k] = k == wall ? 1.0f : 0.15f;  // and what rings behind it
    scan.append(profile, step);
  }
  return scan;
}

// Spread of the bright cells' distance from the tank's middle in the map.
struct Wall {
  double mean_m = 0.0, worst_m = 0.0;
  int cells = 0;
};
Wall wall_of(const sonar::ScanMosaic& map) {
  Wall wall;
  for (std::size_t i = 0; i < map.intensity.size(); ++i) {
    if (!(map.intensity[i] > 0.2f)) continue;
    const double x = (static_cast<double>(map.first_column) + i % map.columns + 0.5) * map.cell_m,
                 z = (static_cast<double>(map.first_row) + i / map.columns + 0.5) * map.cell_m;
    const double off = std::hypot(x, z) - 12.0;
    wall.mean_m += off;
    wall.worst_m = std::max(wall.worst_m, std::abs(off));
    ++wall.cells;
  }
  wall.mean_m /= std::max(1, wall.cells);
  return wall;
}

TEST(MechanicalScan, TheWorldMapOfAMovingVehicleHasTheWallWhereItIs) {
  for (const double pitch_deg : {0.0, 20.0}) {
    const auto map =
        sonar::scan_mosaic(tank_scan(6.0, radians(70), radians(pitch_deg)), 0.05).value();
    const Wall wall = wall_of(map);
    EXPECT_GT(wall.cells, 800) << pitch_deg;
    EXPECT_NEAR(wall.mean_m, 0.0, 0.05) << pitch_deg;
    // A beam is painted 2 degrees wide at one range: the wall runs up to 25 degrees off that arc.
    EXPECT_LT(wall.worst_m, 0.05 + 0.05 + 14.0 * std::sin(radians(1.0)) * std::tan(radians(35)))
        << pitch_deg;
  }
}

TEST(MechanicalScan, TheWorldMapHoldsTheTrackOfASectorThatLooksAway) {
  MechanicalScanOptions far = kOptions;
  far.range_min_m = 5.0;
  MechanicalScan scan(far);
  for (const double x : {0.0, 1.5})
    scan.append(std::vector<float>(400, 1.0f),
                {.world_from_sonar = {Vec3(x, 0, 3), Quat(1, 0, 0, 0)}});
  const auto map = sonar::scan_mosaic(scan, 0.1).value();
  const double west = static_cast<double>(map.first_column) * 0.1,
               north = static_cast<double>(map.first_row) * 0.1;
  EXPECT_LE(west, 0.0);
  EXPECT_GE(west + map.columns * 0.1, 1.5);
  EXPECT_LE(north, -2.0);
  EXPECT_GE(north + map.rows * 0.1, 3.0);
}

TEST(MechanicalScan, TheDevicesPictureIsSmearedByMotionAndOnlyByIt) {
  const auto gap = [](const MechanicalScan& scan) {  // of the wall's range where the turn closes
    const auto device = sonar::device_image(scan);
    EXPECT_EQ(device.grid.bins.azimuth, 180u);
    EXPECT_NEAR(device.grid.azimuth_rad(0), scan.steps()[0].heading_rad, 1e-9);
    const auto range = [&](std::uint32_t column) {
      for (std::uint32_t r = 0; r < 400; ++r)
        if (device.image.intensity[r * 180 + column] > 0.5f) return device.grid.range_m(r);
      return -1.0;
    };
    return std::abs(range(0) - range(179));
  };
  EXPECT_LT(gap(tank_scan(0.0, 0.0)), 0.3);
  EXPECT_GT(gap(tank_scan(8.0, radians(70))), 1.0);
}

TEST(MechanicalScan, TheSectorImageHasAColumnAStepAndTheDeviceTheNewest) {
  MechanicalScan scan({.n_range = 2, .range_min_m = 1, .range_max_m = 3, .beam_rad = radians(10)});
  // From 40 degrees to port through ahead to starboard and a step back.
  const double headings_deg[] = {-10, 0, 10, 0};
  for (int i = 0; i < 4; ++i)
    scan.append(std::vector<float>{1.0f + i, i == 3 ? std::nanf("") : 10.0f + i},
                {.heading_rad = radians(headings_deg[i])});
  EXPECT_EQ(scan.sector_image(), (std::vector<float>{1, 2, 3, 4, 10, 11, 12, 0}));
  const auto device = sonar::device_image(scan);
  EXPECT_NEAR(degrees(device.grid.limits.azimuth_min_rad), -15.0, 1e-9);
  EXPECT_NEAR(degrees(device.grid.limits.azimuth_max_rad), 15.0, 1e-9);
  ASSERT_EQ(device.grid.bins.azimuth, 3u);
  EXPECT_TRUE(sonar::validate(device.grid).ok());
  EXPECT_EQ(device.image.intensity, (std::vector<float>{1, 4, 3, 10, 0, 12}));
}

TEST(MechanicalScan, ASectorAcrossAsternIsOneSector) {
  MechanicalScan scan(kOptions);
  for (int i = -10; i <= 10; ++i)
    scan.append(std::vector<float>(400, 1.0f),
                {.heading_rad = std::remainder(radians(180.0 + 2 * i), 2 * kPi)});
  const auto device = sonar::device_image(scan);
  EXPECT_EQ(device.grid.bins.azimuth, 21u);
  EXPECT_NEAR(degrees(device.grid.limits.azimuth_max_rad - device.grid.limits.azimuth_min_rad),
              42.0, 1e-6);
  for (const float v : device.image.intensity) EXPECT_EQ(v, 1.0f);
}

TEST(MechanicalScan, FilesHoldTheScan) {
  const MechanicalScan scan = tank_scan(5.0, radians(40));
  const test::ScratchFolder folder;
  ASSERT_TRUE(sonar::write_mechanical_scan(folder.path(), scan, 0.05, {{"seed", 3}}).ok());
  EXPECT_EQ(read_npy(folder / "mechanical.npy")->shape, (std::vector<std::size_t>{400, 180}));
  const auto json = nlohmann::json::parse(read_text(folder / "mechanical.json").value());
  EXPECT_EQ(json["steps"], 180);
  const std::string csv = read_text(folder / "mechanical_steps.csv").value();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 181);
  if (const char* keep = std::getenv("NERITIC_KEEP_PICTURES"))
    for (const char* name : {"mechanical.png", "mechanical_world.png"})
      std::filesystem::copy(folder / name, std::filesystem::path(keep) / name,
                            std::filesystem::copy_options::overwrite_existing);
}

TEST(MechanicalScan, NothingAndWhatCannotBe) {
  const MechanicalScan none(kOptions);
  const test::ScratchFolder folder;
  EXPECT_TRUE(sonar::write_mechanical_scan(folder.path(), none, 0.1, {}).ok());
  EXPECT_EQ(sonar::device_image(none).grid.bins.azimuth, 180u);
  const MechanicalScan scan = tank_scan(1.0, 0.0);
  for (const double cell_m : {0.0, -1.0, std::nan(""), 1e-6}) {
    const auto map = sonar::scan_mosaic(scan, cell_m);
    ASSERT_FALSE(map.ok()) << cell_m;
    EXPECT_NE(map.error().message.find("accepted"), std::string::npos);
  }
  EXPECT_TRUE(sonar::validate(kOptions).ok());
  for (const MechanicalScanOptions& bad :
       {MechanicalScanOptions{.n_range = 0}, MechanicalScanOptions{.range_min_m = 30},
        MechanicalScanOptions{.beam_rad = 0.0}, MechanicalScanOptions{.elevation_rad = 3.0}})
    EXPECT_FALSE(sonar::validate(bad).ok());
  // Straight down: nothing on the map, and no division by zero.
  MechanicalScan down(kOptions);
  down.append(std::vector<float>(400, 1.0f),
              {.world_from_sonar = {Vec3(0), from_yaw_pitch_roll(0, radians(-90), 0)}});
  EXPECT_TRUE(sonar::scan_mosaic(down, 0.1).ok());
}

}  // namespace
}  // namespace neritic
