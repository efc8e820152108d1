// Warnings of plans, and that a plan within all limits has none.
#include "diver/plan_warnings.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/diver/deco_cases.hpp"

namespace neritic::diver {
namespace {

std::set<PlanWarningKind> kinds_of(const DivePlanRequest& request) {
  const auto plan = plan_dive(request);
  EXPECT_TRUE(plan.ok()) << plan.error().message;
  std::set<PlanWarningKind> kinds;
  for (const PlanWarning& w : plan_warnings(request, *plan)) {
    EXPECT_TRUE(kinds.insert(w.kind).second || w.gas > 0) << w.text;
    EXPECT_EQ(w.text.find('\n'), w.text.npos);
  }
  return kinds;
}

using enum PlanWarningKind;
using Kinds = std::set<PlanWarningKind>;

TEST(PlanWarnings, AreGivenWhereALimitIsPassed) {
  EXPECT_EQ(kinds_of(square_dive(18.0, 40.0)), Kinds{});
  EXPECT_EQ(kinds_of(square_dive(28.0, 15.0, {0.32, 0.0})), Kinds{});
  EXPECT_EQ(kinds_of(square_dive(39.0, 10.0)), (Kinds{kDensityMost, kNarcosis}));
  EXPECT_EQ(kinds_of(square_dive(35.0, 10.0)), (Kinds{kDensityAdvised, kNarcosis}));
  EXPECT_EQ(kinds_of(square_dive(30.0, 15.0, {0.5, 0.0})),
            (Kinds{kOxygenHigh, kDensityAdvised, kCns, kCnsBeyondTable}));
  EXPECT_EQ(kinds_of(square_dive(20.0, 15.0, {0.10, 0.5})), Kinds{kOxygenLow});
  DivePlanRequest trimix = square_dive(60.0, 25.0, {0.18, 0.45});
  trimix.gases.push_back({{0.5, 0.0}, 21.0, GasRole::kDeco});
  trimix.gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
  EXPECT_EQ(kinds_of(trimix), (Kinds{kDensityAdvised, kCounterdiffusion}));
  trimix.gases[2].switch_depth_m = 9.0;
  EXPECT_TRUE(kinds_of(trimix).contains(kOxygenHigh));
  EXPECT_TRUE(kinds_of(square_dive(20.0, 300.0, {0.5, 0.0})).contains(kCns));
  EXPECT_TRUE(kinds_of(square_dive(20.0, 300.0, {0.5, 0.0})).contains(kOtu));
}

// NOAA's table ends at 1.6 bar: what is reckoned beyond it is said to be.
TEST(PlanWarnings, OxygenBeyondTheTableOfCnsIsSaid) {
  const auto line_of = [](const DivePlanRequest& request) {
    for (const PlanWarning& w : plan_warnings(request, plan_dive(request).value()))
      if (w.kind == kCnsBeyondTable) return w.text;
    return std::string();
  };
  DivePlanRequest request = square_dive(30.0, 25.0, {0.5, 0.0});
  request.conventions.environment = {1.0, 0.1};
  // 1.6 bar is at 22 m: 1.1 min down at 20 m/min, from 1.5 min on at 2 bar, and 0.8 min up at 10.
  EXPECT_EQ(
      line_of(request),
      "CNS: 24.7 min above 1.6 bar, where NOAA's table ends, up to 2.00 on EAN50 at 30 m, 2 "
      "min; there the limit is extrapolated to zero at 1.7 bar, at least a minute: a warning, "
      "not a figure");
  // The whole time at the bottom counts alike where the depth does not change.
  request.levels[0].leave_min = 35.0;
  EXPECT_EQ(line_of(request).substr(0, 13), "CNS: 34.7 min");
  // On oxygen at 6 m 1.6 bar is met, as a table's end may be.
  DivePlanRequest deco = square_dive(45.0, 25.0);
  deco.gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
  EXPECT_EQ(line_of(deco), "");
  deco.gases[1].switch_depth_m = 9.0;
  EXPECT_NE(line_of(deco).find("up to 1.91 on O2 at 9 m"), std::string::npos) << line_of(deco);
}

TEST(PlanWarnings, AirInTheMountainsIsNotHypoxic) {
  DivePlanRequest lake = square_dive(18.0, 20.0);
  lake.conventions.environment.surface_bar = surface_bar_at(2500.0);
  EXPECT_EQ(kinds_of(lake), Kinds{});
  lake.gases[0].mix = {0.20, 0.3};
  const auto warnings = plan_warnings(lake, plan_dive(lake).value());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].text, "pO2 0.149 bar on 20/30 at 0 m, 0 min: below 0.157, hypoxic");
}

TEST(PlanWarnings, TellTheWorstAndWhere) {
  const DivePlanRequest request = square_dive(45.0, 10.0);
  const auto warnings = plan_warnings(request, plan_dive(request).value());
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].text,
            "gas density 7.1 g/L on air at 45 m, 2 min: above 6.2, the highest "
            "acceptable");
  EXPECT_EQ(warnings[1].text, "narcotic depth 45 m on air at 45 m, 2 min: above 30");
}

}  // namespace
}  // namespace neritic::diver
