// A dive as a picture: depth and ceiling over time, gases and stops, and the tissues at moments
// that matter.
#pragma once

#include "engine/core/image.hpp"
#include "tools/neritic/plan_trace.hpp"

namespace neritic::tools {

struct PlanPicture {
  std::string title, below;  // two lines of words
  diver::DecoConventions conventions;
  double gf_low = 0.3, gf_high = 0.85;
  std::vector<diver::PlanGas> gases;
  std::vector<diver::PlanStop> stops;  // named beside the line; none of a log
};
ImageU8 draw_dive(const PlanPicture& picture, const DiveTrace& trace);

}  // namespace neritic::tools
