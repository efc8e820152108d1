// How much gas plans take, against hand sums; and whether tanks hold it.
#include "diver/gas_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/diver/deco_cases.hpp"

namespace neritic::diver {
namespace {

using ::testing::HasSubstr;

// A metre of water is a tenth of a bar, and the air 1 bar: sums can be done by hand.
DivePlanRequest easy_dive(double depth_m, double leave_min, const GasMix& mix = kAir) {
  DivePlanRequest request = square_dive(depth_m, leave_min, mix);
  request.conventions.environment = kTenMetresABar;
  return request;
}

struct Planned {
  DivePlanRequest request;
  DivePlan plan;
  std::vector<PlanGasUse> use;
};
Planned gas_planned(const DivePlanRequest& request, const std::vector<PlanTank>& tanks = {},
                    const PlanBreathing& breathing = {}) {
  Planned out{request, plan_dive(request).value(), {}};
  auto use = gas_use(request, out.plan, breathing, tanks);
  EXPECT_TRUE(use.ok()) << use.error().message;
  if (use.ok()) out.use = *use;
  return out;
}

TEST(GasPlan, LitresOfADiveWithoutStopsAreTheHandsSum) {
  // 18 m: 0.9 min down at 1.9 bar on average, 39.1 min at 2.8, 1.8 min up at 1.9.
  const Planned p = gas_planned(easy_dive(18.0, 40.0));
  ASSERT_TRUE(p.plan.stops.empty());
  EXPECT_NEAR(p.use[0].used_l, 20.0 * (0.9 * 1.9 + 39.1 * 2.8) + 17.0 * 1.8 * 1.9, 1e-9);
  EXPECT_NEAR(p.use[0].used_before_l, 20.0 * (0.9 * 1.9 + 39.1 * 2.8), 1e-9);
  // Two divers at twice 20 l/min each: four minutes there, then up.
  EXPECT_NEAR(p.use[0].minimum_l, 80.0 * (4.0 * 2.8 + 1.8 * 1.9), 1e-9);
  EXPECT_EQ(p.use[0].minimum_run_min, 40.0);
  EXPECT_EQ(p.use[0].minimum_depth_m, 18.0);
  const PlanBreathing calm{15.0, 12.0, 1.0, 1.5, 1.0};
  const Planned q = gas_planned(easy_dive(18.0, 40.0), {}, calm);
  EXPECT_NEAR(q.use[0].used_l, 15.0 * (0.9 * 1.9 + 39.1 * 2.8) + 12.0 * 1.8 * 1.9, 1e-9);
  EXPECT_NEAR(q.use[0].minimum_l, 22.5 * (1.0 * 2.8 + 1.8 * 1.9), 1e-9);
}

TEST(GasPlan, EachGasHasItsStopsAndMinimumGasEndsAtTheFirstSwitch) {
  DivePlanRequest request = easy_dive(60.0, 25.0, {0.18, 0.45});
  request.gases.push_back({{0.5, 0.0}, 21.0, GasRole::kDeco});
  request.gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
  const Planned p = gas_planned(request);
  // By hand over the stops: each at its depth, a third of a minute up to the next 3 m.
  const auto bar = [](double depth_m) { return 1.0 + 0.1 * depth_m; };
  double sums[3] = {20.0 * (3.0 * 4.0 + 22.0 * 7.0), 0.0, 0.0}, up_l = 0.0, at_m = 60.0;
  for (const PlanStop& stop : p.plan.stops) {
    const double rise = (at_m - stop.depth_m) / 10.0 * bar(0.5 * (at_m + stop.depth_m));
    // The way to a switch is breathed on the gas before it.
    const std::size_t before = at_m > 21.0 ? 0 : at_m > 6.0 ? 1 : 2;
    sums[before] += 17.0 * rise;
    sums[stop.gas] += 17.0 * stop.minutes * bar(stop.depth_m);
    if (before == 0) up_l += 80.0 * rise;
    if (stop.gas == 0) up_l += 80.0 * stop.minutes * bar(stop.depth_m);
    at_m = stop.depth_m;
  }
  ASSERT_EQ(at_m, 3.0);
  sums[2] += 17.0 * 0.3 * bar(1.5);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(p.use[i].used_l, sums[i], 1e-8) << i;
  EXPECT_NEAR(p.use[0].minimum_l, 80.0 * 4.0 * 7.0 + up_l, 1e-8);
  EXPECT_EQ(p.use[1].minimum_l, 0.0);
  double all = 0.0, run_min = 0.0;
  for (const PlanSegment& s : p.plan.segments) {
    all += segment_litres(request, p.plan, {}, s, run_min);
    run_min += s.minutes;
  }
  EXPECT_NEAR(all, p.use[0].used_l + p.use[1].used_l + p.use[2].used_l, 1e-8);
}

TEST(GasPlan, TanksHoldRealGas) {
  // 12 l from 200 to 150 bar are 17.70 l/min over 10 min at 20 m, not the ideal 19.84
  // (tests/diver/gas_test.cpp holds the same of the tank model).
  const PlanTank tank{0, 12.0, 200.0};
  EXPECT_NEAR(tank_bar(kAir, tank, 17.70 * 10.0 * 3.024), 150.0, 0.1);
  EXPECT_EQ(tank_bar(kAir, tank, 1e6), 0.0);
  const Planned p = gas_planned(easy_dive(18.0, 40.0), {{0, 15.0, 230.0}});
  const PlanTankUse& use = *p.use[0].tank;
  EXPECT_FALSE(use.empty_min.has_value());
  // p V / Z before, less what was used, is p V / Z after.
  const auto held = [](double bar) { return 15.0 * bar / compressibility(kAir, 1e5 * bar); };
  EXPECT_NEAR(held(230.0) - held(use.end_bar), p.use[0].used_l, 1e-6);
  EXPECT_NEAR(held(230.0) - held(use.then_bar), p.use[0].used_before_l, 1e-6);
  // Up to the surface, where the regulator gives no full breath below 6 bar.
  EXPECT_NEAR(held(use.minimum_bar) - held(6.0), p.use[0].minimum_l, 1e-6);
}

TEST(GasPlan, ATankThatIsTooSmallIsOneLine) {
  const auto warnings = [](const Planned& p) { return gas_warnings(p.request, p.use); };
  const DivePlanRequest dive = easy_dive(18.0, 40.0);
  EXPECT_TRUE(warnings(gas_planned(dive)).empty());
  EXPECT_TRUE(warnings(gas_planned(dive, {{0, 24.0, 200.0}})).empty());
  // Enough for one diver who has no trouble.
  const Planned little = gas_planned(dive, {{0, 15.0, 200.0}});
  ASSERT_EQ(warnings(little).size(), 1u);
  EXPECT_EQ(warnings(little)[0].kind, PlanWarningKind::kMinimumGas);
  EXPECT_THAT(
      warnings(little)[0].text,
      HasSubstr("tank of air, 15 L at 200 bar: 44 bar left at 18 m, 40 min; minimum gas for "
                "the ascent is 83"));
  const Planned empty = gas_planned(dive, {{0, 10.0, 200.0}});
  ASSERT_EQ(warnings(empty).size(), 1u);
  const PlanWarning w = warnings(empty)[0];
  EXPECT_EQ(w.kind, PlanWarningKind::kTankTooSmall);
  EXPECT_EQ(w.depth_m, 18.0);
  EXPECT_EQ(w.text.find('\n'), w.text.npos);
  // At that moment it is 5 bar over the water's 2.8.
  EXPECT_NEAR(tank_bar(kAir, {0, 10.0, 200.0}, 20.0 * (0.9 * 1.9 + (w.run_min - 0.9) * 2.8)), 7.8,
              1e-6);
  const Planned tiny = gas_planned(dive, {{0, 0.1, 1.0}});
  ASSERT_EQ(warnings(tiny).size(), 1u);
  EXPECT_THAT(warnings(tiny)[0].text,
              HasSubstr("it holds 0.1, of which 0.1 give no full breath there"));
}

TEST(GasPlan, MinimumGasIsOfTheLevelWhereItAndWhatIsUsedAreMost) {
  DivePlanRequest request = easy_dive(40.0, 12.0);
  request.levels.push_back({15.0, 20.0});
  // Up from 40 m at once takes more than from 15 m later; after an hour there it does not.
  EXPECT_EQ(gas_planned(request).use[0].minimum_depth_m, 40.0);
  request.levels[1].leave_min = 80.0;
  EXPECT_EQ(gas_planned(request).use[0].minimum_depth_m, 15.0);
}

// Travel and deco gas, or deco gas at two depths, come out of one tank: each litre once.
TEST(GasPlan, AMixThatIsBreathedTwiceComesOutOfOneTank) {
  DivePlanRequest request = easy_dive(60.0, 25.0, {0.15, 0.55});
  request.gases[0].switch_depth_m = 21.0;
  request.gases.push_back({{0.5, 0.0}, 0.0, GasRole::kTravel});
  request.gases.push_back({{0.5, 0.0}, 21.0, GasRole::kDeco});
  const Planned p = gas_planned(request, {{2, 11.0, 200.0}});
  ASSERT_EQ(p.use.size(), 2u);
  EXPECT_EQ(p.use[1].gas, 1u);
  double litres = 0.0, run_min = 0.0;
  for (const PlanSegment& s : p.plan.segments) {
    if (s.gas != 0) litres += segment_litres(request, p.plan, {}, s, run_min);
    run_min += s.minutes;
  }
  EXPECT_GT(litres, 20.0 * 1.05 * 2.05 + 100.0);  // the way down, and stops
  EXPECT_NEAR(p.use[1].used_l, litres, 1e-9);
  EXPECT_NEAR(p.use[1].tank->end_bar, tank_bar({0.5, 0.0}, {1, 11.0, 200.0}, litres), 1e-9);
  const auto twice = gas_use(request, p.plan, {}, {{1, 11.0, 200.0}, {2, 7.0, 200.0}});
  ASSERT_FALSE(twice.ok());
  EXPECT_THAT(twice.error().message, HasSubstr("found two tanks of EAN50"));
}

// The first level is on the travel gas, the bottom gas begins deeper.
TEST(GasPlan, ALevelOnTheTravelGasHasItsMinimumGas) {
  DivePlanRequest request = easy_dive(20.0, 5.0, {0.15, 0.55});
  request.gases[0].switch_depth_m = 30.0;
  request.gases.push_back({{0.32, 0.0}, 0.0, GasRole::kTravel});
  request.levels.push_back({60.0, 25.0});
  const Planned p = gas_planned(request);
  ASSERT_EQ(p.use.size(), 2u);
  // Down to 30 m, where the bottom gas begins; and two divers up from the first level.
  EXPECT_NEAR(p.use[1].used_l, 20.0 * (1.0 * 2.0 + 4.0 * 3.0 + 0.5 * 3.5), 1e-9);
  EXPECT_NEAR(p.use[1].minimum_l, 80.0 * (4.0 * 3.0 + 2.0 * 2.0), 1e-9);
  EXPECT_EQ(p.use[1].minimum_run_min, 5.0);
  EXPECT_EQ(p.use[0].minimum_run_min, 25.0);
}

TEST(GasPlan, MistakesAreToldInOneLine) {
  const DivePlanRequest request = easy_dive(18.0, 40.0);
  const DivePlan plan = plan_dive(request).value();
  const auto fault = [&](const PlanBreathing& breathing, const std::vector<PlanTank>& tanks) {
    const auto use = gas_use(request, plan, breathing, tanks);
    return use.ok() ? std::string("none") : use.error().message;
  };
  EXPECT_THAT(fault({0.0}, {}), HasSubstr("litres a minute: found 0; accepted: 1 to 200"));
  EXPECT_THAT(fault({20.0, NAN}, {}), HasSubstr("litres a minute of the ascent: found nan"));
  EXPECT_THAT(fault({}, {{1, 12.0, 200.0}}),
              HasSubstr("found tank of gas 1; accepted: the 1 gases"));
  EXPECT_THAT(fault({}, {{0, 12.0, 500.0}}), HasSubstr("a tank's bar: found 500"));
  EXPECT_THAT(fault({}, {{0, 12.0, 200.0}, {0, 7.0, 200.0}}), HasSubstr("found two tanks of air"));
}

}  // namespace
}  // namespace neritic::diver
