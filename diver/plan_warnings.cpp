#include "diver/plan_warnings.hpp"

#include <algorithm>

#include "diver/gas_label.hpp"

namespace neritic::diver {
namespace {

using enum PlanWarningKind;

// R. W. Hamilton's and agencies' working and deco limits; hypoxia as agencies teach it. At altitude
// the limit falls with the air's own oxygen pressure, to which the diver is acclimatised.
constexpr double kBottomPo2_bar = 1.4, kDecoPo2_bar = 1.6, kLeastPo2_bar = 0.16;
constexpr double kNarcotic_m = 30.0, kCns_percent = 80.0, kOtuLimit = 300.0;
constexpr double kSlack = 1e-6;  // limits may be met
// A deco gas is switched to at the stop at its maximum depth, which surface pressure takes a little
// above 1.6 bar: 6 m on oxygen is 1.612.
constexpr double kDecoSlack_bar = 0.02;

class Warnings {
 public:
  Warnings(const DivePlanRequest& request, const DivePlan& plan)
      : request_(request), plan_(plan), where_(request.conventions.environment) {}

  std::vector<PlanWarning> all() {
    double run_min = 0.0;
    for (std::size_t i = 0; i < plan_.segments.size(); ++i) {
      const PlanSegment& s = plan_.segments[i];
      at(s, run_min, s.from_m);
      at(s, run_min + s.minutes, s.to_m);
      if (i > 0) switched(plan_.segments[i - 1], s, run_min);
      run_min += s.minutes;
    }
    const OxygenExposure &oxygen = plan_.oxygen, &before = request_.oxygen_before;
    const double end = plan_.run_min();
    beyond_table();
    over(kCns, {}, end, 0.0, oxygen.cns_percent + before.cns_percent, kCns_percent);
    over(kOtu, {}, end, 0.0, oxygen.otu + before.otu, kOtuLimit);
    for (PlanWarning& w : found_) w.text = text_of(w);
    return std::move(found_);
  }

 private:
  void at(const PlanSegment& s, double run_min, double depth_m) {
    const PlanGas& gas = request_.gases[s.gas];
    const double p = where_.pressure_bar(depth_m), po2 = gas.mix.oxygen * p;
    const bool deco = gas.role == GasRole::kDeco;
    over(kOxygenHigh, s.gas, run_min, depth_m, po2, deco ? kDecoPo2_bar : kBottomPo2_bar,
         deco ? kDecoSlack_bar : kSlack);
    const double least = std::min(kLeastPo2_bar, kAir.oxygen * where_.surface_bar);
    if (po2 < least - kSlack) keep({kOxygenLow, run_min, depth_m, po2, least, s.gas, {}});
    const double density = gas_density_g_l(gas.mix, p);
    const bool most = density > kMostDensity_g_l;
    over(most ? kDensityMost : kDensityAdvised, s.gas, run_min, depth_m, density,
         most ? kMostDensity_g_l : kAdvisedDensity_g_l);
    over(kNarcosis, s.gas, run_min, depth_m, narcotic_depth_m(gas.mix, depth_m, where_),
         kNarcotic_m, 0.05);
  }

  // The plan's minutes above the last pressure for which there is a limit, and the most of them.
  void beyond_table() {
    PlanWarning w{kCnsBeyondTable, 0.0, 0.0, 0.0, kCnsToTable_bar, {}, {}};
    double run_min = 0.0;
    for (const PlanSegment& s : plan_.segments) {
      const auto po2 = [&](double depth_m) {
        return request_.gases[s.gas].mix.oxygen * where_.pressure_bar(depth_m);
      };
      const double from = po2(s.from_m), to = po2(s.to_m), most = std::max(from, to),
                   least = std::min(from, to);
      const double above = most - std::clamp(kCnsToTable_bar, least, most);
      beyond_min_ += s.minutes *
                     (most > least ? above / (most - least) : (most > kCnsToTable_bar ? 1.0 : 0.0));
      if (most > w.value + kSlack) {
        w.value = most;
        w.gas = s.gas;
        w.depth_m = from > to ? s.from_m : s.to_m;
        w.run_min = from > to ? run_min : run_min + s.minutes;
      }
      run_min += s.minutes;
    }
    if (w.value > kCnsToTable_bar + kDecoSlack_bar) keep(w);
  }

