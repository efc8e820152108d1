// The rotation of a camera in world axes, from files (offline_input.hpp).
#include <cmath>

#include "engine/core/refusal.hpp"
#include "sonar/camera_file.hpp"
#include "sonar/offline_input.hpp"

namespace neritic::sonar {
namespace {

using Json = nlohmann::json;

Result<Mat3> checked(const Mat3& m, const std::string& place) {
  const Mat3 square = glm::transpose(m) * m;
  double off = 0.0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) off = std::max(off, std::abs(square[c][r] - (c == r ? 1.0 : 0.0)));
  if (!(off < 1e-2) || !(glm::determinant(m) > 0.0))
    return refusal(place, "no rotation", "three unit axes at right angles, right-handed");
  return m;
}

// From 3 x 3, 3 x 4 or 4 x 4 numbers by rows.
Result<Mat3> rotation_in(const Json& matrix, const std::string& place) {
  const std::vector<double> n = numbers_in(matrix);
  if (n.size() != 9 && n.size() != 12 && n.size() != 16)
    return refusal(place, quoted_json(matrix), "3 x 3, 3 x 4 or 4 x 4 numbers by rows");
  const std::size_t columns = n.size() == 9 ? 3 : 4;
  Mat3 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      out[c][r] = n[columns * static_cast<std::size_t>(r) + static_cast<std::size_t>(c)];
  return checked(out, place);
}

}  // namespace

Result<Mat3> rotation_of(std::span<const double> xyzw, const std::string& place) {
  const double size = std::hypot(std::hypot(xyzw[0], xyzw[1]), std::hypot(xyzw[2], xyzw[3]));
  if (!(std::abs(size - 1.0) < 1e-2))
    return refusal(place, fmt::format("a quaternion of length {:g}", size), "length 1");
  return glm::mat3_cast(glm::normalize(Quat(xyzw[3], xyzw[0], xyzw[1], xyzw[2])));
}

Result<Mat3> read_camera_rotation(const std::filesystem::path& path, const MapFile& depth) {
  const std::string name = path.string();
  NERITIC_TRY(const Json json, read_camera_file(path, depth.path));
  for (const char* key : {"camera_to_world", "transform_matrix", "world_from_camera"})
    if (json.contains(key)) return rotation_in(json[key], fmt::format("{}: {}", name, key));
  if (json.contains("world_to_camera")) {
    NERITIC_TRY(const Mat3 m, rotation_in(json["world_to_camera"], name + ": world_to_camera"));
    return glm::transpose(m);
  }
  const Json& pose = json.contains("pose") ? json["pose"] : json;
  if (pose.is_object() && pose.contains("rotation_xyzw")) {
    const std::vector<double> q = numbers_in(pose["rotation_xyzw"]);
    const std::string place = name + ": rotation_xyzw";
    if (q.size() == 4) return rotation_of(q, place);
    return refusal(place, quoted_json(pose["rotation_xyzw"]), "four numbers");
  }
  return refusal(name, "no pose",
                 "camera_to_world, transform_matrix, world_from_camera, world_to_camera (matrices "
                 "by rows) or rotation_xyzw");
}

}  // namespace neritic::sonar
