// The tank that a diver breathes from by the plan of the gases: the bottom gas (the
// first tank) on the way down, deco gas from its switch depth on the way up, another tank where one
// is out. Replaces the diver's own hands if no suit is worn. Pure functions over
// plain bytes; any thread. Depths in m, down positive.
#pragma once

#include <cstdint>
#include <span>

#include "diver/deco_live.hpp"
#include "diver/tanks.hpp"

namespace neritic::diver {

// Longer times would look too far ahead: a moving diver seldom keeps one direction that long.
inline constexpr double kMostReaction_s = 20.0;

struct GasSwitching {
  bool by_plan = true;  // false: breathes from the tank that the inputs say
  // From noticing to breathing from the other regulator; an assumption, a setting of diver files.
  double reaction_s = 5.0;  // at most kMostReaction_s
};

struct GasSwitchState {
  std::uint64_t wanted = 0;  // the tank that is reached for, while it is another than is breathed
  double wanted_s = 0.0;     // for so long

  static void fields(auto&& field, auto& self) {
    field("wanted", self.wanted);
    field("wanted_s", self.wanted_s);
  }
};

// A gas is breathed between these pressures of oxygen, bar: the least that thought bears without
// harm is 0.16 (risk_proxies.cpp), 0.18 leaves room; 1.6 is the most at rest (NOAA Diving Manual,
// 4th ed., 2001), at 10 m of water a bar, as switch depths are reckoned. To a gas near the lower
// one the diver changes only from 0.20 on, so that the diver does not alternate. Over a lake in the
// mountains both are its air's share of these.
inline constexpr double kLeastOxygen_bar = 0.18, kLeastOxygenAnew_bar = 0.20;
inline constexpr double kMostOxygen_bar = 1.6;
// Without an alternative the diver breathes down to this, or above kMostOxygen_bar.
inline constexpr double kThinks_bar = 0.16;
// Hysteresis: the gas in use is kept down to kGasDepthSlack_m below its switch depth, but at most
// kRichestSlack_m below the depth of kMostOxygen_bar (1.65 bar of oxygen there).
inline constexpr double kGasDepthSlack_m = 1.0, kRichestSlack_m = 0.5;
// A tank is left when it has less than kSpare_pa beyond a full breath, since the change takes time.
// It is chosen only with kWorthSwitching_pa beyond, so that the ascent forces no change back.
inline constexpr double kSpare_pa = 5e5, kWorthSwitching_pa = 10e5;

// The state of a diver who chooses a gas: the depth now, and after the time that a change takes.
struct GasChoice {
  std::size_t breathed = 0;
  double depth_m = 0.0, soon_m = 0.0;
  double deepest_m = 0.0;  // of this dive
  bool makes_stops = false;
};
// The tank to breathe from; the one breathed where none fits. Gases are the tanks', in their order:
// the first is the bottom gas. Deco gas: where the diver was deeper than its depth at any time of
// the dive and is not below it now, or makes stops, or breathes it and was deeper than now by
// kGasDepthSlack_m; of several the one for the shallowest use, as plans have it. Else the bottom
// gas. If neither is fit to breathe or has gas: the one in use, else the richest that is. Never
// changed to: a gas outside kLeastOxygen_bar to kMostOxygen_bar at the diver's depth now or soon,
// or one without a full breath. A diver without a full breath who has no such tank takes, of those
// that give a breath and have kThinks_bar, the one with the least oxygen.
std::size_t tank_to_breathe(std::span<const PlanGas> gases, const Body& body,
                            const TankState& tanks, const GasChoice& choice);

// dt_s later, while the diver moves down at sink_m_s: the tank that is breathed from then. A change
// that is still wanted after the reaction's time is made.
std::size_t step_gas_switch(const GasSwitching& settings, std::span<const PlanGas> gases,
                            const Body& body, const TankState& tanks,
                            const DiveComputerState& computer, std::size_t breathed, double depth_m,
                            double sink_m_s, double dt_s, GasSwitchState& state);

}  // namespace neritic::diver
