#include "testbed/view/view_memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::testbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint32_t kLeastSide_px = 160, kMostSide_px = 16384;
constexpr std::size_t kMostNumbers = 4;

std::uint32_t side_in(const json& all, const char* key, std::uint32_t otherwise) {
  const auto found = all.find(key);
  if (found == all.end() || !found->is_number_integer()) return otherwise;
  return static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(found->get<std::int64_t>(), kLeastSide_px, kMostSide_px));
}

bool flag_in(const json& all, const char* key, bool otherwise) {
  const auto found = all.find(key);
  return found != all.end() && found->is_boolean() ? found->get<bool>() : otherwise;
}

double number_in(const json& all, const char* key, double low, double high, double otherwise) {
  const auto found = all.find(key);
  if (found == all.end() || !found->is_number()) return otherwise;
  return std::clamp(found->get<double>(), low, high);
}

}  // namespace

fs::path view_memory_file() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  if (state && *state) return fs::path(state) / "neritic" / "window.json";
  const char* const home = std::getenv("HOME");
  if (home && *home) return fs::path(home) / ".local" / "state" / "neritic" / "window.json";
  return {};
}

Result<ViewMemory> read_view_memory(const fs::path& file) {
  ViewMemory out;
  std::error_code error;
  if (file.empty() || !fs::exists(file, error)) return out;
  NERITIC_TRY(const std::string text, read_text(file));
  const Result<json> parsed = parse_json(text);
  if (!parsed.ok() || !parsed->is_object())
    return refusal(file.string(), parsed.ok() ? "no object" : parsed.error().message,
                   "the JSON that a window writes; it begins anew");
  const json& all = *parsed;
  out.width = side_in(all, "width_px", out.width);
  out.height = side_in(all, "height_px", out.height);
  out.panels = flag_in(all, "panels", out.panels);
  out.times = flag_in(all, "times", out.times);
  out.map = flag_in(all, "map", out.map);
  out.graphs = flag_in(all, "graphs", out.graphs);
  out.sonar_gain_db = number_in(all, "sonar_gain_db", -24.0, 24.0, 0.0);
  out.sonar_range_part = number_in(all, "sonar_range_part", 0.25, 1.0, 1.0);
  if (const auto numbers = all.find("numbers"); numbers != all.end() && numbers->is_array())
    for (const json& name : *numbers)
      if (name.is_string() && out.numbers.size() < kMostNumbers)
        out.numbers.push_back(name.get<std::string>());
  return out;
}

Status write_view_memory(const fs::path& file, const ViewMemory& memory) {
  if (file.empty()) return {};
  NERITIC_TRY_STATUS(make_folder(file.parent_path()));
  return write_json(file, json{{"width_px", memory.width},
                               {"height_px", memory.height},
                               {"panels", memory.panels},
                               {"times", memory.times},
                               {"map", memory.map},
                               {"graphs", memory.graphs},
                               {"numbers", memory.numbers},
                               {"sonar_gain_db", memory.sonar_gain_db},
                               {"sonar_range_part", memory.sonar_range_part}});
}

}  // namespace neritic::testbed
