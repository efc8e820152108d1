#include "diver/gas_plan.hpp"

#include <algorithm>
#include <cmath>

#include "diver/gas_label.hpp"
#include "diver/limits.hpp"
#include "diver/tanks.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

// Litres of 1 bar are moles of ideal gas, as lungs breathe it.
constexpr double kLitresAMole = 1e3 * kGasConstant * kTankTemperature_k / 1e5;

double litres_in(const GasMix& mix, const PlanTank& tank, double bar) {
  return kLitresAMole * moles_in(mix, 1e-3 * tank.volume_l, 1e5 * bar);
}
double bar_of(const GasMix& mix, const PlanTank& tank, double litres) {
  return 1e-5 * pressure_of(mix, 1e-3 * tank.volume_l, std::max(litres, 0.0) / kLitresAMole);
}

const GasMix& mix_of(const DivePlanRequest& request, std::size_t gas) {
  return request.gases[gas].mix;
}

Status check_tanks(const DivePlanRequest& request, const PlanBreathing& b,
                   const std::vector<PlanTank>& tanks) {
  NERITIC_TRY_STATUS(check_limits({{"litres a minute", b.bottom_l_min, 1.0, 200.0},
                                   {"litres a minute of the ascent", b.ascent_l_min, 1.0, 200.0},
                                   {"divers of the minimum gas", b.divers, 1.0, 10.0},
                                   {"minimum gas: times the breathing", b.stress, 1.0, 10.0},
                                   {"minimum gas: minutes", b.problem_min, 0.0, 60.0}}));
  for (std::size_t i = 0; i < tanks.size(); ++i) {
    const PlanTank& tank = tanks[i];
    if (tank.gas >= request.gases.size())
      return refusal("", fmt::format("tank of gas {}", tank.gas),
                     fmt::format("the {} gases of the plan", request.gases.size()));
    NERITIC_TRY_STATUS(check_limits({{"a tank's litres", tank.volume_l, 0.1, 200.0},
                                     {"a tank's bar", tank.pressure_bar, 1.0, 350.0}}));
    for (std::size_t k = 0; k < i; ++k)
      if (mix_of(request, tanks[k].gas) == mix_of(request, tank.gas))
        return refusal("", fmt::format("two tanks of {}", name_of(mix_of(request, tank.gas))),
                       "one per gas, twins as their sum");
  }
  return {};
}

// Minutes times bar of a segment, as far as a share of it.
double bar_min(const DecoEnvironment& where, const PlanSegment& s, double share = 1.0) {
  const double to_m = s.from_m + share * (s.to_m - s.from_m);
  return share * s.minutes * where.pressure_bar(0.5 * (s.from_m + to_m));
}

// The gas that two divers need from the end of the last level up to another gas or the surface, and
// the depth down to which pressure the tank gives it.
struct MinimumGas {
  std::size_t gas = 0;
  double litres = 0.0, until_m = 0.0;
};
MinimumGas minimum_gas(const DivePlanRequest& request, const DivePlan& plan,
                       const PlanBreathing& breathing) {
  const DecoEnvironment& where = request.conventions.environment;
  MinimumGas out;
  double run_min = 0.0,
         sum = breathing.problem_min * where.pressure_bar(plan.end_of_bottom.depth_m);
  bool up = false;
  for (const PlanSegment& s : plan.segments) {
    if (!up && run_min < plan.end_of_bottom.run_min - 1e-9) {
      run_min += s.minutes;
      out.gas = s.gas;
      out.until_m = s.to_m;
      continue;
    }
    up = true;
    if (mix_of(request, s.gas) != mix_of(request, out.gas)) break;
    sum += bar_min(where, s);
    out.until_m = s.to_m;
  }
  out.litres = breathing.emergency_l_min() * sum;
  return out;
}

// Litres of a mix until a run time.
double used_until(const DivePlanRequest& request, const DivePlan& plan,
                  const PlanBreathing& breathing, const GasMix& mix, double until_min) {
  double run_min = 0.0, litres = 0.0;
  for (const PlanSegment& s : plan.segments) {
    if (run_min >= until_min - 1e-9) break;
    if (mix_of(request, s.gas) == mix)
      litres += segment_litres(request, plan, breathing, s, run_min);
    run_min += s.minutes;
  }
  return litres;
}

// Where the tank gives no full breath any more.
void find_empty(const DivePlanRequest& request, const DivePlan& plan,
                const PlanBreathing& breathing, PlanTankUse& use) {
  const GasMix& mix = mix_of(request, use.tank.gas);
  const DecoEnvironment& where = request.conventions.environment;
  double left = litres_in(mix, use.tank, use.tank.pressure_bar), run_min = 0.0;
  for (const PlanSegment& s : plan.segments) {
    const double litres = segment_litres(request, plan, breathing, s, run_min);
    const double a_bar_min = litres / std::max(bar_min(where, s), 1e-300);
    const auto lasts = [&](double share) {
      const double depth = s.from_m + share * (s.to_m - s.from_m);
      const double least = where.pressure_bar(depth) + 1e-5 * kWeakTank_pa;
      return left - a_bar_min * bar_min(where, s, share) >= litres_in(mix, use.tank, least);
    };
    if (mix_of(request, s.gas) == mix) {
      if (!lasts(0.0) || !lasts(1.0)) {
        double good = 0.0, bad = lasts(0.0) ? 1.0 : 0.0;
        for (int i = 0; i < 40; ++i) {
          const double middle = 0.5 * (good + bad);
          (lasts(middle) ? good : bad) = middle;
        }
        use.empty_min = run_min + bad * s.minutes;
        use.empty_m = s.from_m + bad * (s.to_m - s.from_m);
        return;
      }
      left -= litres;
    }
    run_min += s.minutes;
  }
  use.end_bar = bar_of(mix, use.tank, left);
}

}  // namespace

