#include "sonar/point_cloud.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"

namespace neritic::sonar {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are written as they lie");

// So near the origin floats hold a tenth of a millimetre as they are.
constexpr double kNear_m = 1024.0;

using PcdPoint = std::array<float, 4>;

PcdPoint pcd_point(const PointCloud& cloud, std::size_t i, const Vec3& origin) {
  const Vec3f p(cloud.positions_m[i] - origin);
  return {p.x, p.y, p.z, cloud.intensities[i]};
}

std::string pcd_header(const PointCloud& cloud, const Vec3& origin, PcdData data) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n"
      "# right-handed, Y up, metres; positions are relative to the origin\n"
      "# origin_m {0:.0f} {1:.0f} {2:.0f}\n"
      "VERSION 0.7\n"
      "FIELDS x y z intensity\n"
      "SIZE 4 4 4 4\n"
      "TYPE F F F F\n"
      "COUNT 1 1 1 1\n"
      "WIDTH {3}\n"
      "HEIGHT 1\n"
      "VIEWPOINT {0:.0f} {1:.0f} {2:.0f} 1 0 0 0\n"
      "POINTS {3}\n"
      "DATA {4}\n",
      origin.x, origin.y, origin.z, cloud.size(), data == PcdData::kAscii ? "ascii" : "binary");
}

}  // namespace

void append(PointCloud& cloud, const BeamGrid& grid, std::span<const BottomDetection> detections,
            const Pose& world_from_sonar) {
  for (const BottomDetection& d : detections) {
    cloud.positions_m.push_back(world_from_sonar * detection_point(grid, d));
    cloud.intensities.push_back(d.intensity);
  }
}

Vec3 cloud_origin(const PointCloud& cloud) {
  if (cloud.positions_m.empty()) return Vec3(0.0);
  Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : cloud.positions_m) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const Vec3 far = glm::max(glm::abs(low), glm::abs(high));
  if (std::max({far.x, far.y, far.z}) <= kNear_m) return Vec3(0.0);
  // Adding zero turns -0 into 0, for the header's sake.
  return glm::round((low + high) / 2.0) + Vec3(0.0);
}

Status write_cloud_npy(const std::filesystem::path& path, const PointCloud& cloud) {
  std::vector<double> flat;
  flat.reserve(3 * cloud.size());
  for (const Vec3& p : cloud.positions_m) flat.insert(flat.end(), {p.x, p.y, p.z});
  return write_npy(path, std::span<const double>(flat), {cloud.size(), 3});
}

Status write_pcd(const std::filesystem::path& path, const PointCloud& cloud, PcdData data) {
  NERITIC_CHECK(cloud.intensities.size() == cloud.size(), "{} intensities for {} points",
                cloud.intensities.size(), cloud.size());
  const Vec3 origin = cloud_origin(cloud);
  std::string text = pcd_header(cloud, origin, data);
  if (data == PcdData::kAscii) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const PcdPoint p = pcd_point(cloud, i, origin);
      // Nine digits tell every float from its neighbours.
      fmt::format_to(std::back_inserter(text), "{:.9g} {:.9g} {:.9g} {:.9g}\n", p[0], p[1], p[2],
                     p[3]);
    }
    return write_text(path, text);
  }
  const std::size_t header = text.size();
  text.resize(header + cloud.size() * sizeof(PcdPoint));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const PcdPoint p = pcd_point(cloud, i, origin);
    std::memcpy(text.data() + header + i * sizeof p, p.data(), sizeof p);
  }
  return write_text(path, text);
}

}  // namespace neritic::sonar
