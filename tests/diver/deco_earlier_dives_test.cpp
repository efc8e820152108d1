// Several dives in a row: the planner against an independent implementation, dive by dive, and what
// a file of cases may say of the dive before.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "tests/diver/deco_cases.hpp"

namespace neritic::diver {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

EarlierDive dive_of(const Json& json, const DivePlanRequest& base) {
  EarlierDive dive;
  dive.dive = base;
  dive.dive.gases.clear();
  dive.dive.levels = {{json["depth_m"].get<double>(), json["bottom_runtime_min"].get<double>()}};
  for (const Json& gas : json["gases"])
    dive.dive.gases.push_back({mix_of_percent(gas["o2"].get<double>(), gas["he"].get<double>()),
                               gas["switch_depth_m"].get<double>(),
                               dive.dive.gases.empty() ? GasRole::kBottom : GasRole::kDeco});
  dive.surface_min = json.value("surface_interval_min", 0.0);
  dive.surface_gas = mix_of_percent(json.value("surface_o2", 21.0), 0.0);
  return dive;
}

void expect_tissues(const TissueState& found, const Json& wanted, const std::string& where) {
  ASSERT_EQ(wanted.size(), kCompartments) << where;
  for (std::size_t i = 0; i < kCompartments; ++i) {
    EXPECT_NEAR(found.n2_bar[i], wanted[i][0].get<double>(), 1e-6) << where << i;
    EXPECT_NEAR(found.he_bar[i], wanted[i][1].get<double>(), 1e-6) << where << i;
  }
}

TEST(DecoEarlierDives, EachDiveOfADayIsThatOfAnIndependentImplementation) {
  const Json all = parse_json(deco_text("deco_several.json")).value();
  std::size_t compared = 0;
  for (const Json& one : all["cases"]) {
    DivePlanRequest base;
    const bool c = one["model"] == "ZH-L16C-GF";
    base.conventions.table = c ? BuehlmannTable::kC : BuehlmannTable::kB;
    base.conventions.first_compartment = c ? FirstCompartment::k4Min : FirstCompartment::k5Min;
    base.gf_low = one["gf_low"].get<double>();
    base.gf_high = one["gf_high"].get<double>();
    std::vector<EarlierDive> dives;
    for (const Json& json : one["dives"]) {
      dives.push_back(dive_of(json, base));
      std::vector<DivePlan> plans;
      const auto after = tissues_after(dives, &plans);
      ASSERT_TRUE(after.ok()) << after.error().message;
      const std::string where =
          fmt::format("{}, dive {}: ", one["id"].get<std::string>(), dives.size());
      const DivePlan& plan = plans.back();
      ASSERT_EQ(plan.stops.size(), json["stops"].size()) << where;
      for (std::size_t i = 0; i < plan.stops.size(); ++i) {
        EXPECT_EQ(plan.stops[i].depth_m, json["stops"][i][0].get<double>()) << where;
        EXPECT_NEAR(plan.stops[i].minutes, json["stops"][i][1].get<double>(), 1e-3) << where;
      }
      EXPECT_NEAR(plan.run_min(), json["runtime_min"].get<double>(), 1e-3) << where;
      if (json.contains("tissues_at_surfacing"))
        expect_tissues(plan.surfacing.tissues, json["tissues_at_surfacing"], where);
      if (json.contains("tissues_after_interval"))
        expect_tissues(*after, json["tissues_after_interval"], where);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 7u);
}

constexpr const char* kSmall = R"({"profiles": [{"id": "small", "model": "ZH-L16B-GF",
    "parameters": {"gf_low": 0.3, "gf_high": 0.85}, "gases": [{"o2": 21}],
    "profile": {"kind": "square", "depth_m": 30, "bottom_runtime_min": 25}}]})";

// The line for a file whose case has this dive before it.
std::string earlier_fault(const Json& repetitive) {
  Json json = parse_json(kSmall).value();
  json["profiles"][0]["repetitive"] = repetitive;
  const auto read = read_deco_cases(json_text(json), "dives.json");
  return read.ok() ? "read" : read.error().message;
}

TEST(DecoEarlierDives, OtherMembersOfTheDiveBeforeAreRefused) {
  const Json first = {{"depth_m", 30}, {"bottom_runtime_min", 25}};
  const auto fault = [&](const char* path, const Json& value) {
    Json told = {{"first_dive", first}, {"surface_interval_min", 60}};
    told[Json::json_pointer(path)] = value;
    return earlier_fault(told);
  };
  EXPECT_EQ(fault("/comment", "as dived"), "read");
  EXPECT_EQ(fault("/tissues_at_surface", 1),
            "dives.json: case 'small': profiles[0].repetitive.tissues_at_surface: not known; the "
            "nearest is tissues_at_surfacing");
  EXPECT_THAT(fault("/second_dive", first), HasSubstr("second_dive: not known"));
  EXPECT_THAT(fault("/dives", Json::array({first})), HasSubstr("dives: not known"));
  EXPECT_THAT(fault("/first_dive/levels", Json::array()), HasSubstr("levels: not known"));
  EXPECT_THAT(fault("/first_dive_runtime_mim", "37"),
              HasSubstr("the nearest is first_dive_runtime_min"));
  EXPECT_THAT(fault("/surface_interval_min", Json::array({60})),
              HasSubstr("found [60]; accepted: a number in"));
  EXPECT_THAT(fault("/surface_interval_gas", "oxygen"),
              HasSubstr("found \"oxygen\"; accepted: \"NAME O2/HE (N2 SHARE), surface"));
  EXPECT_THAT(earlier_fault(Json::array({first})), HasSubstr("accepted: an object"));
  EXPECT_THAT(earlier_fault({{"surface_interval_min", 60}}),
              HasSubstr("first_dive: not found, but needed"));
}

TEST(DecoEarlierDives, TheGasOfTheIntervalIsThatOfItsText) {
  const std::string how = ", surface pressure, Schreiner with R=0";
  const auto gas_of = [&](const std::string& gas) -> std::optional<GasMix> {
    Json json = parse_json(kSmall).value();
    json["profiles"][0]["repetitive"] = {
        {"first_dive", {{"depth_m", 30}, {"bottom_runtime_min", 25}}},
        {"surface_interval_min", 60},
        {"surface_interval_gas", gas}};
    const auto read = read_deco_cases(json_text(json), "dives.json");
    if (!read.ok()) return std::nullopt;
    return read->dives.at(0).earlier->earlier.surface_gas;
  };
  EXPECT_EQ(gas_of("air 21/0 (N2 0.79)" + how)->oxygen, kAir.oxygen);
  EXPECT_EQ(gas_of("oxygen 100/0 (N2 0)" + how)->oxygen, 1.0);
  EXPECT_DOUBLE_EQ(gas_of("ean50 50/0 (N2 0.5)" + how)->oxygen, 0.5);
  EXPECT_DOUBLE_EQ(gas_of("21/35 21/35 (N2 0.44)" + how)->helium, 0.35);
  for (const char* not_one_gas :
       {"air 21/0 (N2 0.79)", "air 32/0 (N2 0.68)", "air 21/0 (N2 0.78)", "air 21 (N2 0.79)",
        "air 21/0", "(N2 0.79)", "air 21/0 (N2 0.79 )", "air 21/0 (N2 )"}) {
    EXPECT_FALSE(
        gas_of(not_one_gas +
               (not_one_gas == std::string("air 21/0 (N2 0.79)") ? ", surface pressure" : how)))
        << not_one_gas;
  }
}

}  // namespace
}  // namespace neritic::diver
