#include "diver/dive_plan.hpp"

#include <algorithm>
#include <cmath>

#include "diver/deco_ascent.hpp"
#include "diver/gas_label.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

constexpr double kSameMinute = 1e-9, kSameDepth_m = 1e-9;
constexpr double kDeepestPlan_m = 2000.0;

bool within(double value, double least, double most) {
  return value >= least && value <= most;  // false where it is no number
}

Status check_conventions(const DecoConventions& c) {
  const DecoEnvironment& e = c.environment;
  if (!within(e.surface_bar, 0.2, 5.0))
    return refusal("", fmt::format("surface pressure {} bar", e.surface_bar), "0.2 to 5");
  if (!within(e.bar_per_m, 0.05, 0.2))
    return refusal("", fmt::format("{} bar a metre", e.bar_per_m), "0.05 to 0.2");
  if (!within(c.water_vapour_bar, 0.0, 0.1) || !within(c.start_n2, 0.0, 1.0))
    return refusal(
        "",
        fmt::format("water vapour {} bar, start at {} of nitrogen", c.water_vapour_bar, c.start_n2),
        "0 to 0.1 and 0 to 1");
  if (!within(c.descent_m_min, 0.1, 1000.0) || !within(c.ascent_m_min, 0.1, 1000.0))
    return refusal("", fmt::format("rates of {} down and {} up", c.descent_m_min, c.ascent_m_min),
                   "0.1 to 1000 m/min");
  if (!within(c.stop_step_m, 0.1, 100.0) || !within(c.stop_quantum_min, 0.01, 60.0))
    return refusal("",
                   fmt::format("stops every {} m and {} min", c.stop_step_m, c.stop_quantum_min),
                   "0.1 to 100 and 0.01 to 60");
  const double steps = c.last_stop_m / c.stop_step_m;
  if (!within(steps, 1.0, 100.0) || std::abs(steps - std::round(steps)) > 1e-9)
    return refusal("", fmt::format("last stop {} m", c.last_stop_m),
                   fmt::format("a multiple of {} m", c.stop_step_m));
  if (!within(c.saturation, 0.1, 10.0) || !within(c.desaturation, 0.1, 10.0))
    return refusal("", fmt::format("saturation {}, desaturation {}", c.saturation, c.desaturation),
                   "0.1 to 10");
  return {};
}

Status check_gases(const std::vector<PlanGas>& gases) {
  if (gases.empty() || gases.size() > 32)
    return refusal("", fmt::format("{} gases", gases.size()), "1 to 32");
  for (const PlanGas& gas : gases) {
    if (!within(gas.mix.oxygen, 0.01, 1.0) || !within(gas.mix.helium, 0.0, 0.99) ||
        gas.mix.nitrogen() < -1e-9)
      return refusal("",
                     fmt::format("gas of {} oxygen and {} helium", gas.mix.oxygen, gas.mix.helium),
                     "shares of one gas");
    if (!within(gas.switch_depth_m, 0.0, kDeepestPlan_m))
      return refusal("", fmt::format("switch to {} at {} m", name_of(gas.mix), gas.switch_depth_m),
                     fmt::format("0 to {} m", kDeepestPlan_m));
  }
  const auto is_bottom = [](const PlanGas& gas) { return gas.role == GasRole::kBottom; };
  if (std::ranges::count_if(gases, is_bottom) != 1)
    return refusal("", fmt::format("{} bottom gases", std::ranges::count_if(gases, is_bottom)),
                   "one");
  return {};
}

Status check_numbers(const DivePlanRequest& r) {
  NERITIC_TRY_STATUS(check_conventions(r.conventions));
  NERITIC_TRY_STATUS(check_gases(r.gases));
  if (!within(r.gf_low, 0.01, 1.5) || !within(r.gf_high, r.gf_low, 1.5))
    return refusal("", fmt::format("gradient factors {}/{}", r.gf_low, r.gf_high),
                   "0.01 to 1.5, low not above high");
  if (r.levels.empty()) return refusal("", "no depth", "at least one");
  for (const PlanLevel& level : r.levels)
    if (!within(level.depth_m, 0.01, kDeepestPlan_m) || !within(level.leave_min, 0.0, 1e6))
      return refusal("", fmt::format("{} m until {} min", level.depth_m, level.leave_min),
                     fmt::format("0.01 to {} m and at most 1000000 min", kDeepestPlan_m));
  if (!r.start) return {};
  for (const Compartments* gas : {&r.start->n2_bar, &r.start->he_bar})
    for (const double bar : *gas)
      if (!within(bar, 0.0, 1000.0))
        return refusal("", fmt::format("{} bar in a tissue", bar), "0 to 1000");
  return {};
}

