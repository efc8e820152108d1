// Pinholes from JSON files (offline_input.hpp).
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "sonar/offline_input.hpp"

namespace neritic::sonar {
namespace {

using Json = nlohmann::json;

Result<double> number(const Json& json, const char* key, const std::string& path) {
  const auto at = json.find(key);
  if (at == json.end())
    return bad_input("{}: no \"{}\" found, fx, fy, cx and cy are accepted", path, key);
  if (!at->is_number())
    return bad_input("{}: \"{}\" is {}, a number is accepted", path, key,
                     json_text(*at, -1).substr(0, 40));
  return at->get<double>();
}

// The part of the file that is about the depth image.
Result<Json> frame_of(const Json& json, const std::string& path, const std::string& depth_path) {
  const auto frames = json.find("frames");
  if (json.contains("fx") || frames == json.end() || !frames->is_array()) return json;
  const Json* found = nullptr;
  for (const Json& frame : *frames) {
    if (!frame.is_object()) continue;
    const auto id = frame.find("id");
    const bool named = id != frame.end() && id->is_string() &&
                       depth_path.find(id->get<std::string>()) != std::string::npos;
    if (named || frames->size() == 1) found = &frame;
  }
  if (found == nullptr)
    return bad_input(
        "{}: none of its {} frames is named in {}, fx,fy,cx,cy in numbers are accepted too", path,
        frames->size(), depth_path);
  return *found;
}

Result<Intrinsics> from_matrix(const Json& matrix, const std::string& path) {
  if (!matrix.is_array() || matrix.size() != 9 ||
      !std::all_of(matrix.begin(), matrix.end(), [](const Json& v) { return v.is_number(); }))
    return bad_input("{}: \"intrinsic_matrix\" is not a list of nine numbers", path);
  const auto at = [&](std::size_t i) { return matrix[i].get<double>(); };
  return Intrinsics{at(0), at(4), at(6), at(7)};
}

}  // namespace

Result<Intrinsics> read_intrinsics(const std::filesystem::path& path, const MapFile& depth) {
  NERITIC_TRY(const std::string text, read_text(path));
  const std::string name = path.string();
  const Result<Json> parsed = parse_json(text);
  if (!parsed.ok() || !parsed->is_object())
    return bad_input("{}: not a JSON object; one with fx, fy, cx and cy is accepted{}", name,
                     parsed.ok() ? "" : ": " + parsed.error().message);
  const Json& whole = *parsed;
  NERITIC_TRY(Json json, frame_of(whole, name, depth.path));
  for (const auto& [key, found] : {std::pair{"width", depth.width}, {"height", depth.height}}) {
    const auto at = json.find(key);
    if (at != json.end() && at->is_number() && at->get<double>() != found)
      return bad_input("{}: \"{}\" is {}, that of {} is {}", name, key, json_text(*at, -1),
                       depth.path, found);
  }
  if (json.contains("intrinsic_matrix")) return from_matrix(json["intrinsic_matrix"], name);
  if (json.contains("intrinsics") && json["intrinsics"].is_object())
    json = Json(json["intrinsics"]);
  NERITIC_TRY(const double fx, number(json, "fx", name));
  NERITIC_TRY(const double fy, number(json, "fy", name));
  NERITIC_TRY(const double cx, number(json, "cx", name));
  NERITIC_TRY(const double cy, number(json, "cy", name));
  return Intrinsics{fx, fy, cx, cy};
}

}  // namespace neritic::sonar
