// The planner against 26 dives and 24 tables by another program, dives of the same form by an
// implementation of its own that shares no code, and what changes with each convention.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "tests/diver/deco_cases.hpp"

namespace neritic::diver {
namespace {

void expect_all_hold(const std::string& file, std::size_t count) {
  const std::vector<CaseResult> results = check_deco(deco_cases(file));
  EXPECT_EQ(results.size(), count);
  for (const CaseResult& one : results)
    EXPECT_TRUE(one.ok()) << one.id << ": " << one.worst().error << " of " << one.worst().tolerance
                          << " in " << one.worst().what;
}

TEST(DecoVectors, EveryDiveAndTableHolds) {
  expect_all_hold("deco_vectors.json", 50);
}
TEST(DecoVectors, OtherConventionsGasesAndLevelsHold) {
  expect_all_hold("deco_more.json", 9);
}

// Every quantity is compared; its error is far below its tolerance.
TEST(DecoVectors, EveryQuantityIsComparedAndIsFarInsideItsTolerance) {
  std::map<std::string, double> worst;  // of error / tolerance
  for (const CaseResult& one : check_deco(deco_cases("deco_vectors.json")))
    for (const CheckedError& e : one.errors)
      worst[e.what] = std::max(worst[e.what], e.error / e.tolerance);
  for (const char* what : {"tissues at the end of the bottom",
                           "tissues at the first stop",
                           "tissues at surfacing",
                           "tissues replayed",
                           "initial tissues",
                           "tissues at earlier surfacing",
                           "earlier stops",
                           "ceilings",
                           "ceiling depths",
                           "leading compartment",
                           "stops",
                           "stops' gradient factors",
                           "stops' gases",
                           "run time",
                           "time without stops",
                           "closed form",
                           "CNS",
                           "OTU",
                           "pO2",
                           "stop time beside subsurface",
                           "stop time beside baker_gfdeco"})
    EXPECT_TRUE(worst.contains(what)) << what;
  EXPECT_LT(worst["tissues at surfacing"], 2e-3);  // files have nine digits
  EXPECT_LT(worst["closed form"], 2e-3);
  EXPECT_LT(worst["stops"], 1e-6);
  EXPECT_LT(worst["stop time beside subsurface"], 0.6);
  EXPECT_LT(worst["stop time beside baker_gfdeco"], 0.65);
}

// A check that cannot fail says nothing: each number that is compared, moved a little, is found.
TEST(DecoVectors, WhatIsWrongInAFileIsFound) {
  using Path = nlohmann::json::json_pointer;
  const auto original = parse_json(deco_text("deco_vectors.json")).value();
  const auto fails = [&](std::size_t dive, const char* path, double add) {
    nlohmann::json json = original;
    json["profiles"] = {original["profiles"][dive]};
    json.erase("ndl_tables");
    auto& number = json["profiles"][0][Path(path)];
    number = number.get<double>() + add;
    const auto cases = read_deco_cases(json_text(json), "moved");
    EXPECT_TRUE(cases.ok()) << cases.error().message;
    return !check_deco(*cases)[0].ok();
  };
  for (const char* path :
       {"/reference/end_of_bottom/tissues_n2_he_bar/15/0",
        "/reference/surfacing/tissues_n2_he_bar/0/1",
        "/reference/end_of_bottom/ceiling_bar_gf_low/7", "/reference/surfacing/ceiling_bar_gf_high",
        "/reference/first_stop/tissues_n2_he_bar/3/0", "/reference/first_stop/leading_ceiling_bar",
        "/reference/stops/2/gf_next", "/initial_tissues/4/0", "/segments/rows/1/2",
        "/reference/first_stop/depth_m", "/reference/stops/0/depth_m"})
    EXPECT_TRUE(fails(19, path, 1e-4)) << path;
  for (const char* path :
       {"/reference/stops/3/minutes", "/reference/total_stop_time_min",
        "/reference/total_runtime_min", "/reference/time_to_surface_min", "/reference/stops/1/o2",
        "/reference/end_of_bottom/leading_compartment_gf_low",
        "/reference/ndl_bottom_gas_runtime_min/continuous", "/oxygen_exposure/cns_percent",
        "/oxygen_exposure/otu", "/oxygen_exposure/max_po2_bar", "/parameters/bar_per_metre"})
    EXPECT_TRUE(fails(18, path, path[1] == 'p' ? 0.01 : 1.0)) << path;
  EXPECT_TRUE(fails(18, "/gases/1/switch_depth_m", -4.0));
  EXPECT_TRUE(fails(25, "/repetitive/surface_interval_min", 1.0));
  EXPECT_TRUE(fails(25, "/repetitive/first_dive_stops/3/1", 1.0));
  EXPECT_TRUE(fails(25, "/repetitive/first_dive/bottom_runtime_min", 1.0));
  EXPECT_TRUE(fails(25, "/repetitive/tissues_after_interval/0/0", 1e-4));
  EXPECT_TRUE(fails(3, "/second_opinions/subsurface/total_stop_time_min", 20.0));
  EXPECT_FALSE(fails(3, "/second_opinions/subsurface/total_stop_time_min", 0.0));
}

// The dives of the table of sensitivities.
DivePlanRequest sensitivity_dive(const std::string& name) {
  if (name == "air30/25") return square_dive(30.0, 25.0);
  if (name == "air45/25") return square_dive(45.0, 25.0);
  DivePlanRequest trimix = square_dive(60.0, 25.0, {0.18, 0.45});
  trimix.gases.push_back({{0.5, 0.0}, 21.0, GasRole::kDeco});
  trimix.gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
  return trimix;
}

using Change = void (*)(DivePlanRequest&);
const std::map<std::string, Change>& changes() {
  static const std::map<std::string, Change> all{
      {"base (DecoTengu B)", [](DivePlanRequest&) {}},
      {"water vapour 0.0567 (RQ 0.9)",
       [](DivePlanRequest& r) { r.conventions.water_vapour_bar = 0.0567; }},
      {"water vapour 0.0493 (RQ 0.8)",
       [](DivePlanRequest& r) { r.conventions.water_vapour_bar = 0.0493; }},
      {"0.1 bar/m (EN13319)",
       [](DivePlanRequest& r) { r.conventions.environment.bar_per_m = 0.1; }},
      {"salt 1030: 0.1010085",
       [](DivePlanRequest& r) { r.conventions.environment.bar_per_m = bar_per_m_of(1030.0); }},
      {"fresh 1000: 0.0980665",
       [](DivePlanRequest& r) { r.conventions.environment.bar_per_m = bar_per_m_of(1000.0); }},
      {"surface 1.000 bar",
       [](DivePlanRequest& r) { r.conventions.environment.surface_bar = 1.0; }},
      {"surface 1.013", [](DivePlanRequest& r) { r.conventions.environment.surface_bar = 1.013; }},
      {"compartment 1 (4 min) instead of 1b",
       [](DivePlanRequest& r) { r.conventions.first_compartment = FirstCompartment::k4Min; }},
      {"table C with 1",
       [](DivePlanRequest& r) {
         r.conventions.table = BuehlmannTable::kC;
         r.conventions.first_compartment = FirstCompartment::k4Min;
       }},
      {"table C with 1b (Subsurface, GasPlanner)",
       [](DivePlanRequest& r) { r.conventions.table = BuehlmannTable::kC; }},
      {"start N2 0.79", [](DivePlanRequest& r) { r.conventions.start_n2 = 0.79; }},
      {"start N2 0.781 (Subsurface)", [](DivePlanRequest& r) { r.conventions.start_n2 = 0.781; }},
      {"ascent credit when leaving a stop",
       [](DivePlanRequest& r) { r.conventions.leaving = LeavingTrial::kTissuesAfterAscent; }},
      {"1 s stop quantum", [](DivePlanRequest& r) { r.conventions.stop_quantum_min = 1.0 / 60.0; }},
      {"last stop 6 m", [](DivePlanRequest& r) { r.conventions.last_stop_m = 6.0; }},
      {"ascent 9 m/min", [](DivePlanRequest& r) { r.conventions.ascent_m_min = 9.0; }},
      {"descent 18 m/min", [](DivePlanRequest& r) { r.conventions.descent_m_min = 18.0; }},
      {"GF 100/100", [](DivePlanRequest& r) { r.gf_low = r.gf_high = 1.0; }},
      {"GF 30/70", [](DivePlanRequest& r) { r.gf_high = 0.7; }}};
  return all;
}

TEST(DecoVectors, EachConventionChangesWhatItChangesElsewhere) {
  const auto table = parse_json(deco_text("deco_sensitivity.json")).value();
  EXPECT_EQ(table.size(), changes().size());
  for (const auto& variation : table) {
    const std::string name = variation["variation"].get<std::string>();
    ASSERT_TRUE(changes().contains(name)) << name;
    for (const auto& result : variation["results"]) {
      const std::string dive = result["case"].get<std::string>();
      DivePlanRequest request = sensitivity_dive(dive);
      changes().at(name)(request);
      const auto plan = plan_dive(request);
      ASSERT_TRUE(plan.ok()) << plan.error().message;
      EXPECT_NEAR(plan->stop_min(), result["total_stop_min"].get<double>(), 6e-4) << name << dive;
      EXPECT_EQ(plan->stops.front().depth_m, result["first_stop_m"].get<double>()) << name << dive;
      EXPECT_NEAR(plan->run_min(), result["runtime_min"].get<double>(), 6e-3) << name << dive;
    }
  }
}

}  // namespace
}  // namespace neritic::diver