// Collects what the dive consists of.
class PlanWriter : public AscentSink {
 public:
  PlanWriter(const DivePlanRequest& request, DivePlan& plan) : request_(request), plan_(plan) {}

  void segment(const PlanSegment& s) override {
    if (s.minutes <= 0.0) return;
    plan_.segments.push_back(s);
    const DecoEnvironment& where = request_.conventions.environment;
    const double o2 = request_.gases[s.gas].mix.oxygen;
    const double from = o2 * where.pressure_bar(s.from_m), to = o2 * where.pressure_bar(s.to_m);
    const OxygenExposure more =
        oxygen_exposure(from, to, s.minutes, request_.conventions.cns_from_bar);
    plan_.oxygen.cns_percent += more.cns_percent;
    plan_.oxygen.otu += more.otu;
    plan_.max_po2_bar = std::max({plan_.max_po2_bar, from, to});
  }
  void first_stop(const AscentState& s) override {
    plan_.first_stop = PlanPoint{s.run_min, s.depth_m, s.tissues};
  }
  void stop(const PlanStop& s) override { plan_.stops.push_back(s); }

 private:
  const DivePlanRequest& request_;
  DivePlan& plan_;
};

// The gas for the way down at a depth: of travel and bottom gas that with the deepest switch that
// is not deeper. At the surface that with the shallowest.
std::size_t gas_down_to(const std::vector<PlanGas>& gases, double depth_m) {
  std::size_t best = gases.size(), shallowest = gases.size();
  for (std::size_t i = 0; i < gases.size(); ++i) {
    if (gases[i].role == GasRole::kDeco) continue;
    const double at = gases[i].switch_depth_m;
    if (shallowest == gases.size() || at < gases[shallowest].switch_depth_m) shallowest = i;
    if (at <= depth_m && (best == gases.size() || at >= gases[best].switch_depth_m)) best = i;
  }
  return best == gases.size() ? shallowest : best;
}

// The bottom gas is what is breathed at the deepest level: what a diver would take for the plan of
// one gas must not be that of another.
Status check_bottom_gas(const DivePlanRequest& r) {
  const PlanGas& bottom = *std::ranges::find(r.gases, GasRole::kBottom, &PlanGas::role);
  for (const PlanGas& gas : r.gases)
    if (gas.role == GasRole::kTravel && gas.switch_depth_m == bottom.switch_depth_m)
      return refusal("",
                     fmt::format("bottom gas {} and travel gas {} both from {:g} m",
                                 name_of(bottom.mix), name_of(gas.mix), gas.switch_depth_m),
                     fmt::format("another depth from which the bottom gas is breathed, as {}@40",
                                 name_of(bottom.mix)));
  const double deepest_m = std::ranges::max_element(r.levels, {}, &PlanLevel::depth_m)->depth_m;
  const PlanGas& breathed = r.gases[gas_down_to(r.gases, deepest_m)];
  if (breathed.role != GasRole::kBottom)
    return refusal(
        "",
        fmt::format("bottom gas {} from {:g} m while {} is breathed at {:g} m, the deepest",
                    name_of(bottom.mix), bottom.switch_depth_m, name_of(breathed.mix), deepest_m),
        fmt::format("a depth from {:g} to {:g} m", breathed.switch_depth_m, deepest_m));
  return {};
}

// The way down and the levels.
class WayDown {
 public:
  WayDown(const DivePlanRequest& request, const AscentSettings& settings, AscentState& state,
          AscentSink& sink)
      : request_(request), settings_(settings), state_(state), sink_(sink) {}

  Status run(std::size_t levels) {
    state_.gas = gas_down_to(request_.gases, 0.0);
    for (std::size_t i = 0; i < levels; ++i) {
      const PlanLevel& level = request_.levels[i];
      const AscentState before = state_;
      if (level.depth_m > state_.depth_m)
        descend(level.depth_m);
      else
        move(level.depth_m, (state_.depth_m - level.depth_m) / request_.conventions.ascent_m_min,
             PlanPhase::kAscent);
      if (!above_) watch_ceiling(i, before);
      const double minutes = level.leave_min - state_.run_min;
      if (minutes < -kSameMinute)
        return refusal("",
                       fmt::format("{:g} m until {:g} min, though it is reached after {:.4g} min",
                                   level.depth_m, level.leave_min, state_.run_min),
                       "a later time");
      move(level.depth_m, std::max(minutes, 0.0), PlanPhase::kBottom);
      state_.run_min = std::max(level.leave_min, state_.run_min);
    }
    return {};
  }
  const std::optional<LevelAboveCeiling>& above_ceiling() const { return above_; }

