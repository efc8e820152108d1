#include "diver/deco_check.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "diver/deco_check_errors.hpp"
#include "diver/deco_ndl.hpp"
#include "engine/core/check.hpp"

namespace neritic::diver {
namespace {

// Tolerances of second opinions: their conventions are close, not equal (integer mbar, REAL*4).
constexpr double kOpinionTissues_bar = 0.005, kOpinionZone_m = 0.2;
// Numbers in files are rounded; these tolerances cover the digits that the files keep.
constexpr double kStop_min = 1e-3, kRunTime_min = 1e-3, kGf = 1e-6, kDepth_m = 1e-5,
                 kPo2_bar = 1e-4;

double tissue_error(const TissueState& a, const TissueState& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < kCompartments; ++i)
    worst = larger(
        worst, larger(std::abs(a.n2_bar[i] - b.n2_bar[i]), std::abs(a.he_bar[i] - b.he_bar[i])));
  return worst;
}

// Minutes by which any depth's stop differs: one that is not there has none.
double stop_error(const std::vector<PlanStop>& found, const std::vector<ExpectedStop>& expected) {
  std::map<long long, double> off;  // by mm
  for (const PlanStop& stop : found) off[std::llround(1e3 * stop.depth_m)] += stop.minutes;
  for (const ExpectedStop& stop : expected) off[std::llround(1e3 * stop.depth_m)] -= stop.minutes;
  double worst = 0.0;
  for (const auto& [depth, minutes] : off) worst = larger(worst, std::abs(minutes));
  return worst;
}

// Tissues that are not those of the surface's air.
bool has_dived(const DecoConventions& conventions, const std::optional<TissueState>& start) {
  constexpr double kFresh_bar = 1e-3;
  return start &&
         tissue_error(*start, saturated(conventions.model(), conventions.environment.surface_bar,
                                        conventions.start_n2)) > kFresh_bar;
}

class DiveCheck {
 public:
  DiveCheck(const DecoCase& one, const DecoCases& tolerances)
      : one_(one), tolerances_(tolerances), errors_(one.id) {}

  CaseResult run() {
    DivePlanRequest request = one_.request;
    if (!check_earlier(request)) return errors_.take();
    const auto plan = plan_dive(request);
    if (!plan.ok()) {
      errors_.add_failure("plan: " + plan.error().message);
      return errors_.take();
    }
    check_points(request, *plan);
    check_stops(request, *plan);
    check_times(request, *plan);
    check_replay(*plan);
    check_ndl(request);
    for (const SecondOpinion& opinion : one_.expected.opinions) check_opinion(opinion);
    return errors_.take();
  }

 private:
  void tissues(const std::string& what, const TissueState& found,
               const std::optional<TissueState>& expected) {
    if (expected) errors_.add(what, "bar", tissue_error(found, *expected), tolerances_.tissues_bar);
  }

  // The dive before; it gives the start where the file does not.
  bool check_earlier(DivePlanRequest& request) {
    if (!one_.earlier) return true;
    const EarlierCase& one = *one_.earlier;
    std::vector<DivePlan> plans;
    const auto after = tissues_after({one.earlier}, &plans);
    if (!after.ok()) {
      errors_.add_failure("earlier dive: " + after.error().message);
      return false;
    }
    if (one.stops)
      errors_.add("earlier stops", "min", stop_error(plans[0].stops, *one.stops), kStop_min);
    errors_.add("earlier run time", "min", plans[0].run_min(), one.run_min, kRunTime_min);
    tissues("tissues at earlier surfacing", plans[0].surfacing.tissues, one.surfacing);
    tissues("tissues after the interval", *after, one.after_interval);
    tissues("initial tissues", *after, request.start);
    if (!request.start) request.start = *after;
    return true;
  }

  void check_ceilings(const DivePlanRequest& request, const TissueState& tissues, double gf,
                      const std::vector<double>& expected) {
    const Buehlmann model = request.conventions.model();
    for (std::size_t i = 0; i < expected.size(); ++i)
      errors_.add("ceilings", "bar", tolerated_bar(model, tissues, i, gf) - expected[i],
                  tolerances_.tissues_bar);
  }

