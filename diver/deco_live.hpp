// A dive computer: tissues and oxygen sample by sample, and what it would show. Pure functions over
// plain bytes, without allocation; any thread. One step costs microseconds, what is shown some
// tens: a simulation steps at its own rate and asks for the view once a second.
#pragma once

#include <array>
#include <vector>

#include "diver/deco_ascent.hpp"
#include "diver/deco_ascent_rate.hpp"

namespace neritic::diver {

// How often a computer samples, as those on wrists do. The corners of a dive that are cut off
// between samples make 1.4e-5 bar (`neritic tradeoff deco`; a tenth of a millimetre of ceiling);
// the knee is at 10 to 30 s, 1e-3 to 1e-2 bar, but the alarm of the ascent's rate fits a line
// through 10 s.
inline constexpr double kComputerSample_s = 1.0;

struct DiveComputerSettings {
  DecoConventions conventions;
  double gf_low = 0.3, gf_high = 0.85;
  std::vector<PlanGas> gases = std::vector<PlanGas>(1);  // air
  AscentRateLimits ascent;
};

struct DiveSample {
  double depth_m = 0.0;
  std::uint64_t gas = 0;       // of the settings
  std::uint64_t breathed = 1;  // 0: nothing came to breathe; tissues and oxygen stay as they are

  static void fields(auto&& field, auto& self) {
    field("depth_m", self.depth_m);
    field("gas", self.gas);
    field("breathed", self.breathed);
  }
};

struct DiveComputerState {
  TissueState tissues;
  OxygenExposure oxygen;  // exposure_after; OTU since the computer was started, of any day
  AscentRateState ascent;
  DiveSample last;                           // that was good
  double dive_min = 0.0, surface_min = 0.0;  // since the way down; since the way up
  double deepest_m = 0.0;
  double anchor_m = 0.0;  // where GF low was used up (GfAnchor), once stops have begun; 0: none
  std::uint64_t refused = 0;

  static void fields(auto&& field, auto& self) {
    field("tissues", self.tissues);
    field("oxygen", self.oxygen);
    field("ascent", self.ascent);
    field("last", self.last);
    field("dive_min", self.dive_min);
    field("surface_min", self.surface_min);
    field("deepest_m", self.deepest_m);
    field("anchor_m", self.anchor_m);
    field("refused", self.refused);
  }
};

// Shallower than the ceiling by more is a violation; less is a sensor's noise, and what sets of
// conventions differ by in the gradient factor at a stop.
inline constexpr double kCeilingSlack_m = 0.3;

// The number of gases whose share of the ascent is reported: the first ones of the settings.
inline constexpr std::size_t kToldGases = 4;

// The data of a computer's display. Above a ceiling the stops begin at or below it, not where the
// diver is: the next stop is then deeper than the diver, at the surface too, and the way down to it
// is part of the time to the surface. The way up is reckoned as breathed.
struct DiveComputerView {
  double ceiling_m = 0.0;               // of the gradient factor that holds there; 0: none
  bool ceiling_violated = false;        // the diver is above it by more than kCeilingSlack_m
  double no_stop_min = 0.0;             // left without stops; 0 with a ceiling; infinite: no limit
  double stop_m = 0.0, stop_min = 0.0;  // the next stop; 0: none
  double to_surface_min = 0.0;          // infinite where the ceiling never clears
  // Pressure times time of it on each gas; times litres per minute it is the gas for the ascent.
  std::array<double, kToldGases> to_surface_bar_min{};
  double po2_bar = 0.0, density_g_l = 0.0, narcotic_m = 0.0;
  double gradient = 0.0, surface_gradient = 0.0;  // of the M-value, here and if at the surface
  double ascent_m_min = 0.0;
  AscentAlarm alarm = AscentAlarm::kNone;
};

class DiveComputer {
 public:
  // Errors: what of the settings is wrong.
  static Result<DiveComputer> create(DiveComputerSettings settings);
  DiveComputer(const DiveComputer&) = delete;
  DiveComputer(DiveComputer&& other) noexcept;

  const DiveComputerSettings& settings() const { return settings_; }
  // At the surface, never dived; or with these tissues.
  DiveComputerState start() const;
  DiveComputerState start(const TissueState& tissues) const;
  // dt_s after the last sample; the depth changed linearly, and the diver breathed the last gas. If
  // that was none, no gas enters or leaves the lungs: tissues, CNS and OTU stay as they are. A
  // sample that is not finite or out of bounds (-10 to 2000 m, a gas that is not in the settings,
  // breathed above 1, dt_s negative or infinite) is refused and counted, and the last good sample
  // is used. A depth above the surface counts as 0.
  DiveComputerState step(const DiveComputerState& before, const DiveSample& sample,
                         double dt_s) const;
  // without: bits of gases whose tanks are empty or shut: the ascent does not switch to them.
  DiveComputerView view(const DiveComputerState& state, std::uint64_t without = 0) const;

 private:
  explicit DiveComputer(DiveComputerSettings settings);
  void move_anchor(DiveComputerState& state) const;
  double ceiling_m(const DiveComputerState& state) const;
  // Where the ascent that is shown begins: where the diver is, or at the stop below a ceiling that
  // the diver is above, after the way down to it.
  double owed_stop_m(const DiveComputerState& state, const DiveComputerView& view) const;
  AscentState ascent_start(const DiveComputerState& state, const DiveComputerView& view,
                           std::uint64_t without) const;
  std::size_t gas_for_stop(std::size_t breathed, double depth_m, std::uint64_t without) const;

  DiveComputerSettings settings_;
  AscentSettings ascent_;  // borrows settings_
};

}  // namespace neritic::diver
