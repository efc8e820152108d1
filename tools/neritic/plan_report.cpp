#include "tools/neritic/plan_report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "diver/deco_ndl.hpp"
#include "diver/gas_label.hpp"
#include "engine/core/json.hpp"

namespace neritic::tools {
namespace {

using diver::DivePlan;
using diver::DivePlanRequest;
using diver::PlanPhase;
using diver::PlanSegment;

// "26", "26.5", "26:18" would all do; minutes and seconds are what a watch shows.
std::string clock_text(double minutes) {
  const auto seconds = static_cast<long long>(std::llround(60.0 * minutes));
  return fmt::format("{}:{:02}", seconds / 60, seconds % 60);
}

const char* phase_name(PlanPhase phase) {
  switch (phase) {
    case PlanPhase::kDescent:
      return "descent";
    case PlanPhase::kBottom:
      return "bottom";
    case PlanPhase::kAscent:
      return "ascent";
    case PlanPhase::kStop:
      return "stop";
  }
  return "";
}

struct PlanLine : PlanSegment {
  double litres = 0.0;
};
// Segments of one kind on one gas are one line.
std::vector<PlanLine> merged(const PlanReport& r) {
  std::vector<PlanLine> out;
  double run_min = 0.0;
  for (const PlanSegment& s : r.plan.segments) {
    const double litres = diver::segment_litres(r.request, r.plan, r.breathing, s, run_min);
    run_min += s.minutes;
    const bool same = !out.empty() && out.back().phase == s.phase && out.back().gas == s.gas &&
                      s.phase != PlanPhase::kStop;
    if (same && (s.phase != PlanPhase::kBottom || out.back().to_m == s.to_m)) {
      out.back().to_m = s.to_m;
      out.back().minutes += s.minutes;
      out.back().litres += litres;
    } else {
      out.push_back({s, litres});
    }
  }
  return out;
}

std::string gases_text(const DivePlanRequest& request) {
  std::string out;
  for (const diver::PlanGas& gas : request.gases) {
    out += (out.empty() ? "" : ", ") + diver::name_of(gas.mix);
    if (gas.role == diver::GasRole::kDeco) out += fmt::format(" from {:g} m", gas.switch_depth_m);
    if (gas.role == diver::GasRole::kTravel) out += " to travel";
  }
  return out;
}

std::string head_text(const PlanReport& r) {
  std::string levels;
  for (const diver::PlanLevel& level : r.request.levels)
    levels += fmt::format("{}{:g} m until {:g} min", levels.empty() ? "" : ", then ", level.depth_m,
                          level.leave_min);
  const diver::DecoConventions& c = r.request.conventions;
  std::string out =
      fmt::format("{}: {} on {}\n", table_words(c.table), levels, gases_text(r.request));
  out += fmt::format(
      "GF {:g}/{:g}, {}; surface {:.4f} bar, {:.1f} kg/m3; down {:g}, up {:g} m/min\n",
      100.0 * r.request.gf_low, 100.0 * r.request.gf_high, r.convention, c.environment.surface_bar,
      c.environment.bar_per_m * 1e5 / diver::kStandardGravity_m_s2, c.descent_m_min,
      c.ascent_m_min);
  return out;
}

// The table that goes onto a slate. Ascents between stops are in run time and litres of the stop
// after them.
std::string table_text(const PlanReport& r) {
  std::string out = "\n           depth    time     run  gas       pO2   g/L   END  litres\n";
  double run_min = 0.0, between_l = 0.0;
  const diver::DecoEnvironment& where = r.request.conventions.environment;
  const std::vector<PlanLine> segments = merged(r);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const PlanLine& s = segments[i];
    run_min += s.minutes;
    const auto is_stop = [&](std::size_t at) {
      return at < segments.size() && segments[at].phase == PlanPhase::kStop;
    };
    if (s.phase == PlanPhase::kAscent && i > 0 && is_stop(i - 1) && is_stop(i + 1)) {
      between_l += s.litres;
      continue;
    }
    const diver::GasMix& mix = r.request.gases[s.gas].mix;
    // Where it is deepest, that counts.
    const double depth = std::max(s.from_m, s.to_m), p = where.pressure_bar(depth);
    out += fmt::format(
        "{:<9} {:>4.4g} m  {:>6}  {:>6}  {:<7}  {:.2f}  {:>4.1f}  {:>2.0f} m  {:>6.0f}\n",
        phase_name(s.phase), s.to_m, clock_text(s.minutes), clock_text(run_min),
        diver::name_of(mix), mix.oxygen * p, diver::gas_density_g_l(mix, p),
        std::max(diver::narcotic_depth_m(mix, depth, where), 0.0), s.litres + between_l);
    between_l = 0.0;
  }
  return out;
}

// The deepest moment, and what is breathed there.
struct DeepestMoment {
  double depth_m = 0.0;
  diver::GasMix mix;
};
DeepestMoment deepest_of(const PlanReport& r) {
  DeepestMoment deepest;
  for (const PlanSegment& s : r.plan.segments)
    if (s.to_m > deepest.depth_m) deepest = {s.to_m, r.request.gases[s.gas].mix};
  return deepest;
}

std::string depth_text(const PlanReport& r) {
  const auto [depth, mix] = deepest_of(r);
  const diver::DecoEnvironment& where = r.request.conventions.environment;
  const double air = std::max(diver::air_depth_m(mix, depth, where), 0.0);
  std::string out = fmt::format("at {:g} m: gas density {:.1f} g/L, END {:.1f} m", depth,
                                diver::gas_density_g_l(mix, where.pressure_bar(depth)),
                                std::max(diver::narcotic_depth_m(mix, depth, where), 0.0));
  if (mix.helium > 0.0) return out + fmt::format(" ({:.1f} by nitrogen alone)\n", air);
  return mix == diver::kAir ? out + "\n" : out + fmt::format(", EAD {:.1f} m\n", air);
}

// Litres used of each gas, and the pressure left in its tank.
std::string gas_text(const PlanReport& r) {
  const diver::PlanBreathing& b = r.breathing;
  std::string out = fmt::format("gas at {:g} L/min, {:g} from the ascent on (litres at 1 bar)\n",
                                b.bottom_l_min, b.ascent_l_min);
  for (const diver::PlanGasUse& use : r.gas) {
    out += fmt::format("  {}: {:.0f} L", diver::name_of(r.request.gases[use.gas].mix), use.used_l);
    if (use.tank && !use.tank->empty_min)
      out += fmt::format("; a tank of {:g} L at {:g} bar ends at {:.0f} bar",
                         use.tank->tank.volume_l, use.tank->tank.pressure_bar, use.tank->end_bar);
    else if (use.tank)
      out += fmt::format(", more than a tank of {:g} L at {:g} bar has", use.tank->tank.volume_l,
                         use.tank->tank.pressure_bar);
    if (use.minimum_l > 0.0)
      out += fmt::format("; minimum gas at {:g} m, {:.0f} min: {:.0f} L", use.minimum_depth_m,
                         use.minimum_run_min, use.minimum_l);
    if (use.tank && use.minimum_l > 0.0)
      out += fmt::format(", {:.0f} bar; the tank then has {:.0f}", use.tank->minimum_bar,
                         use.tank->then_bar);
    out += "\n";
  }
  return out + fmt::format(
                   "  (minimum gas: {:g} divers, each {:g} x {:g} L/min, for {:g} min at depth and "
                   "then up to the next gas)\n",
                   b.divers, b.stress, b.bottom_l_min, b.problem_min);
}

std::string sums_text(const PlanReport& r) {
  const DivePlan& plan = r.plan;
  std::string out = "\n";
  if (plan.stops.empty())
    out += "no stops are needed\n";
  else
    out += fmt::format("first stop {:g} m; stops {} min, ascent {} min, run time {} min\n",
                       plan.stops.front().depth_m, clock_text(plan.stop_min()),
                       clock_text(plan.ascent_min()), clock_text(plan.run_min()));
  if (r.without_stops_min < 0.0)
    out += "no-stop limit: none, stops are needed even after turning at once\n";
  else if (r.without_stops_min >= diver::kNoLimit_min)
    out += "no-stop limit: unlimited\n";
  else
    out += fmt::format("no-stop limit: {:.0f} min of run time{}\n", std::floor(r.without_stops_min),
                       r.request.levels.size() > 1
                           ? fmt::format(" at {:g} m alone", r.request.levels[0].depth_m)
                           : "");
  const diver::OxygenExposure oxygen = r.oxygen(), &before = r.request.oxygen_before;
  const bool repetitive = before.cns_percent > 0.0 || before.otu > 0.0;
  out += fmt::format(
      "CNS {:.0f} %, OTU {:.0f}{}, highest pO2 {:.2f} bar; surfacing at {:.0f} % of the "
      "M-value\n",
      oxygen.cns_percent, oxygen.otu,
      repetitive
          ? fmt::format(" (of earlier dives {:.0f} %, {:.0f})", before.cns_percent, before.otu)
          : "",
      plan.max_po2_bar,
      100.0 *
          std::max(0.0, diver::gradient_share(r.request.conventions.model(), plan.surfacing.tissues,
                                              r.request.conventions.environment.surface_bar)));
  out += depth_text(r);
  for (const diver::PlanGas& gas : r.request.gases) {
    const bool deco = gas.role == diver::GasRole::kDeco;
    const double limit = deco ? 1.6 : 1.4;
    out += fmt::format(
        "MOD of {}: {:.1f} m at {:g} bar\n", diver::name_of(gas.mix),
        diver::max_operating_depth_m(gas.mix, limit, r.request.conventions.environment), limit);
  }
  out += gas_text(r);
  for (const diver::PlanWarning& w : r.warnings) out += "WARNING: " + w.text + "\n";
  return out;
}

nlohmann::json tissues_json(const diver::TissueState& t) {
  nlohmann::json out = nlohmann::json::array();
  for (std::size_t i = 0; i < diver::kCompartments; ++i) out.push_back({t.n2_bar[i], t.he_bar[i]});
  return out;
}

nlohmann::json plan_point_json(const diver::PlanPoint& p) {
  return {{"run_min", p.run_min},
          {"depth_m", p.depth_m},
          {"tissues_n2_he_bar", tissues_json(p.tissues)}};
}

nlohmann::json gas_json(const PlanReport& r) {
  const diver::PlanBreathing& b = r.breathing;
  nlohmann::json json{
      {"rmv_l_min", b.bottom_l_min},
      {"rmv_ascent_l_min", b.ascent_l_min},
      {"minimum_gas", {{"divers", b.divers}, {"times_rmv", b.stress}, {"minutes", b.problem_min}}},
      {"gases", nlohmann::json::array()}};
  for (const diver::PlanGasUse& use : r.gas) {
    nlohmann::json gas{{"name", diver::name_of(r.request.gases[use.gas].mix)},
                       {"used_l", use.used_l}};
    if (use.minimum_l > 0.0) {
      gas["minimum_l"] = use.minimum_l;
      gas["minimum_at"] = {{"runtime_min", use.minimum_run_min}, {"depth_m", use.minimum_depth_m}};
    }
    if (use.tank) {
      const diver::PlanTankUse& t = *use.tank;
      gas["tank"] = {{"volume_l", t.tank.volume_l},
                     {"start_bar", t.tank.pressure_bar},
                     {"enough", !t.empty_min && t.then_bar >= t.minimum_bar}};
      if (t.empty_min)
        gas["tank"]["used_up_at"] = {{"runtime_min", *t.empty_min}, {"depth_m", *t.empty_m}};
      else
        gas["tank"]["end_bar"] = t.end_bar;
      if (use.minimum_l > 0.0) {
        gas["tank"]["minimum_bar"] = t.minimum_bar;
        gas["tank"]["then_bar"] = t.then_bar;
      }
    }
    json["gases"].push_back(gas);
  }
  return json;
}

nlohmann::json request_json(const PlanReport& r) {
  const diver::DecoConventions& c = r.request.conventions;
  nlohmann::json json{{"convention", r.convention},
                      {"table", c.table == diver::BuehlmannTable::kB ? "B" : "C"},
                      {"gf_low", r.request.gf_low},
                      {"gf_high", r.request.gf_high},
                      {"surface_pressure_bar", c.environment.surface_bar},
                      {"bar_per_metre", c.environment.bar_per_m},
                      {"descent_rate_m_min", c.descent_m_min},
                      {"ascent_rate_m_min", c.ascent_m_min},
                      {"last_stop_m", c.last_stop_m},
                      {"saturation", c.saturation},
                      {"desaturation", c.desaturation}};
  for (const diver::PlanGas& gas : r.request.gases)
    json["gases"].push_back({{"name", diver::name_of(gas.mix)},
                             {"o2", 100.0 * gas.mix.oxygen},
                             {"he", 100.0 * gas.mix.helium},
                             {"switch_depth_m", gas.switch_depth_m},
                             {"role", gas.role == diver::GasRole::kDeco     ? "deco"
                                      : gas.role == diver::GasRole::kTravel ? "travel"
                                                                            : "bottom"}});
  for (const diver::PlanLevel& level : r.request.levels)
    json["levels"].push_back({{"depth_m", level.depth_m}, {"leave_runtime_min", level.leave_min}});
  return json;
}

}  // namespace

