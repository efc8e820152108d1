// From map files in anyone's conventions to SonarInput: depth kinds and scales, axes, coded
// normals, pinholes from JSON. Pure functions of the files; any thread.
#pragma once

#include <optional>

#include "engine/core/intrinsics.hpp"
#include "sonar/depth_normals.hpp"
#include "sonar/map_file.hpp"
#include "sonar/reference.hpp"

namespace neritic::sonar {

enum class NormalAxes {
  kOpengl,  // x right, y up, z backwards: ours
  kOpencv,  // x right, y down, z forwards
  kRos,     // x forwards, y left, z up (REP 103)
};

enum class DepthKind {
  kPlanar,     // along the view axis
  kRange,      // along each ray
  kDisparity,  // pixels between a rectified pair's pictures: planar depth = fx baseline / disparity
};

struct OfflineOptions {
  DepthKind depth_kind = DepthKind::kPlanar;
  double depth_scale = 1.0;  // metres (of disparity: pixels) a unit
  double baseline_m = 0.0;   // of a disparity's pair
  NormalAxes axes = NormalAxes::kOpengl;
  bool normals_face_sensor = true;
  double gamma = 1.0;  // of normals coded in integers
  // Where the normals are in world axes: from the camera's axes, of the kind above, to those.
  std::optional<Mat3> world_from_camera = {};
};

// Where the normals came from.
enum class NormalSource { kFile, kDepth };

// normals absent: estimated from the depth, which `estimate` then tells of. Sizes must match. In an
// EXR with many channels depth is Z (or depth, V, Y) and the normal X, Y, Z or R, G, B, in whatever
// layer. kBadInput too where depth or labels have several channels that differ: a picture or
// normals, given in their place.
Result<SonarInput> make_input(const MapFile& depth, const MapFile* normals, const MapFile* labels,
                              const Intrinsics& intrinsics, const OfflineOptions& options,
                              NormalEstimate* estimate = nullptr);

// Eq. 1 for one channel coded in an integer of largest value max: 2 v^gamma - 1 with v = code /
// max. The published page sets the 2 outside a bracket that also holds the -1, which would leave
// only negative components; what a normal map stores is (n + 1) / 2, and that is what this undoes.
double decode_normal(double code, double max, double gamma);

// The rotation from a camera's axes to the world's: of a quaternion x, y, z, w (place begins the
// error), or from a .json or .yaml file: a matrix by rows or rotation_xyzw, of the depth image's
// frame where it lists several.
Result<Mat3> rotation_of(std::span<const double> xyzw, const std::string& place);
Result<Mat3> read_camera_rotation(const std::filesystem::path& path, const MapFile& depth);

// A pinhole from a .json or .yaml file: fx, fy, cx, cy at the top or in "intrinsics"; a matrix
// ("intrinsic_matrix", "camera_matrix", "K") of nine numbers, by rows or by columns, which its
// zeros tell, or of three rows; or "frames", a list with "id"s, of which the one that stands in the
// depth file's name, else in its folders, is taken (the only one where there is one): whole, so
// that 1 is not found in 10. A width and height in it must be the image's. kBadInput where two ids
// fit, the matrix has a skew, or the file describes a lens that is no pinhole.
Result<Intrinsics> read_intrinsics(const std::filesystem::path& path, const MapFile& depth);

}  // namespace neritic::sonar
