#include "tools/neritic/plan_gas_curves.hpp"

#include <algorithm>

#include "diver/gas_label.hpp"

namespace neritic::tools {
namespace {

using diver::PlanSegment;

// A segment until a run time, where that is within it.
PlanSegment cut_at(const PlanSegment& s, double from_min, double until_min) {
  PlanSegment part = s;
  part.minutes = std::min(s.minutes, until_min - from_min);
  if (part.minutes < s.minutes)
    part.to_m = s.from_m + (s.to_m - s.from_m) * part.minutes / s.minutes;
  return part;
}

}  // namespace

std::vector<GasCurve> gas_curves(const PlanReport& report) {
  std::vector<GasCurve> out;
  const double end_min = report.plan.run_min();
  for (const diver::PlanGasUse& use : report.gas) {
    const diver::GasMix& mix = report.request.gases[use.gas].mix;
    GasCurve curve{diver::name_of(mix), use.gas, use.tank.has_value()};
    curve.used_up = use.tank && use.tank->empty_min;
    const double until_min = curve.used_up ? *use.tank->empty_min : end_min;
    double run_min = 0.0, used_l = 0.0;
    const auto add = [&](double minutes) {
      curve.run_min.push_back(minutes);
      curve.value.push_back(use.tank ? diver::tank_bar(mix, use.tank->tank, used_l) : used_l);
    };
    add(0.0);
    for (const PlanSegment& whole : report.plan.segments) {
      if (run_min >= until_min) break;
      const PlanSegment s = cut_at(whole, run_min, until_min);
      const double litres =
          diver::segment_litres(report.request, report.plan, report.breathing, s, run_min);
      run_min += s.minutes;
      if (report.request.gases[s.gas].mix == mix) used_l += litres;
      add(run_min);
    }
    if (use.tank && use.minimum_l > 0.0) {
      curve.minimum_run_min = use.minimum_run_min;
      curve.minimum = use.tank->minimum_bar;
      curve.then = use.tank->then_bar;
    }
    out.push_back(std::move(curve));
  }
  return out;
}

}  // namespace neritic::tools
