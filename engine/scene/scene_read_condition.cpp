// Reads the tables condition and regulator of a diver. The names of effects are those of
// diver/condition.hpp, which engine/scene does not know.
#include <algorithm>

#include "engine/core/text.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"
#include "engine/scene/scene_table.hpp"

namespace neritic::scene {
namespace {

constexpr auto kEffectNames =
    std::to_array<Key>({"hypoxia", "carbon_dioxide", "oxygen", "narcosis", "cold"});
constexpr Interval kFlowSeconds{0, 1e9, false, false, "seconds"};
constexpr std::uint64_t kLastTank = 3;  // the most that a diver's file has, from 0

void read_effects(TableReader& reader, Condition& condition) {
  const TomlValue* value = reader.find("effects");
  if (!value) return;
  bool good = value->kind == TomlValue::Kind::kArray && !value->items.empty();
  for (std::size_t i = 0; good && i < value->items.size(); ++i) {
    const TomlValue& item = value->items[i];
    good = item.kind == TomlValue::Kind::kString &&
           std::ranges::find(kEffectNames, item.text) != kEffectNames.end() &&
           std::ranges::find(condition.effects, item.text) == condition.effects.end();
    if (good) condition.effects.push_back(item.text);
  }
  if (!good) reader.refuse("effects", "a list of some of " + join(kEffectNames));
}

FreeFlow read_free_flow(TableReader& reader) {
  FreeFlow flow;
  flow.at_s = reader.number("at_s", flow.at_s, kFlowSeconds);
  flow.until_s = reader.number("until_s", flow.until_s, kFlowSeconds);
  if (flow.until_s <= flow.at_s)
    reader.refuse("until_s", fmt::format("more than at_s, {:g}", flow.at_s));
  flow.tank = reader.whole("tank", flow.tank, 0, kLastTank);
  flow.area_m2 =
      1e-6 * reader.number("area_mm2", 1e6 * flow.area_m2, {0, 100, true, false, "mm^2"});
  return flow;
}

}  // namespace

std::optional<Condition> read_condition(TableReader& parent) {
  return read_term<Condition>(parent, "condition", kConditionKeys, [](TableReader& reader) {
    Condition condition;
    read_effects(reader, condition);
    condition.acts = reader.flag("acts", condition.acts);
    if (reader.has("water_c"))
      condition.water_c = reader.number("water_c", 12.0, {-2, 40, false, false, "C"});
    condition.fat_share = reader.number("fat_share", condition.fat_share, {0.03, 0.6});
    if (reader.has("oxygen_tolerance"))
      condition.oxygen_tolerance = reader.number("oxygen_tolerance", 0.0, {-5, 5});
    return condition;
  });
}

std::optional<Regulator> read_regulator(TableReader& parent) {
  return read_term<Regulator>(parent, "regulator", kRegulatorKeys, [](TableReader& reader) {
    Regulator regulator;
    regulator.donor = reader.text("donor", regulator.donor);
    for (const Key key : {"donor_tank", "hose_m", "reaction_s"})
      if (regulator.donor.empty() && reader.has(key))
        reader.refuse(key, "no such key without donor");
    regulator.donor_tank = reader.whole("donor_tank", regulator.donor_tank, 0, kLastTank);
    regulator.hose_m = reader.number("hose_m", regulator.hose_m, {0, 10, true, false, "metres"});
    regulator.reaction_s =
        reader.number("reaction_s", regulator.reaction_s, {0, 600, false, false, "seconds"});
    const auto& flows = reader.tables("free_flow");
    for (std::size_t i = 0; i < flows.size(); ++i) {
      TableReader flow(reader.source(), flows[i],
                       fmt::format("{}[{}]", reader.path("free_flow"), i), kFreeFlowKeys);
      regulator.free_flows.push_back(read_free_flow(flow));
      if (const Status status = flow.status(); !status.ok()) reader.fail(status.error());
    }
    return regulator;
  });
}

}  // namespace neritic::scene