double segment_litres(const DivePlanRequest& request, const DivePlan& plan,
                      const PlanBreathing& breathing, const PlanSegment& segment, double from_min) {
  const bool ascent = from_min >= plan.end_of_bottom.run_min - 1e-9;
  return (ascent ? breathing.ascent_l_min : breathing.bottom_l_min) *
         bar_min(request.conventions.environment, segment);
}

double tank_bar(const GasMix& mix, const PlanTank& tank, double used_l) {
  return bar_of(mix, tank, litres_in(mix, tank, tank.pressure_bar) - used_l);
}

Result<std::vector<PlanGasUse>> gas_use(const DivePlanRequest& request, const DivePlan& plan,
                                        const PlanBreathing& breathing,
                                        const std::vector<PlanTank>& tanks) {
  NERITIC_TRY_STATUS(check_tanks(request, breathing, tanks));
  std::vector<PlanGasUse> out;
  for (std::size_t gas = 0; gas < request.gases.size(); ++gas) {
    const GasMix& mix = mix_of(request, gas);
    const auto same = [&](const PlanGasUse& use) { return mix_of(request, use.gas) == mix; };
    if (std::ranges::any_of(out, same)) continue;
    out.push_back({gas});
    out.back().used_l = used_until(request, plan, breathing, mix, plan.run_min());
  }
  const auto index_of = [&](std::size_t gas) {
    std::size_t i = 0;
    while (mix_of(request, out[i].gas) != mix_of(request, gas)) ++i;
    return i;
  };
  std::vector<double> until_m(out.size(), 0.0);
  for (std::size_t i = 0; i < request.levels.size(); ++i) {
    NERITIC_TRY(const DivePlan up, plan_dive(request, i + 1));
    const MinimumGas minimum = minimum_gas(request, up, breathing);
    const double before = used_until(request, plan, breathing, mix_of(request, minimum.gas),
                                     up.end_of_bottom.run_min);
    PlanGasUse& use = out[index_of(minimum.gas)];
    if (before + minimum.litres <= use.used_before_l + use.minimum_l) continue;
    use.minimum_l = minimum.litres;
    use.minimum_run_min = up.end_of_bottom.run_min;
    use.minimum_depth_m = up.end_of_bottom.depth_m;
    use.used_before_l = before;
    until_m[index_of(minimum.gas)] = minimum.until_m;
  }
  for (const PlanTank& tank : tanks) {
    const GasMix& mix = mix_of(request, tank.gas);
    const std::size_t at = index_of(tank.gas);
    PlanGasUse& use = out[at];
    use.tank = PlanTankUse{tank};
    find_empty(request, plan, breathing, *use.tank);
    const double held = litres_in(mix, tank, tank.pressure_bar);
    use.tank->then_bar = bar_of(mix, tank, held - use.used_before_l);
    if (use.minimum_l <= 0.0) continue;
    const double least =
        request.conventions.environment.pressure_bar(until_m[at]) + 1e-5 * kWeakTank_pa;
    use.tank->minimum_bar = bar_of(mix, tank, litres_in(mix, tank, least) + use.minimum_l);
  }
  return out;
}

namespace {

// Whole litres, or what there is of one.
std::string litres_text(double litres) {
  return litres < 9.5 ? fmt::format("{:.1g}", litres) : fmt::format("{:.0f}", litres);
}

}  // namespace

std::vector<PlanWarning> gas_warnings(const DivePlanRequest& request,
                                      const std::vector<PlanGasUse>& use) {
  std::vector<PlanWarning> out;
  for (const PlanGasUse& u : use) {
    if (!u.tank) continue;
    const PlanTankUse& t = *u.tank;
    const GasMix& mix = mix_of(request, u.gas);
    const std::string tank = fmt::format("tank of {}, {:g} L at {:g} bar", name_of(mix),
                                         t.tank.volume_l, t.tank.pressure_bar);
    if (t.empty_min) {
      const double held = litres_in(mix, t.tank, t.tank.pressure_bar);
      const double least_bar =
          request.conventions.environment.pressure_bar(*t.empty_m) + 1e-5 * kWeakTank_pa;
      const double weak = litres_in(mix, t.tank, std::min(least_bar, t.tank.pressure_bar));
      out.push_back({PlanWarningKind::kTankTooSmall, *t.empty_min, *t.empty_m, u.used_l, held,
                     u.gas,
                     fmt::format("{}: used up at {:.0f} m, {:.0f} min; the plan takes {:.0f} L, "
                                 "it holds {}, of which {} give no full breath there",
                                 tank, *t.empty_m, *t.empty_min, u.used_l, litres_text(held),
                                 litres_text(weak))});
    } else if (u.minimum_l > 0.0 && t.then_bar < t.minimum_bar - 1e-6) {
      out.push_back(
          {PlanWarningKind::kMinimumGas, u.minimum_run_min, u.minimum_depth_m, t.then_bar,
           t.minimum_bar, u.gas,
           fmt::format("{}: {:.0f} bar left at {:g} m, {:.0f} min; minimum gas for the "
                       "ascent is {:.0f}",
                       tank, t.then_bar, u.minimum_depth_m, u.minimum_run_min, t.minimum_bar)});
    }
  }
  return out;
}

}  // namespace neritic::diver
