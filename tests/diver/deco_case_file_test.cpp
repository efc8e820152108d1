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
    "profile": {"depth_m": 30, "bottom_runtime_min": 25},
    "reference": {"stops": [[12, 1], [9, 1], [6, 2], [3, 5]]}}]})")
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

// Tissues at the start are those of second opinions too, whether the dives before are told or not.
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

// What another program says is held against its own table and conventions, else against the case's.
TEST(DecoCaseFile, OtherProgramsAreHeldAgainstWhatTheirEntrySays) {
  // 45 m for 40 min: table C has eleven minutes more.
  const auto stop_min = [](BuehlmannTable table, const char* set) {
    DivePlanRequest request = square_dive(45.0, 40.0, kAir, set);
    request.conventions.table = table;
    request.conventions.environment = {};
    return plan_dive(request).value().stop_min();
  };
  const double b = stop_min(BuehlmannTable::kB, "stop-minutes"),
               c = stop_min(BuehlmannTable::kC, "stop-minutes"),
               run = stop_min(BuehlmannTable::kC, "run-minutes");
  ASSERT_GT(c, b + 5.0);
  const auto error = [](const char* model, const Json& opinion) {
    Json json = smallest_dive();
    Json& profile = json["profiles"][0];
    profile["model"] = model;
    profile["coefficient_table"] = "compartment 1b";
    profile["profile"] = {{"depth_m", 45}, {"bottom_runtime_min", 40}};
    profile["reference"] = Json::object();
    profile["second_opinions"]["gasplanner"] = opinion;
    return check_deco(read_deco_cases(json_text(json), "t.json").value())[0].errors.at(0).error;
  };
  EXPECT_EQ(error("ZH-L16B-GF", {{"total_stop_time_min", b}}), 0.0);
  EXPECT_EQ(error("ZH-L16C-GF", {{"total_stop_time_min", c}}), 0.0);
  EXPECT_EQ(error("ZH-L16B-GF", {{"total_stop_time_min", c}, {"table", "ZH-L16C with 1b"}}), 0.0);
  EXPECT_EQ(error("ZH-L16C-GF", {{"total_stop_time_min", b}, {"table", "column B"}}), 0.0);
  EXPECT_NEAR(error("ZH-L16B-GF", {{"total_stop_time_min", run},
                                   {"table", "C"},
                                   {"conventions", "run-minutes, but for the rates"}}),
              0.0, 1e-9);
  EXPECT_GT(error("ZH-L16B-GF", {{"total_stop_time_min", c}}), 5.0);
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

// The tables' closed form is of nitrogen alone: helium is refused by its name.
TEST(DecoCaseFile, ATableWithHeliumIsRefused) {
  const auto read = [](const char* he) {
    return read_deco_cases(fmt::format(R"({{"ndl_tables": [{{"model": "ZH-L16B-GF", "gf_high": 1.0,
        "o2": 21, {} "rows": [{{"depth_m": 30}}]}}]}})",
                                       he),
                           "t.json");
  };
  EXPECT_TRUE(read("").ok());
  EXPECT_TRUE(read("\"he\": 0,").ok());
  const auto refused = read("\"he\": 35,");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("he: 35 found, 0 (the closed form"), std::string::npos)
      << refused.error().message;
}

