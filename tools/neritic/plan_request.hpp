// Turns the flags of `neritic plan` into requests of the planner and settings of the dive
// computer.
#pragma once

#include "diver/deco_live.hpp"
#include "diver/depth_log.hpp"
#include "diver/dive_plan.hpp"
#include "diver/gas_plan.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

// Conventions, gradient factors, gases, levels, and tissues after earlier dives.
Result<diver::DivePlanRequest> plan_request(const PlanFlags& flags);

struct PlanGasFlags {
  diver::PlanBreathing breathing;
  std::vector<diver::PlanTank> tanks;
};
// How the request's gases are breathed and carried.
Result<PlanGasFlags> plan_gas(const PlanFlags& flags, const diver::DivePlanRequest& request);

// For a log: its gases first, the flags' after them; samples' gases are numbers of these. A flag
// decides a logged gas's switch depth, and whether it is the bottom gas.
Result<diver::DiveComputerSettings> log_settings(const PlanFlags& flags,
                                                 const diver::DepthLog& log);
// At the start of a log: never dived, or after earlier dives.
Result<diver::DiveComputerState> log_start(const PlanFlags& flags,
                                           const diver::DiveComputer& computer);

}  // namespace neritic::tools
