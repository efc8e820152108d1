// A dive plan as text for a diver, and as JSON for programs.
#pragma once

#include <string>

#include "diver/gas_plan.hpp"
#include "tools/neritic/plan_trace.hpp"

namespace neritic::tools {

struct PlanReport {
  std::string convention;  // its name
  diver::DivePlanRequest request;
  diver::DivePlan plan;
  std::vector<diver::PlanWarning> warnings;
  double without_stops_min = 0.0;  // largest run time; negative: none
  // The exposure of this dive plus the rest of earlier dives'.
  diver::OxygenExposure oxygen() const {
    return {plan.oxygen.cns_percent + request.oxygen_before.cns_percent,
            plan.oxygen.otu + request.oxygen_before.otu};
  }
  diver::PlanBreathing breathing;
  std::vector<diver::PlanGasUse> gas;  // of each mix of the request
};
Result<PlanReport> make_plan_report(const std::string& convention,
                                    const diver::DivePlanRequest& request,
                                    const diver::PlanBreathing& breathing,
                                    const std::vector<diver::PlanTank>& tanks);

// "ZH-L16B", with the flag that takes the other one.
std::string table_words(diver::BuehlmannTable table);
std::string plan_text(const PlanReport& report);
std::string plan_json(const PlanReport& report);
// The results of a replayed log, with its last tissues.
std::string log_json(const std::string& file, const diver::DepthLog& log, const DiveTrace& trace);

}  // namespace neritic::tools
