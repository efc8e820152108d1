// From map files in anyone's conventions to SonarInput: depth kinds and scales, axes, coded
// normals, pinholes from JSON. Pure functions of the files; any thread.
#pragma once

#include <optional>

#include "sonar/map_file.hpp"
#include "sonar/reference.hpp"

namespace neritic::sonar {

enum class NormalAxes {
  kOpengl,  // x right, y up, z backwards: ours
  kOpencv,  // x right, y down, z forwards
  kRos,     // x forwards, y left, z up (REP 103)
};

struct OfflineOptions {
  bool depth_is_range = false;
  double depth_scale = 1.0;  // metres a unit
  NormalAxes axes = NormalAxes::kOpengl;
  bool normals_face_sensor = true;
  double gamma = 1.0;  // of normals coded in integers
};

// Where the normals came from.
enum class NormalSource { kFile, kDepth };

// normals absent: estimated from the depth. Sizes must match. kBadInput too where the depth has
// several channels that differ: a picture or normals, given in its place.
Result<SonarInput> make_input(const MapFile& depth, const MapFile* normals, const MapFile* labels,
                              const Intrinsics& intrinsics, const OfflineOptions& options);

// Eq. 1 for one channel coded in an integer of largest value max: 2 v^gamma - 1 with v = code /
// max. The published page sets the 2 outside a bracket that also holds the -1, which would leave
// only negative components; what a normal map stores is (n + 1) / 2, and that is what this undoes.
double decode_normal(double code, double max, double gamma);

// Unit normals that face the sensor, from differences between neighbouring points. Where one side
// steps by much more than the other, an outline lies between, and only the near side counts. Zero
// where no neighbour is there.
std::vector<double> normals_from_depth(const SonarInput& input);

// A pinhole from a JSON file: fx, fy, cx, cy at the top or in "intrinsics"; "intrinsic_matrix" of
// nine numbers, column by column (Open3D); or "frames", a list with "id"s, of which the one that
// the depth file's path contains is taken (the only one where there is one). A width and height in
// it must be the image's.
Result<Intrinsics> read_intrinsics(const std::filesystem::path& path, const MapFile& depth);

}  // namespace neritic::sonar