 private:
  void move(double to_m, double minutes, PlanPhase phase) {
    state_.tissues = moved(state_, to_m, minutes);
    sink_.segment({state_.depth_m, to_m, minutes, state_.gas, phase});
    state_.depth_m = to_m;
    state_.run_min += minutes;
  }

  TissueState moved(const AscentState& from, double to_m, double minutes) const {
    const DecoEnvironment& where = request_.conventions.environment;
    return load(settings_.model, from.tissues, where.pressure_bar(from.depth_m),
                where.pressure_bar(to_m), minutes, request_.gases[from.gas].mix);
  }

  void descend(double to_m) {
    while (state_.depth_m < to_m) {
      double next = to_m;  // or where the next gas is breathed
      for (const PlanGas& gas : request_.gases)
        if (gas.role != GasRole::kDeco && gas.switch_depth_m > state_.depth_m)
          next = std::min(next, gas.switch_depth_m);
      move(next, (next - state_.depth_m) / request_.conventions.descent_m_min, PlanPhase::kDescent);
      const std::size_t gas = gas_down_to(request_.gases, next);
      if (request_.gases[gas].switch_depth_m > request_.gases[state_.gas].switch_depth_m)
        state_.gas = gas;
    }
  }

  // With GF low, which holds until stops begin.
  double ceiling_m(const TissueState& tissues) const {
    return request_.conventions.environment.depth_m(
        ceiling(settings_.model, tissues, settings_.gf_low).pressure_bar);
  }

  // A ceiling does not apply while a direct ascent is still allowed.
  bool tolerated(const TissueState& tissues, double depth_m, std::size_t gas) const {
    if (ceiling_m(tissues) <= depth_m + kSameDepth_m) return true;
    if (!request_.conventions.direct_ascent) return false;
    const TissueState up =
        after_direct_ascent(settings_, tissues, depth_m, request_.gases[gas].mix);
    return ceiling(settings_.model, up, settings_.gf_high).pressure_bar <=
           request_.conventions.environment.surface_bar;
  }

  // At a depth on the way from where the diver was.
  bool tolerated_on_the_way(const AscentState& before, double depth_m) const {
    const DecoConventions& c = request_.conventions;
    const double off_m = depth_m - before.depth_m;
    const double minutes = off_m > 0.0 ? off_m / c.descent_m_min : -off_m / c.ascent_m_min;
    return tolerated(moved(before, depth_m, minutes), depth_m, before.gas);
  }

  // Upwards each metre of the way counts. At one depth tissues come nearer to what is breathed,
  // which it tolerates: what holds at arrival is held to hold until the level is left. Not for some
  // seconds where earlier dives left nitrogen and helium is breathed, which goes in faster.
  void watch_ceiling(std::size_t level, const AscentState& before) {
    double good_m = before.depth_m, bad_m = -1.0;
    if (state_.depth_m <= before.depth_m) {
      while (bad_m < 0.0 && good_m > state_.depth_m) {
        const double next_m = std::max(good_m - 1.0, state_.depth_m);
        (tolerated_on_the_way(before, next_m) ? good_m : bad_m) = next_m;
      }
    } else if (!tolerated(state_.tissues, state_.depth_m, state_.gas)) {
      good_m = bad_m = state_.depth_m;
      while (!tolerated_on_the_way(before, good_m) && good_m < kDeepestPlan_m) good_m += 1.0;
    }
    if (bad_m < 0.0) return;
    while (good_m - bad_m > 1e-3) {
      const double middle_m = 0.5 * (good_m + bad_m);
      (tolerated_on_the_way(before, middle_m) ? good_m : bad_m) = middle_m;
    }
    above_ = {level, good_m};
  }

  const DivePlanRequest& request_;
  const AscentSettings& settings_;
  AscentState& state_;
  AscentSink& sink_;
  std::optional<LevelAboveCeiling> above_;
};

PlanPoint point_of(const AscentState& s) {
  return {s.run_min, s.depth_m, s.tissues};
}

AscentSettings settings_of(const DivePlanRequest& r) {
  return ascent_settings(r.conventions, r.gf_low, r.gf_high, r.gases, r.last_stop_always);
}