  void check_point(const DivePlanRequest& request, const std::string& name, const PlanPoint& found,
                   const ExpectedPoint& expected) {
    const DecoEnvironment& where = request.conventions.environment;
    const Buehlmann model = request.conventions.model();
    errors_.add("run time", "min", found.run_min, expected.run_min, kRunTime_min);
    errors_.add("depth", "m", found.depth_m, expected.depth_m, kDepth_m);
    errors_.add("pressure", "bar", where.pressure_bar(found.depth_m), expected.pressure_bar,
                tolerances_.tissues_bar);
    tissues("tissues at " + name, found.tissues, expected.tissues);
    check_ceilings(request, found.tissues, request.gf_low, expected.low_bar);
    check_ceilings(request, found.tissues, request.gf_high, expected.high_bar);
    check_ceilings(request, found.tissues, 1.0, expected.full_bar);
    const Ceiling low = ceiling(model, found.tissues, request.gf_low);
    const Ceiling high = ceiling(model, found.tissues, request.gf_high);
    const double bar = tolerances_.tissues_bar;
    errors_.add("ceilings", "bar", low.pressure_bar, expected.leading_bar, bar);
    errors_.add("ceilings", "bar", high.pressure_bar, expected.deepest_high_bar, bar);
    errors_.add("leading compartment", "", static_cast<double>(low.compartment + 1),
                expected.leading_low, 0.5);
    const auto depth = [&](const Ceiling& c) {
      return std::max(where.depth_m(c.pressure_bar), 0.0);
    };
    errors_.add("ceiling depths", "m", depth(low), expected.low_m, bar / where.bar_per_m);
    errors_.add("ceiling depths", "m", depth(high), expected.high_m, bar / where.bar_per_m);
  }

  void check_points(const DivePlanRequest& request, const DivePlan& plan) {
    const DecoExpected& e = one_.expected;
    if (e.end_of_bottom)
      check_point(request, "the end of the bottom", plan.end_of_bottom, *e.end_of_bottom);
    if (e.first_stop && plan.first_stop)
      check_point(request, "the first stop", *plan.first_stop, *e.first_stop);
    if (e.first_stop && !plan.first_stop) errors_.add_failure("no first stop");
    if (e.surfacing) check_point(request, "surfacing", plan.surfacing, *e.surfacing);
  }

  void check_stops(const DivePlanRequest& request, const DivePlan& plan) {
    const DecoExpected& e = one_.expected;
    if (e.no_stops) errors_.add("no stops", "", plan.no_stops ? 1.0 : 0.0, e.no_stops, 0.5);
    if (!e.stops) return;
    errors_.add("stops", "min", stop_error(plan.stops, *e.stops), kStop_min);
    for (std::size_t i = 0; i < std::min(plan.stops.size(), e.stops->size()); ++i) {
      const PlanStop& found = plan.stops[i];
      const ExpectedStop& expected = (*e.stops)[i];
      errors_.add("stops' depths", "m", found.depth_m - expected.depth_m, kDepth_m);
      errors_.add("stops' gradient factors", "", found.gf_next, expected.gf_next, kGf);
      if (!expected.mix) continue;
      const GasMix& mix = request.gases[found.gas].mix;
      errors_.add("stops' gases", "%",
                  100.0 * std::max(std::abs(mix.oxygen - expected.mix->oxygen),
                                   std::abs(mix.helium - expected.mix->helium)),
                  1e-6);
    }
  }

  void check_times(const DivePlanRequest&, const DivePlan& plan) {
    const DecoExpected& e = one_.expected;
    errors_.add("stops", "min", plan.stop_min(), e.stop_min, kStop_min);
    errors_.add("run time", "min", plan.ascent_min(), e.ascent_min, kRunTime_min);
    errors_.add("run time", "min", plan.run_min(), e.run_min, kRunTime_min);
    // Files sum over steps of 1 s, here it is in closed form; they differ most where the limit is
    // shortest, above 1.6 bar.
    if (e.cns_percent)
      errors_.add("CNS", "%", plan.oxygen.cns_percent, e.cns_percent,
                  0.01 + (plan.max_po2_bar > 1.6 ? 0.01 : 0.0005) * *e.cns_percent);
    if (e.otu) errors_.add("OTU", "", plan.oxygen.otu, e.otu, 0.005 + 0.0005 * *e.otu);
    // Files, in steps of 1 s, miss the pressure at a gas change by up to half a step.
    const DecoConventions& c = one_.request.conventions;
    const double half_step_bar =
        0.5 / 60.0 * c.environment.bar_per_m * std::max(c.ascent_m_min, c.descent_m_min);
    errors_.add("pO2", "bar", plan.max_po2_bar, e.max_po2_bar, kPo2_bar + half_step_bar);
  }

