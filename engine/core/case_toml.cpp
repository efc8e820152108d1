// See case_toml.hpp.
#include "engine/core/case_toml.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/toml.hpp"

namespace neritic {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr int kMostIncludes = 8;

nlohmann::json json_of(const TomlValue& value) {
  switch (value.kind) {
    case TomlValue::Kind::kBool:
      return value.boolean;
    case TomlValue::Kind::kInteger:
      return value.integer;
    case TomlValue::Kind::kNumber:
      if (std::isfinite(value.number)) return value.number;
      return std::isnan(value.number) ? "nan" : "inf";  // a text where a number is accepted
    case TomlValue::Kind::kString:
      return value.text;
    case TomlValue::Kind::kDate:
      return "a date or time";
    case TomlValue::Kind::kArray: {
      nlohmann::json out = nlohmann::json::array();
      for (const TomlValue& item : value.items) out.push_back(json_of(item));
      return out;
    }
    case TomlValue::Kind::kTable:
      break;
  }
  nlohmann::json out = nlohmann::json::object();
  for (const TomlEntry& entry : value.entries) out[entry.key] = json_of(entry.value);
  return out;
}

// Where each key and each table of a list is, by its path.
using Places = std::map<std::string, std::string>;
void add_places(const TomlValue& value, const std::string& path, const std::string& name,
                Places& places) {
  for (const TomlEntry& entry : value.entries) {
    const std::string at = path.empty() ? entry.key : path + "." + entry.key;
    places[at] = fmt::format("{}:{}", name, entry.where.line);
    add_places(entry.value, at, name, places);
  }
  if (!value.is_table_array()) return;
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    const std::string at = fmt::format("{}[{}]", path, i);
    places[at] = fmt::format("{}:{}", name, value.items[i].where.line);
    add_places(value.items[i], at, name, places);
  }
}

// Keys of over win; tables are merged key by key.
void merge(nlohmann::json& under, const nlohmann::json& over) {
  for (auto it = over.begin(); it != over.end(); ++it) {
    const auto there = under.find(it.key());
    if (there != under.end() && there->is_object() && it->is_object())
      merge(*there, *it);
    else
      under[it.key()] = *it;
  }
}

// The file's tree over that of the file it includes, and so on.
Result<nlohmann::json> read_tree(std::string_view text, const std::string& name,
                                 const std::filesystem::path& folder,
                                 std::span<const std::string_view> paths, int depth,
                                 Places& places) {
  if (text.size() > kMostBytes)
    return refusal(name, fmt::format("{} bytes", text.size()),
                   fmt::format("at most {}", kMostBytes));
  NERITIC_TRY(const TomlValue parsed, parse_toml(text, name, 0));
  nlohmann::json own = json_of(parsed);
  Places own_places;
  add_places(parsed, "", name, own_places);
  // Keys that includes brought keep their places.
  places.insert(own_places.begin(), own_places.end());
  // Paths are relative to the file that they are written in.
  for (const std::string_view key : paths)
    if (const auto file = own.find(std::string(key)); file != own.end() && file->is_string())
      *file = (folder / file->get<std::string>()).string();
  const auto include = own.find("include");
  if (include == own.end()) return own;
  if (!include->is_string())
    return refusal(fmt::format("{}: include", name), "another kind of value", "the name of a file");
  if (depth == kMostIncludes)
    return refusal(fmt::format("{}: include", name), "files nested deeper",
                   fmt::format("{} levels", depth));
  const std::filesystem::path path = folder / include->get<std::string>();
  own.erase(include);
  NERITIC_TRY(const std::string base, read_text(path));
  NERITIC_TRY(nlohmann::json under,
              read_tree(base, path.string(), path.parent_path(), paths, depth + 1, places));
  merge(under, own);
  return under;
}

}  // namespace

Result<CaseFile> parse_case_toml(std::string_view text, const std::string& name,
                                 const std::filesystem::path& folder,
                                 std::span<const std::string_view> paths) {
  Places places;
  NERITIC_TRY(nlohmann::json tree, read_tree(text, name, folder, paths, 0, places));
  return CaseFile(std::move(tree), name, std::move(places));
}

}  // namespace neritic