AscentState start_of(const DivePlanRequest& request, const AscentSettings& settings) {
  const DecoConventions& c = request.conventions;
  AscentState state;
  state.tissues =
      request.start.value_or(saturated(settings.model, c.environment.surface_bar, c.start_n2));
  return state;
}

}  // namespace

double DivePlan::stop_min() const {
  double sum = 0.0;
  for (const PlanStop& stop : stops) sum += stop.minutes;
  return sum;
}

Status check_request(const DivePlanRequest& request) {
  const auto end = end_of_levels(request);
  return end.ok() ? check_bottom_gas(request) : Status{end.error()};
}

Result<PlanPoint> end_of_levels(const DivePlanRequest& request) {
  NERITIC_TRY_STATUS(check_numbers(request));
  const AscentSettings settings = settings_of(request);
  AscentState state = start_of(request, settings);
  DivePlan plan;
  PlanWriter writer(request, plan);
  NERITIC_TRY_STATUS(WayDown(request, settings, state, writer).run(request.levels.size()));
  return point_of(state);
}

Result<DivePlan> plan_dive(const DivePlanRequest& request) {
  return plan_dive(request, request.levels.size());
}

Result<DivePlan> plan_dive(const DivePlanRequest& request, std::size_t levels) {
  NERITIC_TRY_STATUS(check_numbers(request));
  NERITIC_TRY_STATUS(check_bottom_gas(request));
  const AscentSettings settings = settings_of(request);
  AscentState state = start_of(request, settings);
  DivePlan plan;
  plan.start = point_of(state);
  PlanWriter writer(request, plan);
  WayDown down(request, settings, state, writer);
  NERITIC_TRY_STATUS(down.run(std::min(levels, request.levels.size())));
  plan.above_ceiling = down.above_ceiling();
  plan.end_of_bottom = point_of(state);
  const AscentEnd end = ascend(settings, state, writer);
  if (end == AscentEnd::kNeverClears)
    return refusal("",
                   fmt::format("no end of the stop at {:g} m on {}: its ceiling never clears",
                               state.depth_m, name_of(request.gases[state.gas].mix)),
                   "a gas with less inert gas");
  plan.no_stops = end == AscentEnd::kDirect;
  plan.surfacing = point_of(state);
  return plan;
}

Status check_ceilings(const DivePlanRequest& request, const DivePlan& plan) {
  if (!plan.above_ceiling) return {};
  const LevelAboveCeiling& above = *plan.above_ceiling;
  const PlanLevel& level = request.levels[above.level];
  return refusal(
      "",
      fmt::format("{:g} m until {:g} min, above the ceiling, which is at {:.2f} m on the way there",
                  level.depth_m, level.leave_min, above.least_m),
      fmt::format("{:.1f} m or deeper", std::ceil(10.0 * above.least_m) / 10.0));
}

Result<TissueState> tissues_after(const std::vector<EarlierDive>& dives,
                                  std::vector<DivePlan>* plans) {
  std::optional<TissueState> tissues;
  for (const EarlierDive& earlier : dives) {
    DivePlanRequest request = earlier.dive;
    if (tissues) request.start = tissues;
    NERITIC_TRY(DivePlan plan, plan_dive(request));
    const double surface = request.conventions.environment.surface_bar;
    tissues = load(request.conventions.model(), plan.surfacing.tissues, surface, surface,
                   earlier.surface_min, earlier.surface_gas);
    if (plans) plans->push_back(std::move(plan));
  }
  if (!tissues) return refusal("", "no earlier dive", "at least one");
  return *tissues;
}

OxygenExposure oxygen_after(const std::vector<EarlierDive>& dives,
                            const std::vector<DivePlan>& plans) {
  constexpr double kDay_min = 24.0 * 60.0;
  OxygenExposure left;
  double ago_min = 0.0;  // since the end of a dive, from the newest back
  for (std::size_t i = dives.size(); i-- > 0;) {
    ago_min += dives[i].surface_min;
    if (ago_min <= kDay_min) left.otu += plans[i].oxygen.otu;
    ago_min += plans[i].run_min();
  }
  for (std::size_t i = 0; i < dives.size(); ++i) {
    const DecoConventions& c = dives[i].dive.conventions;
    const double po2 = dives[i].surface_gas.oxygen * c.environment.surface_bar;
    const OxygenExposure up = oxygen_exposure(po2, po2, dives[i].surface_min, c.cns_from_bar);
    left.cns_percent += plans[i].oxygen.cns_percent;
    left = exposure_after(left, up, dives[i].surface_min);
  }
  return left;
}

}  // namespace neritic::diver