  // The file's own rows, one after the other.
  void check_replay(const DivePlan& plan) {
    if (one_.segments.empty()) return;
    const DecoConventions& c = one_.request.conventions;
    const Buehlmann model = c.model();
    TissueState now = plan.start.tissues;
    double run_min = 0.0;
    const auto compare_at = [&](const std::optional<ExpectedPoint>& point) {
      if (point && point->run_min && std::abs(run_min - *point->run_min) < kRunTime_min)
        tissues("tissues replayed", now, point->tissues);
    };
    for (const ReplayedSegment& s : one_.segments) {
      now = load(model, now, c.environment.pressure_bar(s.from_m),
                 c.environment.pressure_bar(s.to_m), s.minutes, s.mix);
      run_min += s.minutes;
      compare_at(one_.expected.end_of_bottom);
      compare_at(one_.expected.first_stop);
    }
    if (one_.expected.surfacing) tissues("tissues replayed", now, one_.expected.surfacing->tissues);
    errors_.add("run time", "min", run_min - plan.run_min(), kRunTime_min);
  }

  void check_ndl(const DivePlanRequest& request) {
    const ExpectedNdl& e = one_.expected.ndl;
    if (!e.given) return;
    const auto found = run_time_without_stops(request);
    if (!found.ok()) return errors_.add_failure("time without stops: " + found.error().message);
    const bool any = found->has_value();
    if (any != e.continuous_min.has_value())
      return errors_.add_failure(any ? "time without stops where none is expected"
                                     : "no time without stops");
    if (any)
      errors_.add("time without stops", "min", **found, e.continuous_min, tolerances_.ndl_min);
    if (any && e.whole_min)
      errors_.add("time without stops, whole", "min", std::floor(**found), e.whole_min, 0.5);
  }

  // The case under the program's conventions.
  void check_opinion(const SecondOpinion& opinion) {
    const auto named = conventions_of(opinion.set);
    NERITIC_CHECK(named.ok(), "conventions {}", opinion.set);
    DivePlanRequest request = one_.request;
    const auto adopt = [&](DivePlanRequest& r) {
      const DecoConventions own = r.conventions;
      r.conventions = *named;
      if (opinion.set != "msw") r.conventions.environment = own.environment;
      r.conventions.descent_m_min = own.descent_m_min;
      r.conventions.ascent_m_min = own.ascent_m_min;
      r.conventions.last_stop_m = own.last_stop_m;
      r.last_stop_always = true;
      // Without a dive before, each program starts saturated by its own air.
      if (!has_dived(own, r.start)) r.start.reset();
    };
    adopt(request);
    if (one_.earlier) {
      EarlierDive dive = one_.earlier->earlier;
      adopt(dive.dive);
      if (const auto start = tissues_after({dive}); start.ok()) request.start = *start;
    }
    const auto plan = plan_dive(request);
    const std::string beside = " beside " + opinion.program, what = "stop time" + beside;
    if (!plan.ok()) return errors_.add_failure(what + ": " + plan.error().message);
    errors_.add(what, "min", plan->stop_min(), opinion.stop_min, opinion.band_min);
    if (opinion.stops_and_ways_min && plan->first_stop && !plan->stops.empty())
      errors_.add(what, "min", plan->stops.back().leave_min - plan->first_stop->run_min,
                  opinion.stops_and_ways_min, opinion.band_min);
    if (opinion.leave_last_min && !plan->stops.empty())
      errors_.add(what, "min", plan->stops.back().leave_min, opinion.leave_last_min,
                  opinion.band_min);
    errors_.add("run time" + beside, "min", plan->run_min(), opinion.run_min, opinion.band_min);
    // Tissues that the case gives come of its own air, which the slow ones remember.
    const DecoConventions& own = one_.request.conventions;
    const double air_bar =
        !one_.earlier && request.start
            ? std::abs(own.start_n2 - request.conventions.start_n2) * own.environment.surface_bar
            : 0.0;
    if (opinion.tissues)
      errors_.add("tissues" + beside, "bar",
                  tissue_error(plan->end_of_bottom.tissues, *opinion.tissues),
                  kOpinionTissues_bar + air_bar);
    errors_.add("deco zone" + beside, "m", zone_m(request, *plan), opinion.zone_m, kOpinionZone_m);
    if (opinion.cns_percent)
      errors_.add("CNS" + beside, "%", plan->oxygen.cns_percent, opinion.cns_percent,
                  1.0 + 0.15 * *opinion.cns_percent);
    if (opinion.otu)
      errors_.add("OTU" + beside, "", plan->oxygen.otu, opinion.otu, 0.5 + 0.05 * *opinion.otu);
  }

