// Reads which source each group of inputs of a vehicle, a diver or another object listens to.
#include <algorithm>

#include "engine/core/source_name.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr Interval kHold{0, 3600, false, false, "seconds"};

bool is_live(const std::string& from) {
  return from != "autopilot" && from != "recording" && from != "nobody";
}

// Reads `group = "suit"` or `group = { from = "suit", hold_s = 1, then = "nobody" }`.
InputChoice read_choice(TableReader& reader, Key group, KeyList recorded, const std::string& then) {
  const TomlValue* value = reader.find(group);
  InputChoice choice{std::string(group), "", {}, then};
  const std::string accepted =
      fmt::format("autopilot, {}nobody, or a source's name of up to {} printable characters",
                  std::ranges::find(recorded, group) != recorded.end() ? "recording, " : "",
                  kLongestSourceName);
  const auto check = [&](TableReader& at, Key key) {
    if ((is_live(choice.from) && !names_a_source(choice.from)) ||
        (choice.from == "recording" && std::ranges::find(recorded, group) == recorded.end()))
      at.refuse(key, accepted);
  };
  if (!value->is_table()) {
    choice.from = reader.text(group, "autopilot");
    check(reader, group);
    return choice;
  }
  TableReader table(reader.source(), *value, reader.path(group), kInputChoiceKeys);
  choice.from = table.text("from", "autopilot");
  if (!table.has("from"))
    table.refuse("from", accepted);
  else
    check(table, "from");
  for (const Key key : {"hold_s", "then"})
    if (table.has(key) && !is_live(choice.from))
      table.refuse(key, fmt::format("no such key beside from = \"{}\"", choice.from));
  if (table.has("hold_s")) choice.hold_s = table.number("hold_s", 0.0, kHold);
  choice.then = table.choice("then", choice.then, std::to_array<Key>({"autopilot", "nobody"}));
  if (!table.ok()) reader.fail(table.status().error());
  return choice;
}

}  // namespace

std::vector<InputChoice> read_inputs(TableReader& reader, KeyList groups, KeyList recorded,
                                     const std::string& then) {
  std::vector<InputChoice> choices;
  const TomlValue* table = reader.table("inputs");
  if (!table) return choices;
  TableReader inputs(reader.source(), *table, reader.path("inputs"), groups);
  for (const Key group : groups)
    if (inputs.has(group)) choices.push_back(read_choice(inputs, group, recorded, then));
  if (!inputs.ok()) reader.fail(inputs.status().error());
  return choices;
}

}  // namespace neritic::scene