TEST(DecoCaseFile, AltitudeAndWaterAreMadeIntoPressures) {
  Json json = smallest_dive();
  json["profiles"][0]["parameters"]["altitude_m"] = 1500;
  json["profiles"][0]["parameters"]["water_density_kg_m3"] = 1000;
  json["profiles"][0]["model"] = "ZH-L16C";
  const auto read = read_deco_cases(json_text(json), "dives.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const DecoConventions& c = read->dives[0].request.conventions;
  EXPECT_NEAR(c.environment.surface_bar, 0.845560048, 1e-9);
  EXPECT_NEAR(c.environment.bar_per_m, 0.0980665, 1e-12);
  EXPECT_EQ(c.first_compartment, FirstCompartment::k4Min);
}

TEST(DecoCaseFile, ARowOfSegmentsIsReadByTheNamesOfItsColumns) {
  Json json = smallest_dive();
  json["profiles"][0]["segments"] = {{"columns", {"minutes", "phase", "to_m", "from_m"}},
                                     {"rows", Json::array({Json::array({1.5, "down", 30, 0})})}};
  const auto read = read_deco_cases(json_text(json), "dives.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->dives[0].segments[0].to_m, 30.0);
  EXPECT_EQ(read->dives[0].segments[0].minutes, 1.5);
  EXPECT_EQ(read->dives[0].segments[0].mix, kAir);
}

// A history that is not told in words still has the tissues that it left.
TEST(DecoCaseFile, WhatIsNotKnownIsLeftAlone) {
  Json json = smallest_dive();
  json["author"] = "someone";
  json["profiles"][0]["parameters"]["suit"] = "dry";
  EXPECT_EQ(fault_of(json), "read");
}

// A parameter that is nearly one would leave the dive with another setting than the file says.
TEST(DecoCaseFile, AMisspeltParameterIsRefused) {
  for (const auto& [key, nearest] : {std::pair{"last_stop", "last_stop_m"},
                                     {"saturation_multiplier", "saturation"},
                                     {"Gf_Low", "gf_low"},
                                     {"surface_pressure", "surface_pressure_bar"},
                                     {"gravity", "gravity_m_s2"}})
    EXPECT_EQ(fault_with((std::string("/parameters/") + key).c_str(), 6),
              fmt::format("dives.json: case 'small': profiles[0].parameters.{}: not known; the "
                          "nearest is {}",
                          key, nearest));
  EXPECT_EQ(
      fault_with("/reference/total_stop_time", 9),
      "dives.json: case 'small': profiles[0].reference.total_stop_time: not known; the nearest "
      "is total_stop_time_min");
  EXPECT_THAT(fault_with("/oxygen_exposure/cns", 4), HasSubstr("nearest is cns_percent"));
  EXPECT_THAT(fault_with("/reference/surfacing/tissues", 1),
              HasSubstr("nearest is tissues_n2_he_bar"));
  EXPECT_EQ(fault_with("/parameters/comment", "no setting"), "read");
  EXPECT_EQ(fault_with("/parameters/planner_version", 3), "read");
}

TEST(DecoCaseFile, GasesOfAnIntervalAndTheFirstCompartmentAreFoundInWords) {
  const auto gas_of = [](const char* words) {
    Json json = smallest_dive();
    json["profiles"][0]["repetitive"] = {
        {"first_dive", {{"depth_m", 20}, {"bottom_runtime_min", 30}}},
        {"surface_interval_min", 60},
        {"surface_interval_gas", words}};
    const auto read = read_deco_cases(json_text(json), "dives.json");
    EXPECT_TRUE(read.ok()) << read.error().message;
    return read.ok() ? read->dives[0].earlier[0].earlier.surface_gas : GasMix{0.0, 0.0};
  };
  EXPECT_EQ(gas_of("air 21/0 (N2 0.79), surface pressure, Schreiner with R=0"), kAir);
  EXPECT_EQ(gas_of("60 min of oxygen"), (GasMix{1.0, 0.0}));
  EXPECT_EQ(gas_of("50/0"), (GasMix{0.5, 0.0}));
  const auto first_of = [](const char* words) {
    Json json = smallest_dive();
    json["profiles"][0]["coefficient_table"] = words;
    return read_deco_cases(json_text(json), "dives.json")
        ->dives[0]
        .request.conventions.first_compartment;
  };
  EXPECT_EQ(first_of("N2 a column B, compartment 1b = 5.0/1.88 min"), FirstCompartment::k5Min);
  EXPECT_EQ(first_of("N2 a column B, compartment 1 = 4.0/1.51 min"), FirstCompartment::k4Min);
  EXPECT_EQ(first_of("see compartment 12"), FirstCompartment::k5Min);
}

TEST(DecoCaseFile, WhatIsWrongIsSaidInOneLine) {
  const std::string small = "dives.json: case 'small': ";
  EXPECT_EQ(fault_of(Json::array()), "dives.json: a JSON object is accepted, none found");
  EXPECT_EQ(fault_of(Json::object()),
            "dives.json: profiles: no case found, a list of dives, or of ndl_tables, is accepted");
  EXPECT_EQ(fault_with("/model", "VPM"),
            small + "profiles[0].model: \"VPM\" found, a text with 16B or 16C is accepted");
  EXPECT_EQ(fault_with("/model", nullptr), small + "profiles[0].model: not found, but needed");
  EXPECT_EQ(fault_with("/parameters/gf_low", nullptr),
            small + "profiles[0].parameters.gf_low: not found, but needed");
  EXPECT_THAT(fault_with("/parameters/gf_low", "low"),
              HasSubstr("\"low\" found, a number is accepted"));
  EXPECT_THAT(fault_with("/parameters/gf_low", 2.0), HasSubstr("gradient factors 2/0.85 found"));
  EXPECT_THAT(fault_with("/parameters/bar_per_metre", 0), HasSubstr("0 bar a metre found"));
  EXPECT_THAT(fault_with("/parameters/last_stop_m", 5), HasSubstr("a multiple of 3 m"));
  EXPECT_THAT(fault_with("/gases", Json::array()), HasSubstr("0 gases found"));
  EXPECT_THAT(fault_with("/gases/0/o2", 0.21), HasSubstr("a number in [1, 100]"));
  EXPECT_THAT(fault_with("/gases/0/he", 90), HasSubstr("100 in all are accepted"));
  EXPECT_THAT(fault_with("/gases/0/n2", 78), HasSubstr("what is left of 100"));
  EXPECT_THAT(fault_with("/gases/0/role", "spare"), HasSubstr("travel, bottom or deco"));
  EXPECT_THAT(fault_with("/gases/0/role", "deco"), HasSubstr("0 bottom gases found"));
  EXPECT_THAT(fault_with("/profile/depth_m", -3), HasSubstr("-3 found, a number in [0.01, 2000]"));
  EXPECT_THAT(fault_with("/profile/kind", "wavy"), HasSubstr("square or multilevel"));
  EXPECT_THAT(fault_with("/profile/kind", "multilevel"), HasSubstr("at least one level"));
  EXPECT_THAT(fault_with("/profile/bottom_runtime_min", 1), HasSubstr("is reached after 1.5 min"));
  EXPECT_THAT(fault_with("/initial_tissues", Json::array({1, 2})),
              HasSubstr("16 rows of 2 numbers"));
  EXPECT_THAT(fault_with("/reference/stops", 3), HasSubstr("a list is accepted"));
  EXPECT_THAT(fault_with("/segments/rows", Json::array()),
              HasSubstr("segments.columns: not found"));
  EXPECT_THAT(fault_with("/repetitive/gap", 60), HasSubstr("no dive found; first_dive"));
  EXPECT_THAT(fault_with("/repetitive/first_dive/depth_m", 20),
              HasSubstr("first_dive.bottom_runtime_min: not found"));
  EXPECT_THAT(
      fault_with("/repetitive", Json::array({Json{{"depth_m", 20}, {"bottom_runtime_min", 20}}})),
      HasSubstr("surface_interval_min: not found"));
  Json twice = smallest_dive();
  twice["profiles"].push_back(twice["profiles"][0]);
  EXPECT_THAT(fault_of(twice), HasSubstr("'small' is there twice"));
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
