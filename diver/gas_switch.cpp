#include "diver/gas_switch.hpp"

#include <algorithm>
#include <type_traits>

#include "diver/oxygen_exposure.hpp"

namespace neritic::diver {
namespace {

static_assert(std::is_trivially_copyable_v<GasSwitchState>);

// Depth of kMostOxygen_bar by the same rule as usual switch depths: 10 m a bar.
double richest_depth_m(const GasMix& mix) {
  return max_operating_depth_m(mix, kMostOxygen_bar, kTenMetresABar);
}

class Chooser {
 public:
  Chooser(std::span<const PlanGas> gases, const Body& body, const TankState& tanks,
          const GasChoice& choice)
      : gases_(gases), body_(body), tanks_(tanks), choice_(choice) {}

  std::size_t choose() const {
    std::size_t best = planned();
    if (best == none()) best = fits(0, richest_depth_m(gases_[0].mix), worth(0)) ? 0 : none();
    if (best == none() && breathable(choice_.breathed, kSpare_pa)) best = choice_.breathed;
    if (best == none()) best = richest(kWorthSwitching_pa);
    if (best == none() && breathable(choice_.breathed, 0.0)) best = choice_.breathed;
    if (best == none()) best = richest(0.0);
    if (best == none() && !gives_breath(choice_.breathed)) best = least_bad();
    return best == none() ? choice_.breathed : best;
  }

 private:
  std::size_t none() const { return gases_.size(); }
  bool breathed(std::size_t i) const { return i == choice_.breathed; }
  double worth(std::size_t i) const { return breathed(i) ? kSpare_pa : kWorthSwitching_pa; }

  // True down to a depth, if the tank has more_pa beyond a full breath, and enough oxygen.
  bool fits(std::size_t i, double down_to_m, double more_pa) const {
    const double shallow_m = std::min(choice_.depth_m, choice_.soon_m);
    const double deep_m = std::max(choice_.depth_m, choice_.soon_m);
    const double kept_to_m =
        std::min(down_to_m + kGasDepthSlack_m, richest_depth_m(gases_[i].mix) + kRichestSlack_m);
    if (deep_m > (breathed(i) ? kept_to_m : down_to_m)) return false;
    // A diver in a mountain lake is used to its air.
    const double used_to = std::min(body_.surface_pa / kSurfacePressure_pa, 1.0);
    const double least_bar = used_to * (breathed(i) ? kLeastOxygen_bar : kLeastOxygenAnew_bar);
    if (gases_[i].mix.oxygen * 1e-5 * pressure_at(body_, shallow_m) < least_bar) return false;
    return gives_breath(i, more_pa);
  }

  bool gives_breath(std::size_t i, double more_pa = 0.0) const {
    const double deep_m = std::max(choice_.depth_m, choice_.soon_m);
    return tank_pressure(body_, tanks_, i) >= pressure_at(body_, deep_m) + kWeakTank_pa + more_pa;
  }

  bool breathable(std::size_t i, double more_pa) const {
    return fits(i, richest_depth_m(gases_[i].mix), more_pa);
  }

  // Deco gas of stops that are done.
  bool goes_on(std::size_t i) const {
    return breathed(i) && choice_.deepest_m > choice_.depth_m + kGasDepthSlack_m;
  }

  std::size_t planned() const {
    std::size_t best = none();
    const auto depth_of = [&](std::size_t i) {
      return std::min(gases_[i].switch_depth_m, richest_depth_m(gases_[i].mix));
    };
    for (std::size_t i = 0; i < gases_.size(); ++i) {
      if (gases_[i].role != GasRole::kDeco || !fits(i, depth_of(i), worth(i))) continue;
      if (choice_.deepest_m <= depth_of(i) && !choice_.makes_stops && !goes_on(i)) continue;
      if (best == none() || depth_of(i) < depth_of(best)) best = i;
    }
    return best;
  }

  std::size_t richest(double more_pa) const {
    std::size_t best = none();
    for (std::size_t i = 0; i < gases_.size(); ++i)
      if (breathable(i, more_pa) &&
          (best == none() || gases_[i].mix.oxygen > gases_[best].mix.oxygen))
        best = i;
    return best;
  }

  // The fallback if no gas is fit: the one with the least oxygen above kThinks_bar.
  std::size_t least_bad() const {
    const double ambient_pa = pressure_at(body_, std::min(choice_.depth_m, choice_.soon_m));
    const double used_to = std::min(body_.surface_pa / kSurfacePressure_pa, 1.0);
    std::size_t best = none();
    for (std::size_t i = 0; i < gases_.size(); ++i) {
      const double oxygen = gases_[i].mix.oxygen;
      if (!gives_breath(i) || oxygen * 1e-5 * ambient_pa < used_to * kThinks_bar) continue;
      if (best == none() || oxygen < gases_[best].mix.oxygen) best = i;
    }
    return best;
  }

  std::span<const PlanGas> gases_;
  const Body& body_;
  const TankState& tanks_;
  const GasChoice& choice_;
};

}  // namespace

std::size_t tank_to_breathe(std::span<const PlanGas> gases, const Body& body,
                            const TankState& tanks, const GasChoice& choice) {
  const std::size_t count = std::min(gases.size(), body.tank_count);
  if (count == 0) return choice.breathed;
  GasChoice of = choice;
  if (of.breathed >= count) of.breathed = 0;  // a tank that the diver has not got
  return Chooser(gases.first(count), body, tanks, of).choose();
}

std::size_t step_gas_switch(const GasSwitching& settings, std::span<const PlanGas> gases,
                            const Body& body, const TankState& tanks,
                            const DiveComputerState& computer, std::size_t breathed, double depth_m,
                            double sink_m_s, double dt_s, GasSwitchState& state) {
  if (!settings.by_plan) return breathed;
  const GasChoice choice{breathed, std::max(depth_m, 0.0),
                         std::max(depth_m + sink_m_s * settings.reaction_s, 0.0),
                         computer.deepest_m, computer.anchor_m > 0.0};
  const std::size_t wanted = tank_to_breathe(gases, body, tanks, choice);
  state.wanted_s = wanted != breathed && wanted == state.wanted ? state.wanted_s + dt_s : 0.0;
  state.wanted = wanted;
  return state.wanted_s >= settings.reaction_s ? wanted : breathed;
}

}  // namespace neritic::diver
