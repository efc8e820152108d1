// Files of cases of decompression: defaults of what is left out, and one line that says what is
// wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "tests/diver/deco_cases.hpp"

namespace neritic::diver {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

Json smallest_dive() {
  return parse_json(R"({"profiles": [{"id": "small", "model": "ZH-L16B-GF",
    "parameters": {"gf_low": 0.3, "gf_high": 0.85}, "gases": [{"o2": 21}],
    "profile": {"kind": "square", "depth_m": 30, "bottom_runtime_min": 25},
    "reference": {"stops": [{"depth_m": 12, "minutes": 1}, {"depth_m": 9, "minutes": 1},
      {"depth_m": 6, "minutes": 2}, {"depth_m": 3, "minutes": 5}]}}]})")
      .value();
}

std::string fault_of(const Json& json) {
  const auto read = read_deco_cases(json_text(json), "dives.json");
  return read.ok() ? "read" : read.error().message;
}

// The line for a dive of which `path` is something else.
std::string fault_with(const char* path, const Json& value) {
  Json json = smallest_dive();
  json["profiles"][0][Json::json_pointer(path)] = value;
  return fault_of(json);
}

TEST(DecoCaseFile, WhatIsLeftOutHasItsDefault) {
  const auto read = read_deco_cases(json_text(smallest_dive()), "dives.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const DecoConventions& c = read->dives[0].request.conventions;
  EXPECT_EQ(c.environment.surface_bar, 1.01325);
  EXPECT_EQ(c.environment.bar_per_m, 0.09985);
  EXPECT_EQ(c.first_compartment, FirstCompartment::k5Min);
  EXPECT_EQ(c.start_n2, 0.7902);
  EXPECT_EQ(c.last_stop_m, 3.0);
  EXPECT_TRUE(check_deco(*read)[0].ok());
}

TEST(DecoCaseFile, AllThatASecondOpinionSaysIsCompared) {
  const Json all = parse_json(deco_text("deco_vectors.json")).value();
  const auto holds = [&](const char* program, const char* field, const Json& value) {
    Json json;
    for (const Json& profile : all["profiles"])
      if (profile["id"] == "air_30m_25") json["profiles"] = Json::array({profile});
    if (*field) json["profiles"][0]["second_opinions"][program][Json::json_pointer(field)] = value;
    return check_deco(read_deco_cases(json_text(json), "t.json").value())[0].ok();
  };
  EXPECT_TRUE(holds("", "", {}));
  EXPECT_FALSE(holds("subsurface", "/end_of_bottom_tissues_n2_he_bar/4/0", 1.85));
  EXPECT_FALSE(holds("subsurface", "/total_runtime_min", 30.0));
  EXPECT_FALSE(holds("baker_gfdeco", "/start_of_deco_zone_m", 19.5));
  EXPECT_FALSE(holds("baker_gfdeco", "/cns_percent", 9.0));
  EXPECT_FALSE(holds("baker_gfdeco", "/otu", 21.5));
}

// Tissues at the start are those of second opinions too, whether the dive before is there or not.
TEST(DecoCaseFile, InitialTissuesAloneAreThoseOfSecondOpinionsToo) {
  const Json all = parse_json(deco_text("deco_vectors.json")).value();
  Json json;
  for (const Json& profile : all["profiles"])
    if (profile["id"] == "air_repet_30m_25_si60") json["profiles"] = Json::array({profile});
  ASSERT_EQ(json["profiles"].size(), 1u);
  ASSERT_TRUE(json["profiles"][0]["second_opinions"].contains("subsurface"));
  json["profiles"][0].erase("repetitive");
  const auto result = check_deco(read_deco_cases(json_text(json), "t.json").value())[0];
  EXPECT_TRUE(result.ok());
  const auto beside =
      std::ranges::find(result.errors, "stop time beside subsurface", &CheckedError::what);
  ASSERT_NE(beside, result.errors.end());
  EXPECT_LT(beside->error, 1.0);
}

// Another program is known by its name, with its own column of ZH-L16 and conventions.
TEST(DecoCaseFile, AnUnknownProgramIsRefused) {
  EXPECT_THAT(fault_with("/second_opinions", {{"gasplanner", {{"total_stop_time_min", 9}}}}),
              HasSubstr("second_opinions.gasplanner: not known; the nearest is "));
  EXPECT_EQ(fault_with("/second_opinions", {{"subsurface", {{"total_stop_time_min", 9}}}}), "read");
}

// A planner that stopped above the last stop is known by its first stop alone, too.
TEST(DecoCaseFile, AFirstStopAboveTheLastOneIsKnownWithoutStops) {
  const auto always = [](double depth_m) {
    Json json = smallest_dive();
    json["profiles"][0]["parameters"]["last_stop_m"] = 6;
    json["profiles"][0]["reference"] = {{"first_stop", {{"depth_m", depth_m}}}};
    return read_deco_cases(json_text(json), "dives.json").value().dives[0].request.last_stop_always;
  };
  EXPECT_FALSE(always(3.0));
  EXPECT_TRUE(always(6.0));
  EXPECT_TRUE(always(12.0));
}

// Null is what a program says that finds no limit: where there is one, it does not hold.
TEST(DecoCaseFile, ARowOfNullsIsNoLimit) {
  const auto holds = [](double depth_m, const char* said) {
    const auto read = read_deco_cases(
        fmt::format(R"({{"ndl_tables": [{{"model": "ZH-L16B-GF", "gf_high": 1.0, "o2": 21,
            "rows": [{{"depth_m": {}, {}}}]}}]}})",
                    depth_m, said),
        "t.json");
    EXPECT_TRUE(read.ok()) << read.error().message;
    return check_deco(*read)[0].ok();
  };
  for (const char* said :
       {R"("decotengu_runtime_min": null)", R"("closed_form_time_at_depth_min": null)"}) {
    EXPECT_TRUE(holds(5.0, said)) << said;
    EXPECT_FALSE(holds(30.0, said)) << said;
  }
}

