// What a file of cases of decompression says of the dives before: read in all its forms, and every
// number that is expected of them compared.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "tests/diver/deco_cases.hpp"

namespace neritic::diver {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

// The line for a file whose case has these dives before it.
std::string earlier_fault(const Json& repetitive) {
  Json json = parse_json(R"({"profiles": [{"id": "small", "model": "ZH-L16B-GF",
    "parameters": {"gf_low": 0.3, "gf_high": 0.85}, "gases": [{"o2": 21}],
    "profile": {"depth_m": 30, "bottom_runtime_min": 25}}]})")
                  .value();
  json["profiles"][0]["repetitive"] = repetitive;
  const auto read = read_deco_cases(json_text(json), "dives.json");
  return read.ok() ? "read" : read.error().message;
}

TEST(DecoEarlierDives, ThatWouldNotCountAreRefused) {
  const Json dive = {{"depth_m", 30}, {"bottom_runtime_min", 25}};
  const auto fault = [&](const char* second, const Json& intervals) {
    Json repetitive = {{"first_dive", dive}, {"surface_interval_min", intervals}};
    if (*second) repetitive[second] = dive;
    return earlier_fault(repetitive);
  };
  EXPECT_EQ(fault("", 60), "read");
  EXPECT_EQ(fault("second_dive", {60, 90}), "read");
  EXPECT_THAT(fault("", {60, 90}),
              HasSubstr("surface_interval_min: 2 minutes at the surface for 1"));
  EXPECT_THAT(fault("second_div", {60}),
              HasSubstr("second_div: 1 dives found before it, second_dive"));
  EXPECT_THAT(fault("third_dive", {60}),
              HasSubstr("third_dive: 1 dives found before it, second_dive"));
}

// Ways to say the same three dives before a fourth; deco_more.json has four more.
TEST(DecoEarlierDives, AreToldInManyWays) {
  const Json more = parse_json(deco_text("deco_more.json")).value();
  Json dive;
  for (const Json& one : more["profiles"])
    if (one["id"] == "three_earlier_air_list") dive = one;
  const Json list = dive["repetitive"];
  ASSERT_EQ(list.size(), 3u);
  Json nested = {{"first_dive", list[2]}};
  nested["first_dive"]["repetitive"] = {{"first_dive", list[1]}};
  nested["first_dive"]["repetitive"]["first_dive"]["repetitive"] = {{"first_dive", list[0]}};
  Json entries = Json::array();
  for (const Json& one : list)
    entries.push_back({{"dive", one}, {"surface_interval_min", one["surface_interval_min"]}});
  for (const Json& told : {Json{{"first_dive", list}}, Json{{"history", entries}}, nested}) {
    dive["repetitive"] = told;
    dive.erase("initial_tissues");
    const auto read = read_deco_cases(json_text({{"profiles", {dive}}}), "dives.json");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->dives[0].earlier.size(), 3u);
    const CaseResult result = check_deco(*read)[0];
    EXPECT_TRUE(result.ok()) << told << ": " << result.worst().what;
    Json later = dive;  // and the intervals count
    later["repetitive"] = told;
    const Json::json_pointer interval(
        told.contains("history")        ? "/history/1/surface_interval_min"
        : told["first_dive"].is_array() ? "/first_dive/0/surface_interval_min"
                                        : "/first_dive/repetitive/first_dive/surface_interval_min");
    ASSERT_TRUE(later["repetitive"].contains(interval));
    later["repetitive"][interval] = 5;
    const auto wrong = read_deco_cases(json_text({{"profiles", {later}}}), "dives.json");
    EXPECT_FALSE(check_deco(*wrong)[0].ok());
  }
}