  // The rule of fifths (S. Burton, isobaric counter diffusion).
  void switched(const PlanSegment& from, const PlanSegment& to, double run_min) {
    const GasMix &a = request_.gases[from.gas].mix, &b = request_.gases[to.gas].mix;
    const double fall = a.helium - b.helium, rise = b.nitrogen() - a.nitrogen();
    if (fall > 0.0) over(kCounterdiffusion, to.gas, run_min, to.from_m, rise / fall, 0.2);
  }

  void over(PlanWarningKind kind, std::size_t gas, double run_min, double depth_m, double value,
            double limit, double slack = kSlack) {
    if (value > limit + slack) keep({kind, run_min, depth_m, value, limit, gas, {}});
  }

  void keep(const PlanWarning& w) {
    for (PlanWarning& old : found_) {
      // The higher one of the two density limits suffices.
      const bool same = old.kind == w.kind ||
                        (w.kind == kDensityAdvised && old.kind == kDensityMost) ||
                        (w.kind == kDensityMost && old.kind == kDensityAdvised);
      if (!same || old.gas != w.gas) continue;
      const bool worse = w.kind == kOxygenLow ? w.value < old.value : w.value > old.value;
      if (worse) old = w;
      return;
    }
    found_.push_back(w);
  }

  std::string text_of(const PlanWarning& w) const {
    const std::string gas = name_of(request_.gases[w.gas].mix);
    const OxygenExposure& before = request_.oxygen_before;
    const auto earlier = [](double value) {
      return value > 0.0 ? fmt::format(", {:.0f} of earlier dives", value) : std::string();
    };
    const std::string place =
        fmt::format("on {} at {:.4g} m, {:.0f} min", gas, w.depth_m, w.run_min);
    switch (w.kind) {
      case kOxygenHigh:
        return fmt::format("pO2 {:.2f} bar {}: above {:g} (MOD {:.1f} m)", w.value, place, w.limit,
                           max_operating_depth_m(request_.gases[w.gas].mix, w.limit, where_));
      case kOxygenLow:
        return fmt::format("pO2 {:.3f} bar {}: below {:.3g}, hypoxic", w.value, place, w.limit);
      case kDensityAdvised:
        return fmt::format("gas density {:.1f} g/L {}: above {:g}, the advised limit", w.value,
                           place, w.limit);
      case kDensityMost:
        return fmt::format("gas density {:.1f} g/L {}: above {:g}, the highest acceptable", w.value,
                           place, w.limit);
      case kNarcosis:
        return fmt::format("narcotic depth {:.0f} m {}: above {:g}", w.value, place, w.limit);
      case kCns:
        return fmt::format("CNS {:.0f} % at the end{}: above {:g}", w.value,
                           earlier(before.cns_percent), w.limit);
      case kCnsBeyondTable:
        return fmt::format(
            "CNS: {:.1f} min above {:g} bar, where NOAA's table ends, up to {:.2f} {}; there the "
            "limit is extrapolated to zero at 1.7 bar, at least a minute: a warning, not a figure",
            beyond_min_, w.limit, w.value, place);
      case kOtu:
        return fmt::format("OTU {:.0f} at the end{}: above {:g}", w.value, earlier(before.otu),
                           w.limit);
      case kCounterdiffusion:
        return fmt::format(
            "switch to {} at {:.4g} m: nitrogen rises by {:.2f} of the fall in helium, above one "
            "fifth",
            gas, w.depth_m, w.value);
      case kTankTooSmall:
      case kMinimumGas:
        break;  // gas_plan.cpp finds and words these
    }
    return {};
  }

  const DivePlanRequest& request_;
  const DivePlan& plan_;
  const DecoEnvironment& where_;
  std::vector<PlanWarning> found_;
  double beyond_min_ = 0.0;
};

}  // namespace

std::vector<PlanWarning> plan_warnings(const DivePlanRequest& request, const DivePlan& plan) {
  return Warnings(request, plan).all();
}

}  // namespace neritic::diver