// The closed form is nitrogen's: the format has no helium here.
TEST(DecoCaseFile, ATableWithHeliumIsRefused) {
  const auto refused = read_deco_cases(
      R"({"ndl_tables": [{"model": "ZH-L16B-GF", "gf_high": 1.0, "o2": 21, "he": 35,
          "rows": [{"depth_m": 30}]}]})",
      "t.json");
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("ndl_tables[0].he: not known; the nearest is"));
}

TEST(DecoCaseFile, AltitudeAndWaterAreMadeIntoPressures) {
  Json json = smallest_dive();
  json["profiles"][0]["parameters"]["altitude_m"] = 1500;
  json["profiles"][0]["parameters"]["water_density_kg_m3"] = 1000;
  json["profiles"][0]["model"] = "ZH-L16C-GF";
  const auto read = read_deco_cases(json_text(json), "dives.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const DecoConventions& c = read->dives[0].request.conventions;
  EXPECT_NEAR(c.environment.surface_bar, 0.845560048, 1e-9);
  EXPECT_NEAR(c.environment.bar_per_m, 0.0980665, 1e-12);
  EXPECT_EQ(c.first_compartment, FirstCompartment::k4Min);
}

TEST(DecoCaseFile, SegmentsHaveTheirSixColumns) {
  const Json columns = {"from_m", "to_m", "minutes", "o2_percent", "he_percent", "phase"};
  Json json = smallest_dive();
  json["profiles"][0]["segments"] = {
      {"columns", columns}, {"rows", Json::array({Json::array({0, 30, 1.5, 32, 0, "x"})})}};
  const auto read = read_deco_cases(json_text(json), "dives.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->dives[0].segments[0].to_m, 30.0);
  EXPECT_EQ(read->dives[0].segments[0].minutes, 1.5);
  EXPECT_EQ(read->dives[0].segments[0].mix, mix_of_percent(32.0, 0.0));
  const Json swapped = {"to_m", "from_m", "minutes", "o2_percent", "he_percent", "phase"};
  EXPECT_THAT(fault_with("/segments", {{"columns", swapped}, {"rows", Json::array()}}),
              HasSubstr("accepted: from_m, to_m, minutes"));
}

TEST(DecoCaseFile, TextsUnderOtherNamesAreNotes) {
  Json json = smallest_dive();
  json["author"] = "someone";
  json["profiles"][0]["parameters"]["suit"] = "dry";
  json["profiles"][0]["coefficient_table"] = "N2 a column C, compartment 1 = 4.0/1.51 min";
  ASSERT_EQ(fault_of(json), "read");
  const auto read = read_deco_cases(json_text(json), "dives.json");
  EXPECT_EQ(read->dives[0].request.conventions.first_compartment, FirstCompartment::k5Min);
}

TEST(DecoCaseFile, AMemberOutsideTheFormatIsRefused) {
  for (const auto& [key, nearest] : {std::pair{"last_stop", "last_stop_m"},
                                     {"saturation", "start_n2_fraction"},
                                     {"Gf_Low", "gf_low"},
                                     {"surface_pressure", "surface_pressure_bar"},
                                     {"gravity_ms2", "gravity_m_s2"}})
    EXPECT_EQ(fault_with((std::string("/parameters/") + key).c_str(), 6),
              fmt::format("dives.json: case 'small': profiles[0].parameters.{}: not known; the "
                          "nearest is {}",
                          key, nearest));
  EXPECT_EQ(
      fault_with("/reference/total_stop_time", 9),
      "dives.json: case 'small': profiles[0].reference.total_stop_time: not known; the nearest "
      "is total_stop_time_min");
  EXPECT_THAT(fault_with("/oxygen_exposure/cns", 4), HasSubstr("nearest is "));
  EXPECT_THAT(fault_with("/reference/surfacing/tissues", 1), HasSubstr("tissues: not known"));
  EXPECT_THAT(fault_with("/parameters/planner_version", 3),
              HasSubstr("planner_version: not known"));
  // A text is a note, but not where its name is a slip.
  EXPECT_EQ(fault_with("/parameters/comment", "no setting"), "read");
  EXPECT_THAT(fault_with("/gases/0/Role", "deco"),
              HasSubstr("Role: not known; the nearest is role"));
}

TEST(DecoCaseFile, WhatIsWrongIsSaidInOneLine) {
  const std::string small = "dives.json: case 'small': ";
  EXPECT_EQ(fault_of(Json::array()), "dives.json: found no JSON object; accepted: one");
  EXPECT_EQ(fault_of(Json::object()),
            "dives.json: profiles: found no case; accepted: a list of dives here, or of tables in "
            "ndl_tables");
  EXPECT_EQ(fault_with("/model", "VPM"),
            small + "profiles[0].model: found \"VPM\"; accepted: \"ZH-L16B-GF\" or \"ZH-L16C-GF\"");
  EXPECT_THAT(fault_with("/model", "ZH-L16C"), HasSubstr("found \"ZH-L16C\"; accepted:"));
  EXPECT_EQ(fault_with("/model", nullptr), small + "profiles[0].model: not found, but needed");
  EXPECT_EQ(fault_with("/parameters/gf_low", nullptr),
            small + "profiles[0].parameters.gf_low: not found, but needed");
  EXPECT_THAT(fault_with("/parameters/gf_low", "low"),
              HasSubstr("found \"low\"; accepted: a number"));
  EXPECT_THAT(fault_with("/parameters/gf_low", 2.0), HasSubstr("found gradient factors 2/0.85"));
  EXPECT_THAT(fault_with("/parameters/bar_per_metre", 0), HasSubstr("found 0 bar a metre"));
  EXPECT_THAT(fault_with("/parameters/last_stop_m", 5), HasSubstr("a multiple of 3 m"));
  EXPECT_THAT(fault_with("/gases", Json::array()), HasSubstr("found 0 gases"));
  EXPECT_THAT(fault_with("/gases/0/o2", 0.21), HasSubstr("a number in [1, 100]"));
  EXPECT_THAT(fault_with("/gases/0/he", 90), HasSubstr("accepted: at most 100 % in all"));
  EXPECT_THAT(fault_with("/gases/0/n2", 78), HasSubstr("what is left of 100"));
  EXPECT_THAT(fault_with("/gases/0/role", "spare"), HasSubstr("travel, bottom or deco"));
  EXPECT_THAT(fault_with("/gases/0/role", "deco"), HasSubstr("found 0 bottom gases"));
  EXPECT_THAT(fault_with("/profile/depth_m", -3),
              HasSubstr("found -3; accepted: a number in [0.01, 2000]"));
  EXPECT_THAT(fault_with("/profile/kind", "wavy"), HasSubstr("square or multilevel"));
  EXPECT_THAT(fault_with("/profile/kind", "multilevel"),
              HasSubstr("levels: not found, but needed"));
  EXPECT_THAT(fault_with("/profile/bottom_runtime_min", 1),
              HasSubstr("it is reached after 1.5 min"));
  EXPECT_THAT(fault_with("/initial_tissues", Json::array({1, 2})),
              HasSubstr("16 rows of 2 numbers"));
  EXPECT_THAT(fault_with("/reference/stops", 3), HasSubstr("accepted: a list"));
  EXPECT_THAT(fault_with("/segments/rows", Json::array()),
              HasSubstr("segments.columns: not found"));
  EXPECT_THAT(fault_with("/repetitive/first_dive/depth_m", 20),
              HasSubstr("first_dive.bottom_runtime_min: not found"));
  Json twice = smallest_dive();
  twice["profiles"].push_back(twice["profiles"][0]);
  EXPECT_THAT(fault_of(twice), HasSubstr("found 'small' a second time"));
}

TEST(DecoCaseFile, ACaseWithNothingToCompareDoesNotHold) {
  Json json = smallest_dive();
  json["profiles"][0].erase("reference");
  const auto read = read_deco_cases(json_text(json), "dives.json");
  ASSERT_TRUE(read.ok());
  const CaseResult result = check_deco(*read)[0];
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(result.worst().what, "nothing to compare");
}

}  // namespace
}  // namespace neritic::diver