  // Where the first compartment holds as much inert gas as presses on it, on the direct way up.
  static double zone_m(const DivePlanRequest& request, const DivePlan& plan) {
    const DecoConventions& c = request.conventions;
    const DecoEnvironment& where = c.environment;
    const PlanPoint& bottom = plan.end_of_bottom;
    std::size_t gas = 0;
    for (const PlanSegment& s : plan.segments)
      if (s.phase == PlanPhase::kBottom || s.phase == PlanPhase::kDescent) gas = s.gas;
    const GasMix& mix = request.gases[gas].mix;
    const auto above = [&](double depth_m) {
      const TissueState up =
          load(c.model(), bottom.tissues, where.pressure_bar(bottom.depth_m),
               where.pressure_bar(depth_m), (bottom.depth_m - depth_m) / c.ascent_m_min, mix);
      double most = 0.0;
      for (std::size_t i = 0; i < kCompartments; ++i)
        most = larger(most, up.n2_bar[i] + up.he_bar[i]);
      return most > where.pressure_bar(depth_m);
    };
    double shallow = 0.0, deep = bottom.depth_m;
    if (!above(shallow)) return 0.0;
    while (deep - shallow > 1e-6) {
      const double middle = 0.5 * (shallow + deep);
      (above(middle) ? shallow : deep) = middle;
    }
    return deep;
  }

  const DecoCase& one_;
  const DecoCases& tolerances_;
  DecoErrors errors_;
};

}  // namespace

CaseResult check_dive(const DecoCase& one, const DecoCases& tolerances) {
  return DiveCheck(one, tolerances).run();
}

CaseResult check_table(const NdlTable& table, const DecoCases& tolerances) {
  DecoErrors errors(table.id);
  const DecoConventions& c = table.request.conventions;
  const GasMix& mix = table.request.gases[0].mix;
  for (const NdlRow& row : table.rows) {
    DivePlanRequest request = table.request;
    request.levels[0].depth_m = row.depth_m;
    const auto found = run_time_without_stops(request);
    if (!found.ok() || (row.run_min && !found->has_value())) {
      errors.add_failure("no time without stops");
      continue;
    }
    if (found->has_value()) {
      errors.add("run time", "min", **found, row.run_min, tolerances.ndl_min);
      if (row.whole_min)
        errors.add("whole run time", "min", std::floor(**found), row.whole_min, 0.5);
    }
    const bool limited = found->has_value() && **found < kNoLimit_min;
    if (row.no_run_limit) errors.add("no limit", "", limited ? 1.0 : 0.0, 0.5);
    const ClosedNdl closed =
        closed_form_ndl(c.model(), c.environment, c.start_n2, row.depth_m, mix, request.gf_high);
    if (row.no_closed_limit)
      errors.add("no limit", "", closed.minutes < kNoLimit_min ? 1.0 : 0.0, 0.5);
    errors.add("closed form", "min", closed.minutes, row.closed_min, tolerances.ndl_min);
    errors.add("controlling compartment", "", static_cast<double>(closed.compartment + 1),
               row.compartment, 0.5);
  }
  return errors.take();
}

std::vector<CaseResult> check_deco(const DecoCases& cases) {
  std::vector<CaseResult> results;
  for (const DecoCase& one : cases.dives) results.push_back(check_dive(one, cases));
  for (const NdlTable& table : cases.tables) results.push_back(check_table(table, cases));
  return results;
}

}  // namespace neritic::diver
