// Points that sonars found, in the world frame (Y up, metres), and the files that hold them. One
// owner, one thread.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "sonar/bottom_detection.hpp"

namespace neritic::sonar {

struct PointCloud {
  std::vector<Vec3> positions_m;
  std::vector<float> intensities;  // one a point

  std::size_t size() const { return positions_m.size(); }
};

// Adds one ping's detections, in their order.
void append(PointCloud& cloud, const BeamGrid& grid, std::span<const BottomDetection> detections,
            const Pose& world_from_sonar);

// The origin where all points are within a kilometre of it (and for none); else a point in whole
// metres near the middle of the cloud's box, from which floats hold the points (within 0.25 mm for
// a cloud of 8 km) however far from the world's origin.
Vec3 cloud_origin(const PointCloud& cloud);

// float64 [n, 3]: x, y, z in world metres. Absolute: no origin is needed to read it.
Status write_cloud_npy(const std::filesystem::path& path, const PointCloud& cloud);

enum class PcdData { kAscii, kBinary };
// Point Cloud Library's format, version 0.7 (pointclouds.org, "The PCD file format"): unorganised,
// fields x y z intensity, each a 4-byte float, little-endian. Positions are relative to
// cloud_origin, which stands in the header twice: exactly in the comment "# origin_m X Y Z", and as
// the translation of VIEWPOINT, which viewers apply themselves.
Status write_pcd(const std::filesystem::path& path, const PointCloud& cloud,
                 PcdData data = PcdData::kBinary);

}  // namespace neritic::sonar