Result<PlanReport> make_plan_report(const std::string& convention, const DivePlanRequest& request,
                                    const diver::PlanBreathing& breathing,
                                    const std::vector<diver::PlanTank>& tanks) {
  PlanReport report{convention, request, {}, {}, -1.0, breathing, {}};
  NERITIC_TRY(report.plan, diver::plan_dive(request));
  NERITIC_TRY_STATUS(diver::check_ceilings(request, report.plan));
  report.warnings = diver::plan_warnings(request, report.plan);
  NERITIC_TRY(report.gas, diver::gas_use(request, report.plan, breathing, tanks));
  for (diver::PlanWarning& w : diver::gas_warnings(request, report.gas))
    report.warnings.push_back(std::move(w));
  NERITIC_TRY(const auto without, diver::run_time_without_stops(request));
  report.without_stops_min = without.value_or(-1.0);
  return report;
}

std::string table_words(diver::BuehlmannTable table) {
  return table == diver::BuehlmannTable::kB ? "ZH-L16B (--table c: ZH-L16C)"
                                            : "ZH-L16C (--table b: ZH-L16B)";
}

std::string plan_text(const PlanReport& report) {
  return head_text(report) + table_text(report) + sums_text(report);
}

std::string plan_json(const PlanReport& r) {
  const DivePlan& plan = r.plan;
  nlohmann::json json = request_json(r);
  json["segments"] = {
      {"columns",
       {"from_m", "to_m", "minutes", "o2_percent", "he_percent", "phase", "litres_at_1_bar"}},
      {"rows", nlohmann::json::array()}};
  double run_min = 0.0;
  for (const PlanSegment& s : plan.segments) {
    const diver::GasMix& mix = r.request.gases[s.gas].mix;
    json["segments"]["rows"].push_back(
        {s.from_m, s.to_m, s.minutes, 100.0 * mix.oxygen, 100.0 * mix.helium, phase_name(s.phase),
         diver::segment_litres(r.request, plan, r.breathing, s, run_min)});
    run_min += s.minutes;
  }
  json["stops"] = nlohmann::json::array();
  for (const diver::PlanStop& s : plan.stops)
    json["stops"].push_back({{"depth_m", s.depth_m},
                             {"minutes", s.minutes},
                             {"leave_runtime_min", s.leave_min},
                             {"gas", diver::name_of(r.request.gases[s.gas].mix)},
                             {"gf_next", s.gf_next}});
  json["no_deco"] = plan.stops.empty();
  json["total_stop_time_min"] = plan.stop_min();
  json["time_to_surface_min"] = plan.ascent_min();
  json["total_runtime_min"] = plan.run_min();
  json["end_of_bottom"] = plan_point_json(plan.end_of_bottom);
  json["surfacing"] = plan_point_json(plan.surfacing);
  if (plan.first_stop) json["first_stop"] = plan_point_json(*plan.first_stop);
  json["cns_percent"] = r.oxygen().cns_percent;
  json["otu"] = r.oxygen().otu;
  json["cns_percent_before"] = r.request.oxygen_before.cns_percent;
  json["otu_before"] = r.request.oxygen_before.otu;
  json["max_po2_bar"] = plan.max_po2_bar;
  const auto [depth, mix] = deepest_of(r);
  const diver::DecoEnvironment& where = r.request.conventions.environment;
  json["deepest"] = {{"depth_m", depth},
                     {"gas", diver::name_of(mix)},
                     {"gas_density_g_l", diver::gas_density_g_l(mix, where.pressure_bar(depth))},
                     {"end_m", diver::narcotic_depth_m(mix, depth, where)},
                     {"end_n2_m", diver::air_depth_m(mix, depth, where)}};
  json["ndl_runtime_min"] = nullptr;  // none, or without limit
  if (r.without_stops_min >= 0.0 && r.without_stops_min < diver::kNoLimit_min)
    json["ndl_runtime_min"] = r.without_stops_min;
  json["gas"] = gas_json(r);
  json["warnings"] = nlohmann::json::array();
  for (const diver::PlanWarning& w : r.warnings)
    json["warnings"].push_back({{"text", w.text},
                                {"value", w.value},
                                {"limit", w.limit},
                                {"runtime_min", w.run_min},
                                {"depth_m", w.depth_m}});
  return json_text(json) + "\n";
}

std::string log_json(const std::string& file, const diver::DepthLog& log, const DiveTrace& trace) {
  const diver::DiveComputerState& end = trace.end;
  const diver::DiveComputerView& view = trace.rows.back().view;
  const nlohmann::json json{{"file", file},
                            {"samples", log.samples.size()},
                            {"refused", log.failed},
                            {"notes", log.notes},
                            {"runtime_min", trace.rows.back().run_min},
                            {"deepest_m", end.deepest_m},
                            {"deepest_ceiling_m", trace.most_ceiling_m},
                            {"above_ceiling_min", trace.above_ceiling_min},
                            {"ascent_alarm_min", trace.fast_min},
                            {"cns_percent", end.oxygen.cns_percent},
                            {"otu", end.oxygen.otu},
                            {"depth_m", end.last.depth_m},
                            {"ceiling_m", view.ceiling_m},
                            {"ceiling_violated", view.ceiling_violated},
                            {"no_stop_min", view.no_stop_min},
                            {"stop_m", view.stop_m},
                            {"stop_min", view.stop_min},
                            {"time_to_surface_min", view.to_surface_min},
                            {"tissues_n2_he_bar", tissues_json(end.tissues)}};
  return json_text(json) + "\n";
}

}  // namespace neritic::tools
