#include "sonar/camera_file.hpp"

#include <algorithm>
#include <cctype>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/core/yaml.hpp"

namespace neritic::sonar {
namespace {

using Json = nlohmann::json;

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

bool is_yaml(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".yaml" || extension == ".yml";
}

}  // namespace

std::string quoted_json(const Json& json) {
  return json_text(json, -1).substr(0, 40);
}

Result<Json> read_camera_file(const std::filesystem::path& path, const std::string& depth_path) {
  NERITIC_TRY(const std::string text, read_text(path));
  const std::string name = path.string();
  const bool yaml = is_yaml(path);
  const Result<Json> parsed = yaml ? parse_yaml(text) : parse_json(text);
  if (!parsed.ok() && yaml) return bad_input("{}: {}", name, parsed.error().message);
  if (!parsed.ok() || !parsed->is_object())
    return refusal(name,
                   fmt::format("no {} object{}", yaml ? "YAML" : "JSON",
                               parsed.ok() ? "" : ": " + parsed.error().message),
                   "one that describes a camera");
  return frame_of(*parsed, name, depth_path);
}

std::vector<double> numbers_in(const Json& matrix) {
  if (matrix.is_object())
    return matrix.contains("data") ? numbers_in(matrix["data"]) : std::vector<double>();
  std::vector<double> out;
  if (!matrix.is_array()) return out;
  for (const Json& entry : matrix) {
    if (entry.is_number()) out.push_back(entry.get<double>());
    if (!entry.is_array() || entry.size() > 4) continue;
    for (const Json& value : entry)
      if (value.is_number()) out.push_back(value.get<double>());
  }
  return out;
}

}  // namespace neritic::sonar
