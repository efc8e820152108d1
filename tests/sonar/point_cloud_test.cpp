#include "sonar/point_cloud.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <sstream>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

using sonar::PointCloud;

// A PCD file by its own rules, independent of the writer: header words, then points.
struct Pcd {
  std::map<std::string, std::string> header;
  Vec3 origin{0.0};
  std::vector<std::array<float, 4>> points;
};
Pcd parse_pcd(const std::string& text) {
  Pcd pcd;
  std::size_t at = 0;
  while (!pcd.header.contains("DATA")) {
    const std::size_t end = text.find('\n', at);
    std::istringstream line(text.substr(at, end - at));
    at = end + 1;
    std::string key, rest;
    line >> key;
    if (key == "#") {
      line >> key;
      if (key == "origin_m") line >> pcd.origin.x >> pcd.origin.y >> pcd.origin.z;
      continue;
    }
    std::getline(line >> std::ws, rest);
    pcd.header[key] = rest;
  }
  pcd.points.resize(std::stoul(pcd.header["POINTS"]));
  if (pcd.header["DATA"] == "binary") {
    EXPECT_EQ(text.size() - at, pcd.points.size() * 16);
    if (!pcd.points.empty()) std::memcpy(pcd.points.data(), text.data() + at, text.size() - at);
  } else {
    std::istringstream rest(text.substr(at));
    for (auto& p : pcd.points) rest >> p[0] >> p[1] >> p[2] >> p[3];
    EXPECT_TRUE(rest.good());
  }
  return pcd;
}

PointCloud far_cloud() {
  PointCloud cloud;
  for (int i = 0; i < 1000; ++i) {
    cloud.positions_m.emplace_back(100e3 + i * 0.123456789, -40.0 - (i % 17) * 0.01,
                                   -70e3 + i * 0.0333);
    cloud.intensities.push_back(0.001f * static_cast<float>(i));
  }
  return cloud;
}

TEST(PointCloud, DetectionsLandWhereTheWorldHasThem) {
  const sonar::BeamGrid grid = sonar::symmetric_grid(1, 21, radians(90), radians(0.5), {200, 3, 1});
  // Looking straight down from 10 m, heading east: starboard of the fan is south (+z).
  const Pose pose{Vec3(100e3, -10.0, 5.0), from_yaw_pitch_roll(radians(-90), radians(-90), 0.0)};
  PointCloud cloud;
  const sonar::BottomDetection detections[] = {{.beam = 1, .range_m = 8.0, .intensity = 0.5f},
                                               {.beam = 2, .range_m = 8.0, .intensity = 0.25f}};
  sonar::append(cloud, grid, detections, pose);
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_LT(glm::distance(cloud.positions_m[0], Vec3(100e3, -18.0, 5.0)), 1e-9);
  const double side = 8.0 * std::sin(radians(30)), down = 8.0 * std::cos(radians(30));
  EXPECT_LT(glm::distance(cloud.positions_m[1], Vec3(100e3, -10.0 - down, 5.0 + side)), 1e-9);
  EXPECT_EQ(cloud.intensities[1], 0.25f);
}

TEST(PointCloud, PcdHoldsMillimetresAHundredKilometresAway) {
  const PointCloud cloud = far_cloud();
  const test::ScratchFolder folder;
  for (const auto data : {sonar::PcdData::kAscii, sonar::PcdData::kBinary}) {
    const auto path = folder / "cloud.pcd";
    ASSERT_TRUE(sonar::write_pcd(path, cloud, data).ok());
    const Pcd pcd = parse_pcd(read_text(path).value());
    EXPECT_EQ(pcd.header.at("VERSION"), "0.7");
    EXPECT_EQ(pcd.header.at("FIELDS"), "x y z intensity");
    EXPECT_EQ(pcd.header.at("SIZE"), "4 4 4 4");
    EXPECT_EQ(pcd.header.at("TYPE"), "F F F F");
    EXPECT_EQ(pcd.header.at("WIDTH"), "1000");
    EXPECT_EQ(pcd.header.at("HEIGHT"), "1");
    EXPECT_EQ(pcd.header.at("VIEWPOINT"), "100062 -40 -69983 1 0 0 0");
    ASSERT_EQ(pcd.points.size(), cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const auto& p = pcd.points[i];
      EXPECT_LT(glm::distance(pcd.origin + Vec3(p[0], p[1], p[2]), cloud.positions_m[i]), 1e-4);
      EXPECT_EQ(p[3], cloud.intensities[i]);
    }
  }
}

TEST(PointCloud, NpyHoldsDoubles) {
  const PointCloud cloud = far_cloud();
  const test::ScratchFolder folder;
  const auto path = folder / "cloud.npy";
  ASSERT_TRUE(sonar::write_cloud_npy(path, cloud).ok());
  const NpyArray array = read_npy(path).value();
  EXPECT_EQ(array.type, NpyType::kFloat64);
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{1000, 3}));
  const auto values = array.to_doubles();
  for (std::size_t i = 0; i < cloud.size(); ++i)
    EXPECT_EQ(Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]), cloud.positions_m[i]);
}

TEST(PointCloud, NoPointsMakeWholeFiles) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(sonar::write_cloud_npy(folder / "none.npy", {}).ok());
  EXPECT_EQ(read_npy(folder / "none.npy")->count(), 0u);
  ASSERT_TRUE(sonar::write_pcd(folder / "none.pcd", {}).ok());
  const Pcd pcd = parse_pcd(read_text(folder / "none.pcd").value());
  EXPECT_TRUE(pcd.points.empty());
  EXPECT_EQ(pcd.header.at("VIEWPOINT"), "0 0 0 1 0 0 0");
}

}  // namespace
}  // namespace neritic
