// Pinholes from JSON files (offline_input.hpp).
#include <cctype>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "sonar/offline_input.hpp"

namespace neritic::sonar {
namespace {

using Json = nlohmann::json;

std::string quoted_json(const Json& json) {
  return json_text(json, -1).substr(0, 40);
}

Result<double> number(const Json& json, const char* key, const std::string& path) {
  const auto at = json.find(key);
  if (at == json.end()) return refusal(path, fmt::format("no \"{}\"", key), "fx, fy, cx and cy");
  if (!at->is_number())
    return refusal(fmt::format("{}: {}", path, key), quoted_json(*at), "a number");
  return at->get<double>();
}

// Where a name stands in a text, [from, until).
struct Place {
  std::size_t from, until;
  const Json* frame;
  bool holds(const Place& other) const { return from <= other.from && until >= other.until; }
};

bool same_kind(char a, char b) {
  const auto kind = [](unsigned char c) { return std::isdigit(c) ? 1 : std::isalpha(c) ? 2 : 0; };
  return kind(a) != 0 && kind(a) == kind(b);
}

// Every place where the id stands for itself: no digit beside a digit, no letter beside a letter.
void find_id(const std::string& text, const std::string& id, const Json* frame,
             std::vector<Place>& out) {
  for (std::size_t at = text.find(id); !id.empty() && at != std::string::npos;
       at = text.find(id, at + 1)) {
    const std::size_t until = at + id.size();
    if (at > 0 && same_kind(text[at - 1], id.front())) continue;
    if (until < text.size() && same_kind(id.back(), text[until])) continue;
    out.push_back({at, until, frame});
  }
}

std::string id_of(const Json& frame) {
  const auto id = frame.is_object() ? frame.find("id") : frame.end();
  if (!frame.is_object() || id == frame.end()) return "";
  if (id->is_number_unsigned()) return std::to_string(id->get<std::uint64_t>());
  return id->is_string() ? id->get<std::string>() : "";
}

// The frame whose id stands in the depth file's name; else the one in its folders' names.
Result<const Json*> named_frame(const Json& frames, const std::string& path,
                                const std::string& depth_path) {
  const std::string text = std::filesystem::path(depth_path).replace_extension().generic_string();
  const std::size_t name_from = text.rfind('/') + 1;  // npos + 1: 0
  std::vector<Place> places;
  for (const Json& frame : frames) find_id(text, id_of(frame), &frame, places);
  const bool in_name =
      std::ranges::any_of(places, [&](const Place& p) { return p.until > name_from; });
  const Json* found = nullptr;
  for (const Place& place : places) {
    if (in_name && place.until <= name_from) continue;
    const bool part_of_longer = std::ranges::any_of(
        places, [&](const Place& other) { return other.holds(place) && !place.holds(other); });
    if (part_of_longer) continue;
    if (found != nullptr && found != place.frame)
      return refusal(path,
                     fmt::format("frames '{}' and '{}' that both fit {}", id_of(*found),
                                 id_of(*place.frame), depth_path),
                     "one");
    found = place.frame;
  }
  return found;
}

// The part of the file that is about the depth image.
Result<Json> frame_of(const Json& json, const std::string& path, const std::string& depth_path) {
  const auto frames = json.find("frames");
  if (json.contains("fx") || frames == json.end() || !frames->is_array()) return json;
  if (frames->size() == 1 && frames->front().is_object()) return frames->front();
  NERITIC_TRY(const Json* found, named_frame(*frames, path, depth_path));
  if (found == nullptr)
    return refusal(path,
                   fmt::format("{} frames, none of which names {}", frames->size(), depth_path),
                   "a frame for that file, or fx,fy,cx,cy as numbers");
  return *found;
}

// Nine numbers in a row, three lists of three, or either as the "data" of a table (OpenCV).
std::vector<double> nine_numbers(const Json& matrix) {
  if (matrix.is_object())
    return matrix.contains("data") ? nine_numbers(matrix["data"]) : std::vector<double>();
  std::vector<double> out;
  if (!matrix.is_array()) return out;
  for (const Json& entry : matrix) {
    if (entry.is_number()) out.push_back(entry.get<double>());
    if (!entry.is_array() || entry.size() != 3 || matrix.size() != 3) continue;
    for (const Json& value : entry)
      if (value.is_number()) out.push_back(value.get<double>());
  }
  return out;
}

// [fx, 0, cx, 0, fy, cy, 0, 0, 1] or its transpose.
Result<Intrinsics> from_matrix(const Json& matrix, const char* key, const std::string& path) {
  const std::vector<double> m = nine_numbers(matrix);
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
  return json.is_structured() && std::ranges::any_of(json, any_not_zero);
}

// Images of a lens that bends lines must be undistorted before; then nothing of it stands here.
Status check_pinhole(const Json& json, const std::string& path) {
  for (const char* key : {"distortion", "distortion_coefficients", "dist_coeffs", "coeffs", "D",
                          "d", "k1", "k2", "k3", "p1", "p2"}) {
    const auto at = json.find(key);
    if (at != json.end() && any_not_zero(*at))
      return refusal(fmt::format("{}: {}", path, key), quoted_json(*at),
                     "no distortion (if the images are rectified, remove the key)");
  }
  for (const char* key : {"model", "camera_model", "projection"}) {
    const auto at = json.find(key);
    if (at == json.end() || !at->is_string()) continue;
    const std::string name = lower_case(at->get<std::string>());
    if (name.find("pinhole") == name.npos && name.find("perspective") == name.npos)
      return refusal(fmt::format("{}: {}", path, key), quoted_json(*at), "a pinhole");
  }
  return {};
}

}  // namespace

Result<Intrinsics> read_intrinsics(const std::filesystem::path& path, const MapFile& depth) {
  NERITIC_TRY(const std::string text, read_text(path));
  const std::string name = path.string();
  const Result<Json> parsed = parse_json(text);
  if (!parsed.ok() || !parsed->is_object())
    return refusal(
        name, fmt::format("no JSON object{}", parsed.ok() ? "" : ": " + parsed.error().message),
        "one with fx, fy, cx and cy");
  const Json& whole = *parsed;
  NERITIC_TRY(Json json, frame_of(whole, name, depth.path));
  for (const auto& [key, found] : {std::pair{"width", depth.width}, {"height", depth.height}}) {
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
  for (const char* key : {"intrinsic_matrix", "camera_matrix", "K", "k"})
    if (json.contains(key)) return from_matrix(json[key], key, name);
  NERITIC_TRY(const double fx, number(json, "fx", name));
  NERITIC_TRY(const double fy, number(json, "fy", name));
  NERITIC_TRY(const double cx, number(json, "cx", name));
  NERITIC_TRY(const double cy, number(json, "cy", name));
  return Intrinsics{fx, fy, cx, cy};
}

}  // namespace neritic::sonar