// Three dives before a fourth, in every form that a file may say them in. Each number that is
// expected of them is found wrong where it is: none is passed over.
TEST(DecoEarlierDives, EveryNumberExpectedOfThemIsCompared) {
  const Json more = parse_json(deco_text("deco_more.json")).value();
  Json dive;
  for (const Json& one : more["profiles"])
    if (one["id"] == "three_earlier_air_list") dive = one;
  dive["reference"] = Json::object();
  dive["reference"]["stops"] = Json::array();
  for (const char* later : {"oxygen_exposure", "second_opinions", "segments", "initial_tissues"})
    dive.erase(later);
  const Json list = dive["repetitive"];
  ASSERT_EQ(list.size(), 3u);
  const char* const kExpected[] = {"stops", "runtime_min", "tissues_at_surfacing",
                                   "tissues_after_interval"};
  const char* const kNames[] = {"first_dive", "second_dive", "third_dive"};
  const auto bare = [&](Json one) {
    for (const char* name : kExpected) one.erase(name);
    one.erase("surface_interval_min");
    return one;
  };
  // A level of the nested form: its dive, and beside it what is expected of that.
  const auto level = [&](const Json& one) {
    Json out = {{"first_dive", bare(one)}, {"surface_interval_min", one["surface_interval_min"]}};
    for (const char* name : {"tissues_at_surfacing", "tissues_after_interval"})
      out[name] = one[name];
    for (const char* name : {"stops", "runtime_min"})
      out[std::string("first_dive_") + name] = one[name];
    return out;
  };
  Json inside, beside, tables, nested = level(list[2]), nested_list = level(list[2]), entries,
                               around = {{"dives", Json::array()}};
  nested["first_dive"]["repetitive"] = level(list[1]);
  nested["first_dive"]["repetitive"]["first_dive"]["repetitive"] = level(list[0]);
  nested_list["first_dive"]["repetitive"] = Json::array({list[0], list[1]});
  entries = Json::array();
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& one = list[i];
    inside[kNames[i]] = one;
    for (Json* named : {&beside, &tables}) {
      (*named)[kNames[i]] = bare(one);
      (*named)["surface_interval_min"].push_back(one["surface_interval_min"]);
    }
    Json entry = {{"dive", bare(one)}, {"surface_interval_min", one["surface_interval_min"]}};
    around["dives"].push_back(bare(one));
    around["surface_interval_min"].push_back(one["surface_interval_min"]);
    for (const char* name : kExpected) {
      const bool table = std::string(name).starts_with("tissues");
      beside[fmt::format("{}_{}", kNames[i], name)] = one[name];
      entry[name] = one[name];
      if (table) {
        tables[name].push_back(one[name]);
        around[name].push_back(one[name]);
      } else {
        tables[fmt::format("{}_{}", kNames[i], name)] = one[name];
        around[fmt::format("{}_{}", kNames[i], name)] = one[name];
      }
    }
    entries.push_back(entry);
  }
  const auto holds = [&](const Json& told) {
    dive["repetitive"] = told;
    const auto read = read_deco_cases(json_text({{"profiles", {dive}}}), "dives.json");
    EXPECT_TRUE(read.ok()) << read.error().message;
    if (!read.ok()) return false;
    EXPECT_EQ(read->dives[0].earlier.size(), 3u);
    // Of the fourth dive nothing is compared here that holds or not.
    DecoCase one = read->dives[0];
    one.expected = {};
    return check_dive(one, *read).ok();
  };
  const std::pair<const char*, Json> forms[] = {{"list", list},
                                                {"named, inside", inside},
                                                {"named, beside", beside},
                                                {"named, tables", tables},
                                                {"nested", nested},
                                                {"nested list", nested_list},
                                                {"entries", entries},
                                                {"list in an object", around}};
  for (const auto& [form, told] : forms) {
    EXPECT_TRUE(holds(told)) << form;
    int spoilt = 0;
    const Json flat = told.flatten();
    for (const auto& [path, value] : flat.items()) {
      const bool tissue = path.find("tissues_") != path.npos && path.ends_with("/3/0");
      const bool stop = path.find("stops/") != path.npos && path.ends_with("/0/1");
      if (!tissue && !stop && !path.ends_with("runtime_min")) continue;
      if (path.ends_with("bottom_runtime_min")) continue;
      Json wrong = told;
      wrong[Json::json_pointer(path)] = value.get<double>() + (tissue ? 1e-4 : 1.0);
      EXPECT_FALSE(holds(wrong)) << form << path;
      ++spoilt;
    }
    EXPECT_EQ(spoilt, 12) << form;
  }
}

TEST(DecoEarlierDives, WhatIsNotKnownOfThemIsRefused) {
  const Json first = {{"depth_m", 30}, {"bottom_runtime_min", 25}};
  const auto fault = [&](const char* path, const Json& value, bool list = false) {
    Json told = {{"first_dive", first}, {"surface_interval_min", 60}};
    if (list) told = {{"dives", {first}}, {"surface_interval_min", {60}}};
    told[Json::json_pointer(path)] = value;
    return earlier_fault(told);
  };
  const Json zero = Json::array({0.0, 0.0}), table = std::vector<Json>(16, zero);
  EXPECT_EQ(fault("/comment", "as dived"), "read");
  EXPECT_EQ(fault("/tissues_at_surface", table),
            "dives.json: case 'small': profiles[0].repetitive.tissues_at_surface: not known of "
            "earlier dives; the nearest is tissues_at_surfacing");
  EXPECT_THAT(fault("/first_dive_run_time_min", 37),
              HasSubstr("nearest is first_dive_runtime_min"));
  EXPECT_THAT(fault("/second_dive_stops", Json::array()), HasSubstr("is first_dive_stops"));
  EXPECT_THAT(fault("/first_dive/tissues_after", table),
              HasSubstr("first_dive.tissues_after: not known of earlier dives"));
  EXPECT_THAT(fault("/dives/0/run_min", 37, true), HasSubstr("dives[0].run_min: not known"));
  EXPECT_THAT(fault("/ceiling_bar", 1.2, true), HasSubstr("ceiling_bar: not known"));
  EXPECT_THAT(fault("/tissues_at_surfacing", {table, table}),
              HasSubstr("2 tables for 1 dives found"));
  EXPECT_THAT(fault("/surface_interval_gas", {"air", "O2"}, true),
              HasSubstr("2 gases at the surface for 1 dives"));
  Json twice = {{"first_dive", first}, {"surface_interval_min", 60}};
  twice["first_dive_runtime_min"] = 37;
  twice["first_dive"]["runtime_min"] = 37;
  EXPECT_THAT(earlier_fault(twice),
              HasSubstr("first_dive_runtime_min: said at profiles[0].repetitive.first_dive."
                        "runtime_min too, once is accepted"));
}

}  // namespace
}  // namespace neritic::diver
