// Warnings to a diver about a plan. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "diver/dive_plan.hpp"

namespace neritic::diver {

enum class PlanWarningKind {
  kOxygenHigh,        // pO2 above 1.4 bar at the bottom, 1.6 at deco
  kOxygenLow,         // pO2 below 0.16 bar, or the air's at the surface where that is less
  kDensityAdvised,    // gas above 5.2 g/L
  kDensityMost,       // above 6.2
  kNarcosis,          // narcotic depth above 30 m
  kCns,               // above 80 %, what earlier dives left included
  kCnsBeyondTable,    // pO2 above 1.6 bar, where NOAA's table of CNS ends
  kOtu,               // above 300 in a day
  kCounterdiffusion,  // nitrogen up by more than a fifth of helium's fall at a switch
  kTankTooSmall,      // a tank does not hold what the plan takes: gas_plan.hpp
  kMinimumGas,        // nor what two divers need to go up with
};

struct PlanWarning {
  PlanWarningKind kind = PlanWarningKind::kOxygenHigh;
  double run_min = 0.0, depth_m = 0.0;  // where it is worst
  double value = 0.0, limit = 0.0;
  std::size_t gas = 0;
  std::string text;  // one line
};

// One a kind and gas, the worst of it, in the order in which they begin.
std::vector<PlanWarning> plan_warnings(const DivePlanRequest& request, const DivePlan& plan);

}  // namespace neritic::diver
