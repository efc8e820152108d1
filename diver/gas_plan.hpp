// How much a dive plan takes of each gas, what must be left of it to bring two divers up, and what
// that is in tanks. Pure functions over plain values; any thread. Litres are of gas at 1 bar and
// the tanks' temperature: a litre breathed at 3 bar is 3 of them; tanks hold them as real gas does
// (real_gas.hpp).
#pragma once

#include <optional>

#include "diver/plan_warnings.hpp"

namespace neritic::diver {

// Litres of ambient pressure that a diver breathes a minute (RMV, also called SAC): on the way down
// and along the levels, and from the end of the last one on; the defaults are the planner's of
// Subsurface 5. Minimum gas ("rock bottom") as S. Fuchs and R. Walsh put it (Subsurface, January
// 2017): `divers` divers breathe `stress` times bottom_l_min, for problem_min at depth and then all
// the way up to the next gas.
struct PlanBreathing {
  double bottom_l_min = 20.0, ascent_l_min = 17.0;
  double divers = 2.0, stress = 2.0, problem_min = 4.0;

  double emergency_l_min() const { return divers * stress * bottom_l_min; }
};

// All that is carried of a mix: twins are one tank of their sum, and what is breathed to travel and
// on the way up again comes out of the same one.
struct PlanTank {
  std::size_t gas = 0;  // of the request: any of this mix
  double volume_l = 0.0, pressure_bar = 0.0;
};

// Use of one tank over the plan.
struct PlanTankUse {
  PlanTank tank;
  double end_bar = 0.0;      // when the plan is done; 0: it does not last
  double minimum_bar = 0.0;  // that the minimum gas is, over what no regulator gives
  double then_bar = 0.0;     // that are there at that moment
  // The moment from which it gives no full breath; absent: it lasts.
  std::optional<double> empty_min, empty_m;
};

// Use of one mix over the plan, whatever its role.
struct PlanGasUse {
  std::size_t gas = 0;  // the first of this mix of the request
  double used_l = 0.0;  // by one diver
  // To go up with from the end of the level where it and what was used before are most; 0 for gases
  // that no level ends on.
  double minimum_l = 0.0, minimum_run_min = 0.0, minimum_depth_m = 0.0;
  double used_before_l = 0.0;  // until then
  std::optional<PlanTankUse> tank;
};

// One a mix of the request, in its order. Errors: breathing or tanks out of bounds, a mix with two
// tanks; what plan_dive says of an ascent from a level before the last.
Result<std::vector<PlanGasUse>> gas_use(const DivePlanRequest& request, const DivePlan& plan,
                                        const PlanBreathing& breathing,
                                        const std::vector<PlanTank>& tanks);

// Litres that one diver breathes during a segment that begins at a run time.
double segment_litres(const DivePlanRequest& request, const DivePlan& plan,
                      const PlanBreathing& breathing, const PlanSegment& segment, double from_min);

// The pressure left in a tank after used_l litres, bar; 0: empty.
double tank_bar(const GasMix& mix, const PlanTank& tank, double used_l);

// Tanks that do not hold what the plan, or minimum gas, takes: one line a tank.
std::vector<PlanWarning> gas_warnings(const DivePlanRequest& request,
                                      const std::vector<PlanGasUse>& use);

}  // namespace neritic::diver
