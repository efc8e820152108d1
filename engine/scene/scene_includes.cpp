#include "engine/scene/scene_includes.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::scene {
namespace fs = std::filesystem;
namespace {

// Merging compares every key with every other; no table of ours has a tenth of this.
constexpr std::size_t kMaxKeys = 2000;

// The arrays whose entries may include a file.
constexpr std::array<std::string_view, 5> kIncludingArrays{"objects", "vehicles", "cameras",
                                                           "sonars", "lamps"};

const std::string* name_of(const TomlValue& table) {
  const TomlEntry* entry = table.find("name");
  const bool named = entry && entry->value.kind == TomlValue::Kind::kString;
  return named ? &entry->value.text : nullptr;
}

void merge_table(TomlValue& base, TomlValue over);

// Appends over's entries to base; one whose name an entry of base has is merged into that.
void merge_table_arrays(TomlValue& base, TomlValue over) {
  std::map<std::string, std::size_t> base_index;
  for (std::size_t i = 0; i < base.items.size(); ++i)
    if (const std::string* name = name_of(base.items[i])) base_index.emplace(*name, i);
  for (TomlValue& entry : over.items) {
    const std::string* name = name_of(entry);
    const auto same = name ? base_index.find(*name) : base_index.end();
    if (same != base_index.end())
      merge_table(base.items[same->second], std::move(entry));
    else
      base.items.push_back(std::move(entry));
  }
}

// Ways to say the same thing, one key of any table each: a place, an attitude.
const std::vector<std::vector<std::string_view>> kPlaces{{"position_m"}, {"track"}};
const std::vector<std::vector<std::string_view>> kAttitudes{
    {"yaw_deg", "pitch_deg", "roll_deg"}, {"rotation_xyzw"}, {"look_at"}, {"look_at_m"}};

// Drops from base the ways that over replaces by another.
void drop_replaced(TomlValue& base, const TomlValue& over) {
  for (const auto& ways : {kPlaces, kAttitudes})
    for (const auto& way : ways) {
      if (std::ranges::none_of(way, [&](std::string_view key) { return over.find(key); })) continue;
      for (const auto& other : ways)
        if (other != way)
          std::erase_if(base.entries, [&](const TomlEntry& entry) {
            return std::ranges::find(other, entry.key) != other.end();
          });
    }
}

void merge_table(TomlValue& base, TomlValue over) {
  drop_replaced(base, over);
  for (TomlEntry& entry : over.entries) {
    TomlEntry* old = base.find(entry.key);
    if (!old)
      base.entries.push_back(std::move(entry));
    else if (old->value.is_table() && entry.value.is_table())
      merge_table(old->value, std::move(entry.value));
    else if (old->value.is_table_array() && entry.value.is_table_array())
      merge_table_arrays(old->value, std::move(entry.value));
    else
      *old = std::move(entry);
  }
  base.where = over.where;
}

class Includer {
 public:
  Result<SceneSource> read(const fs::path& path, const std::optional<std::string>& text,
                           const std::vector<fs::path>& added) {
    NERITIC_TRY(source_.root, text ? parse_table(*text, path) : read_table(path));
    for (const fs::path& more : added) {
      NERITIC_TRY(TomlValue over, read_table(more));
      merge_table(source_.root, std::move(over));
    }
    return std::move(source_);
  }

 private:
  Result<TomlValue> read_table(const fs::path& path) {
    std::error_code error;
    const auto bytes = fs::file_size(path, error);
    if (!error && bytes > kMaxSceneBytes)
      return refusal(path.string(), fmt::format("{} bytes", bytes),
                     fmt::format("a scene file of at most {}", kMaxSceneBytes));
    NERITIC_TRY(const std::string text, read_text(path));
    return parse_table(text, path);
  }

  Result<TomlValue> parse_table(const std::string& text, const fs::path& path) {
    source_.files.push_back(path.string());
    chain_.push_back(path);
    NERITIC_TRY(TomlValue table,
                parse_toml(text, path.string(), static_cast<int>(source_.files.size()) - 1));
    NERITIC_TRY_STATUS(expand(table));
    chain_.pop_back();
    return table;
  }

  // Replaces what the table and its entries include by what the files hold.
  Status expand(TomlValue& table) {
    if (table.entries.size() > kMaxKeys)
      return refusal(source_.place(table.where),
                     fmt::format("{} keys in a table", table.entries.size()),
                     fmt::format("at most {}", kMaxKeys));
    for (const std::string_view key : kIncludingArrays) {
      TomlEntry* entry = table.find(key);
      if (!entry || !entry->value.is_table_array()) continue;
      for (TomlValue& item : entry->value.items) NERITIC_TRY_STATUS(expand(item));
    }
    const TomlEntry* entry = table.find("include");
    if (!entry) return {};
    const TomlValue include = entry->value;
    std::erase_if(table.entries, [](const TomlEntry& e) { return e.key == "include"; });
    TomlValue base;
    if (include.kind == TomlValue::Kind::kString) {
      NERITIC_TRY_STATUS(merge_file(base, include));
    } else {
      for (const TomlValue& item : include.items) NERITIC_TRY_STATUS(merge_file(base, item));
      if (include.items.empty()) return not_a_path(include);
    }
    merge_table(base, std::move(table));
    table = std::move(base);
    return {};
  }

  Status merge_file(TomlValue& base, const TomlValue& written) {
    if (written.kind != TomlValue::Kind::kString) return not_a_path(written);
    const fs::path path = source_.resolve(written.where, written.text);
    std::error_code error;
    if (!fs::is_regular_file(path, error))
      return refusal(fmt::format("{}: include: {}", source_.place(written.where),
                                 printable(path.string(), 300)),
                     fs::exists(path, error) ? "no plain file" : "no such file",
                     "a file that can be read");
    for (const fs::path& open : chain_)
      if (fs::equivalent(open, path, error)) return loop(written, path);
    if (static_cast<int>(chain_.size()) > kMaxIncludeDepth || ++include_count_ > kMaxIncludes)
      return refusal(
          source_.place(written.where) + ": include", "one more file",
          fmt::format("includes up to {} deep and {} in all", kMaxIncludeDepth, kMaxIncludes));
    NERITIC_TRY(TomlValue included, read_table(path));
    merge_table(base, std::move(included));
    return {};
  }

  Error not_a_path(const TomlValue& value) const {
    return refusal(fmt::format("{}: include", source_.place(value.where)), describe(value),
                   "the path of a TOML file, or a list of such");
  }

  Error loop(const TomlValue& written, const fs::path& path) const {
    std::string chain;
    for (const fs::path& open : chain_) chain += open.filename().string() + " -> ";
    return refusal(fmt::format("{}: include", source_.place(written.where)),
                   fmt::format("a loop, {}{}", chain, path.filename().string()),
                   "files that do not include each other");
  }

  SceneSource source_;
  std::vector<fs::path> chain_;  // the files being read, outermost first
  int include_count_ = 0;
};

}  // namespace

fs::path SceneSource::resolve(const TomlWhere& where, const std::string& written) const {
  const fs::path folder = fs::path(files[static_cast<std::size_t>(where.file)]).parent_path();
  return (folder / written).lexically_normal();
}

Result<SceneSource> read_scene_source(const fs::path& path, const std::optional<std::string>& text,
                                      const std::vector<fs::path>& added) {
  return Includer().read(path, text, added);
}

}  // namespace neritic::scene
