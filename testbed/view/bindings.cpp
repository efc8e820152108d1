#include "testbed/view/bindings.hpp"

#include <algorithm>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/core/toml.hpp"

namespace neritic::testbed {
namespace {

std::string at(const std::filesystem::path& file, const TomlWhere& where) {
  return fmt::format("{}:{}", file.string(), where.line);
}

Result<std::vector<std::string>> controls_of(const TomlValue& value, const std::string& where) {
  std::vector<std::string> controls;
  for (const TomlValue& item : value.items)
    if (item.kind == TomlValue::Kind::kString) controls.push_back(item.text);
  if (value.kind != TomlValue::Kind::kArray || controls.size() != value.items.size())
    return refusal(where, describe(value), "a list of controls, as [\"key W\", \"-left stick_y\"]");
  return controls;
}

}  // namespace

Result<std::vector<xr::ActionDesc>> bound_actions(std::vector<xr::ActionDesc> actions,
                                                  const std::filesystem::path& file) {
  NERITIC_TRY(const std::string text, read_text(file));
  NERITIC_TRY(const TomlValue root, parse_toml(text, file.string(), 0));
  std::string names;
  for (const xr::ActionDesc& action : actions) names += (names.empty() ? "" : ", ") + action.name;
  for (const TomlEntry& table : root.entries) {
    if (table.key != "actions" || !table.value.is_table())
      return refusal(at(file, table.where), fmt::format("'{}'", printable(table.key)), "[actions]");
    for (const TomlEntry& entry : table.value.entries) {
      const auto found =
          std::find_if(actions.begin(), actions.end(),
                       [&](const xr::ActionDesc& action) { return action.name == entry.key; });
      if (found == actions.end())
        return refusal(at(file, entry.where), fmt::format("action '{}'", printable(entry.key)),
                       names);
      NERITIC_TRY(found->bindings, controls_of(entry.value, at(file, entry.where)));
      const auto read = xr::ActionTable::create({&*found, 1});
      if (!read.ok()) return bad_input("{}: {}", at(file, entry.where), read.error().message);
    }
  }
  // With the bindings that stay.
  const auto read = xr::ActionTable::create(actions);
  if (!read.ok()) return bad_input("{}: {}", file.string(), read.error().message);
  return actions;
}

}  // namespace neritic::testbed
