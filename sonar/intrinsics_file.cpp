// Pinholes from files (offline_input.hpp).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "sonar/camera_file.hpp"
#include "sonar/offline_input.hpp"

namespace neritic::sonar {
namespace {

using Json = nlohmann::json;

Result<double> number(const Json& json, const char* key, const std::string& path) {
  const auto at = json.find(key);
  if (at == json.end()) return refusal(path, fmt::format("no \"{}\"", key), "fx, fy, cx and cy");
  if (!at->is_number())
    return refusal(fmt::format("{}: {}", path, key), quoted_json(*at), "a number");
  return at->get<double>();
}

// [fx, 0, cx, 0, fy, cy, 0, 0, 1] or its transpose.
Result<Intrinsics> from_matrix(const Json& matrix, const char* key, const std::string& path) {
  const std::vector<double> m = numbers_in(matrix);
  if (m.size() != 9)
    return refusal(fmt::format("{}: {}", path, key), quoted_json(matrix), "nine numbers");
  const bool by_rows = m[6] == 0.0 && m[7] == 0.0, by_columns = m[2] == 0.0 && m[5] == 0.0;
  if (m[1] != 0.0 || m[3] != 0.0 || m[8] != 1.0 || !(by_rows || by_columns))
    return refusal(fmt::format("{}: {}", path, key), quoted_json(matrix),
                   "a pinhole's fx,0,cx,0,fy,cy,0,0,1 by rows or by columns");
  return Intrinsics{m[0], m[4], by_rows ? m[2] : m[6], by_rows ? m[5] : m[7]};
}

bool any_not_zero(const Json& json) {
  if (json.is_number()) return json.get<double>() != 0.0;
  if (json.is_object() && json.contains("data")) return any_not_zero(json["data"]);
  return json.is_structured() && std::ranges::any_of(json, any_not_zero);
}

// Images of a lens that bends lines must be undistorted before; then nothing of it stands here.
Status check_pinhole(const Json& json, const std::string& path) {
  for (const char* key : {"distortion", "distortion_coefficients", "Distortion_Coefficients",
                          "dist_coeffs", "coeffs", "D", "d", "k1", "k2", "k3", "p1", "p2"}) {
    const auto at = json.find(key);
    if (at != json.end() && any_not_zero(*at))
      return refusal(
          fmt::format("{}: {}", path, key), quoted_json(*at),
          "no distortion (of rectified images give fx,fy,cx,cy as numbers: ROS has them in P)");
  }
  for (const char* key : {"model", "camera_model", "projection"}) {
    const auto at = json.find(key);
    if (at == json.end() || !at->is_string()) continue;
    const std::string name = lower_case(at->get<std::string>());
    if (name.find("pinhole") == name.npos && name.find("perspective") == name.npos)
      return refusal(fmt::format("{}: {}", path, key), quoted_json(*at), "a pinhole");
  }
  // Neritic's own pictures through a lens or a port (meta.json).
  const auto lens = json.find("lens");
  if (lens != json.end() && lens->is_object()) {
    const std::string model =
        lens->value("model", Json()).is_string() ? (*lens)["model"] : Json("");
    const bool bends =
        model != "brown_conrady" || (lens->contains("opencv") && any_not_zero((*lens)["opencv"]));
    if (bends)
      return refusal(fmt::format("{}: lens", path), quoted_json(*lens),
                     "no lens (render that camera without)");
  }
  const auto port = json.find("port");
  if (port != json.end() && port->is_object()) {
    const bool bends = port->value("kind", Json()) != Json("dome") ||
                       (port->contains("offset") && any_not_zero((*port)["offset"]));
    if (bends)
      return refusal(fmt::format("{}: port", path), quoted_json(*port),
                     "no port (render that camera without)");
  }
  return {};
}

}  // namespace

Result<Intrinsics> read_intrinsics(const std::filesystem::path& path, const MapFile& depth) {
  const std::string name = path.string();
  NERITIC_TRY(Json json, read_camera_file(path, depth.path));
  for (const auto& [key, found] : {std::pair{"width", depth.width},
                                   {"height", depth.height},
                                   {"image_width", depth.width},
                                   {"image_height", depth.height}}) {
    const auto at = json.find(key);
    if (at != json.end() && at->is_number() && at->get<double>() != found)
      return refusal(fmt::format("{}: {}", name, key), json_text(*at, -1),
                     fmt::format("{}, as {} has", found, depth.path));
  }
  NERITIC_TRY_STATUS(check_pinhole(json, name));
  if (json.contains("intrinsics") && json["intrinsics"].is_object()) {
    json = Json(json["intrinsics"]);
    NERITIC_TRY_STATUS(check_pinhole(json, name));
  }
  for (const char* key : {"intrinsic_matrix", "camera_matrix", "Camera_Matrix", "K", "k"})
    if (json.contains(key)) return from_matrix(json[key], key, name);
  NERITIC_TRY(const double fx, number(json, "fx", name));
  NERITIC_TRY(const double fy, number(json, "fy", name));
  NERITIC_TRY(const double cx, number(json, "cx", name));
  NERITIC_TRY(const double cy, number(json, "cy", name));
  return Intrinsics{fx, fy, cx, cy};
}

}  // namespace neritic::sonar
