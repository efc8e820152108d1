// The data of the picture of a planned or replayed dive: depth and ceiling over time, gases and
// stops, and the tissues at moments that matter. diver/OUTPUT.md has every key. Pure; any thread.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/neritic/plan_gas_curves.hpp"
#include "tools/neritic/plan_trace.hpp"

namespace neritic::tools {

struct PlanPicture {
  std::string title;
  std::vector<std::string> facts, warnings;  // a line each
  diver::DecoConventions conventions;
  double gf_high = 0.85;
  std::vector<diver::PlanGas> gases;
  std::vector<diver::PlanStop> stops;  // empty for a log
  std::vector<GasCurve> gas;           // empty for a log
};
nlohmann::json plan_picture_data(const PlanPicture& picture, const DiveTrace& trace);

}  // namespace neritic::tools
