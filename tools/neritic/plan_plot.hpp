// A dive as a picture: depth and ceiling over time, gases and stops, and the tissues at moments
// that matter.
#pragma once

#include "engine/core/image.hpp"
#include "tools/neritic/plan_gas_curves.hpp"
#include "tools/neritic/plan_trace.hpp"

namespace neritic::tools {

struct PlanPicture {
  std::string title, below, where;    // three lines of words
  std::vector<std::string> warnings;  // a line each
  diver::DecoConventions conventions;
  double gf_low = 0.3, gf_high = 0.85;
  std::vector<diver::PlanGas> gases;
  std::vector<diver::PlanStop> stops;  // named beside the line; none of a log
  std::vector<GasCurve> gas;           // below it; none of a log
};
ImageU8 draw_dive(const PlanPicture& picture, const DiveTrace& trace);

}  // namespace neritic::tools
