// Plans a dive: the way down and along its levels, then stops up to the surface, by
// DecoConventions. Pure functions over plain values; any thread. Depths in m, times in min,
// pressures in bar.
#pragma once

#include <optional>
#include <vector>

#include "diver/deco_conventions.hpp"
#include "diver/deco_tissues.hpp"
#include "diver/oxygen_exposure.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

enum class GasRole { kTravel, kBottom, kDeco };

// A gas that the diver carries. switch_depth_m: travel and bottom gas are breathed from there on
// the way down (the first of them from the surface; the bottom gas at the deepest level), deco gas
// from there on the way up.
struct PlanGas {
  GasMix mix;
  double switch_depth_m = 0.0;
  GasRole role = GasRole::kBottom;
};

// A depth, and the run time at which it is left: the way to it counts.
struct PlanLevel {
  double depth_m = 0.0, leave_min = 0.0;
};

struct DivePlanRequest {
  DecoConventions conventions;
  double gf_low = 0.3, gf_high = 0.85;
  std::vector<PlanGas> gases = std::vector<PlanGas>(1);  // air
  std::vector<PlanLevel> levels;
  std::optional<TissueState> start;  // absent: one who has not dived
  // A last stop deeper than the step holds also where the first stop would be shallower. Off: such
  // a dive stops at the step, as one program does by mistake.
  bool last_stop_always = true;
  // The CNS that remains of earlier dives, and the day's OTU. A plan has its own dive's alone;
  // warnings and computers count both.
  OxygenExposure oxygen_before;
};

enum class PlanPhase { kDescent, kBottom, kAscent, kStop };

struct PlanSegment {
  double from_m = 0.0, to_m = 0.0, minutes = 0.0;
  std::size_t gas = 0;  // of the request
  PlanPhase phase = PlanPhase::kBottom;
};

struct PlanStop {
  double depth_m = 0.0, minutes = 0.0;
  double gf_next = 0.0;    // under which the next depth was tried
  double leave_min = 0.0;  // run time
  std::size_t gas = 0;
};

// Where the diver was at a moment of the plan.
struct PlanPoint {
  double run_min = 0.0, depth_m = 0.0;
  TissueState tissues;
};

// A level above the ceiling of GF low that holds when it is reached, where a direct ascent would
// not do: the stops below it have been left out.
struct LevelAboveCeiling {
  std::size_t level = 0;
  double least_m = 0.0;  // the shallowest on the way there that is tolerated
};

struct DivePlan {
  std::vector<PlanSegment> segments;
  std::vector<PlanStop> stops;
  PlanPoint start, end_of_bottom, surfacing;
  std::optional<PlanPoint> first_stop;  // at arrival
  OxygenExposure oxygen;
  double max_po2_bar = 0.0;
  bool no_stops = false;                           // a direct ascent was within GF high
  std::optional<LevelAboveCeiling> above_ceiling;  // the first level that is

  double stop_min() const;
  double run_min() const { return surfacing.run_min; }
  // From the end of the last level.
  double ascent_min() const { return surfacing.run_min - end_of_bottom.run_min; }
};

// The error of a request, if any; a level that is to be left before it is reached included, and a
// travel gas that is breathed where the bottom gas should be.
Status check_request(const DivePlanRequest& request);
// Errors as check_request's, or the depth at which a ceiling never clears. Levels are dived as they
// are asked for, also above a ceiling: DivePlan::above_ceiling.
Result<DivePlan> plan_dive(const DivePlanRequest& request);
// The ascent of a diver who leaves for the surface after the first `levels` levels.
Result<DivePlan> plan_dive(const DivePlanRequest& request, std::size_t levels);
// Refuses a plan with a level above its ceiling.
Status check_ceilings(const DivePlanRequest& request, const DivePlan& plan);
// The end of the last level, without an ascent.
Result<PlanPoint> end_of_levels(const DivePlanRequest& request);

// A dive before, and the time at the surface after it, breathing this there.
struct EarlierDive {
  DivePlanRequest dive;  // its start is that which the dives before it leave
  double surface_min = 0.0;
  GasMix surface_gas = kAir;
};
// Tissues after the dives, oldest first. plans: if not null, each dive's plan is put there.
Result<TissueState> tissues_after(const std::vector<EarlierDive>& dives,
                                  std::vector<DivePlan>* plans = nullptr);
// The oxygen exposure that remains of dives planned this way: CNS declines at the surface
// (cns_after) while it is not gained there; OTU is that of the last 24 hours. As large as the
// dives.
OxygenExposure oxygen_after(const std::vector<EarlierDive>& dives,
                            const std::vector<DivePlan>& plans);

}  // namespace neritic::diver
