#include "tools/neritic/plan_trace.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "diver/gas_label.hpp"
#include "engine/core/check.hpp"

namespace neritic::tools {
namespace {

using diver::DiveComputer;
using diver::DiveComputerState;

constexpr std::size_t kMostViews = 20000;

void add_row(DiveTrace& trace, const DiveComputer& computer, const DiveComputerState& state,
             double run_min, bool failed = false) {
  trace.rows.push_back({run_min, state.last.depth_m, state.oxygen.cns_percent, state.oxygen.otu,
                        static_cast<std::size_t>(state.last.gas), computer.view(state), failed});
  const diver::DiveComputerView& view = trace.rows.back().view;
  trace.most_ceiling_m = std::max(trace.most_ceiling_m, view.ceiling_m);
  if (trace.rows.size() < 2) return;
  const double minutes = run_min - trace.rows[trace.rows.size() - 2].run_min;
  if (view.ceiling_violated) trace.above_ceiling_min += minutes;
  if (view.alarm != diver::AscentAlarm::kNone) trace.fast_min += minutes;
}

}  // namespace

DiveTrace trace_plan(const diver::DivePlanRequest& request, const diver::DivePlan& plan) {
  diver::DiveComputerSettings settings{
      request.conventions, request.gf_low, request.gf_high, request.gases, {}};
  // A planned ascent at the planned rate is not too fast.
  settings.ascent.fast_m_min =
      std::max(settings.ascent.fast_m_min, 1.05 * request.conventions.ascent_m_min);
  settings.ascent.dangerous_m_min =
      std::max(settings.ascent.dangerous_m_min, 2.0 * request.conventions.ascent_m_min);
  const auto computer = DiveComputer::create(settings);
  NERITIC_CHECK(computer.ok(), "planned, but refused: {}", computer.error().message);
  DiveTrace trace;
  DiveComputerState state = computer->start(plan.start.tissues);
  state.oxygen = request.oxygen_before;
  double run_min = 0.0;
  state.last.gas = plan.segments.empty() ? 0 : plan.segments[0].gas;
  add_row(trace, *computer, state, run_min);
  for (const diver::PlanSegment& s : plan.segments) {
    // The switch takes no time.
    state = computer->step(state, {s.from_m, s.gas}, 0.0);
    const int parts = std::max(static_cast<int>(std::ceil(60.0 * s.minutes / kTraceRow_s)), 1);
    for (int i = 1; i <= parts; ++i) {
      const double depth = s.from_m + (s.to_m - s.from_m) * i / parts;
      state = computer->step(state, {depth, s.gas}, 60.0 * s.minutes / parts);
      add_row(trace, *computer, state, run_min + s.minutes * i / parts);
    }
    run_min += s.minutes;
  }
  const auto moment = [&](const char* name, const diver::PlanPoint& point) {
    trace.moments.push_back({name, point.run_min, point.depth_m, point.tissues});
  };
  moment("end of the bottom", plan.end_of_bottom);
  if (plan.first_stop) moment("first stop", *plan.first_stop);
  moment("surfacing", plan.surfacing);
  trace.end = state;
  return trace;
}

DiveTrace trace_log(const DiveComputer& computer, const diver::DiveComputerState& start,
                    const diver::DepthLog& log) {
  DiveTrace trace;
  DiveComputerState state = start;
  const double first_s = log.samples.front().time_s;
  double time_s = first_s, deepest_m = -1.0;
  const std::size_t every = log.samples.size() / kMostViews + 1;
  TraceMoment deepest;
  for (std::size_t i = 0; i < log.samples.size(); ++i) {
    const diver::DepthSample& sample = log.samples[i];
    state = computer.step(state, {sample.depth_m, sample.gas}, sample.time_s - time_s);
    time_s = sample.time_s;
    const double run_min = (time_s - first_s) / 60.0;
    if (i % every == 0 || i + 1 == log.samples.size())
      add_row(trace, computer, state, run_min, sample.failed);
    if (state.last.depth_m >= deepest_m) {
      deepest_m = state.last.depth_m;
      deepest = {"last at the deepest", run_min, deepest_m, state.tissues};
    }
  }
  trace.moments.push_back(deepest);
  trace.moments.push_back(
      {"end of the log", (time_s - first_s) / 60.0, state.last.depth_m, state.tissues});
  trace.end = state;
  return trace;
}

std::string trace_csv(const DiveTrace& trace, const std::vector<diver::PlanGas>& gases) {
  std::string out =
      "time_s,depth_m,gas,ceiling_m,no_stop_min,stop_m,stop_min,to_surface_min,po2_bar,density_g_l,"
      "narcotic_m,gradient,surface_gradient,ascent_m_min,alarm,ceiling_violated,cns_percent,otu,"
      "depth_refused\n";
  // No limit, or never, is an empty cell, as in a dive's log.
  const auto known = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string();
  };
  for (const TraceRow& row : trace.rows) {
    const diver::DiveComputerView& v = row.view;
    fmt::format_to(std::back_inserter(out),
                   "{:.9g},{:.6g},{},{:.4g},{},{:g},{:.6g},{},{:.5g},{:.4g},{:.4g},{:.5g},"
                   "{:.5g},{:.4g},{},{},{:.5g},{:.5g},{}\n",
                   60.0 * row.run_min, row.depth_m, diver::name_of(gases[row.gas].mix), v.ceiling_m,
                   known(v.no_stop_min), v.stop_m, v.stop_min, known(v.to_surface_min), v.po2_bar,
                   v.density_g_l, v.narcotic_m, v.gradient, v.surface_gradient,
                   v.ascent_m_min + 0.0,  // no -0
                   static_cast<int>(v.alarm), v.ceiling_violated ? 1 : 0, row.cns_percent, row.otu,
                   row.failed ? 1 : 0);
  }
  return out;
}

}  // namespace neritic::tools
