#include "diver/deco_ascent.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace neritic::diver {
namespace {

// Depths and run times that differ by less are the same: they are sums of thirds and tenths.
constexpr double kSame = 1e-9;
constexpr int kMostQuanta = 200000;  // 139 days of whole minutes

class NoSink : public AscentSink {
 public:
  void segment(const PlanSegment&) override {}
};

class Ascent {
 public:
  Ascent(const AscentSettings& settings, AscentState& state, AscentSink& sink)
      : settings_(settings), c_(settings.conventions), state_(state), sink_(sink) {}

  AscentEnd run() {
    if (c_.direct_ascent && !state_.stop_owed && direct_ascent_holds()) {
      move(0.0, PlanPhase::kAscent);
      return AscentEnd::kDirect;
    }
    under_way_ = joined_ = state_.anchor_m > 0.0;
    if (receding() && !under_way_) rise_to_first_stop();
    while (state_.depth_m > 0.0) {
      switch_at_stop();
      if (!leave_stop(next_depth())) return AscentEnd::kNeverClears;
    }
    return AscentEnd::kStops;
  }

  std::optional<double> first_stop_anchor() {
    place_anchor();
    const double next_m = next_depth();
    const bool goes_on = receding()
                             ? stop_below(ceiling_m(settings_.gf_low)) < state_.depth_m - kSame
                             : may_leave(next_m, gf_at(next_m));
    if (goes_on) return {};
    begin_stops();
    return state_.anchor_m;
  }

 private:
  double pressure(double depth_m) const { return c_.environment.pressure_bar(depth_m); }
  const GasMix& mix() const { return settings_.gases[state_.gas].mix; }
  double steps(double depth_m) const { return std::ceil(depth_m / c_.stop_step_m - kSame); }
  bool receding() const { return c_.first_stop == FirstStop::kRecedingCeiling; }

  double ceiling_m(double gf) const {
    const double bar = ceiling(settings_.model, state_.tissues, gf).pressure_bar;
    return std::max(c_.environment.depth_m(bar), 0.0);
  }

  // The stop depth at or below a ceiling.
  double stop_below(double ceiling_m) const {
    const double depth = steps(ceiling_m) * c_.stop_step_m;
    const bool last = depth > 0.0 && depth < c_.last_stop_m && settings_.last_stop_always;
    return last ? c_.last_stop_m : depth;
  }

  // The stop above this depth, or the surface.
  double next_depth() const {
    const double depth = (steps(state_.depth_m) - 1.0) * c_.stop_step_m;
    // A first stop above the last one: only where settings ask for it, and then all steps count.
    const bool above_last =
        !settings_.last_stop_always && receding() && state_.anchor_m < c_.last_stop_m - kSame;
    return depth < c_.last_stop_m - kSame && !above_last ? 0.0 : depth;
  }

  bool direct_ascent_holds() const {
    const TissueState up = after_direct_ascent(settings_, state_.tissues, state_.depth_m, mix());
    return ceiling(settings_.model, up, settings_.gf_high).pressure_bar <= pressure(0.0);
  }

  TissueState moved(double to_m, double minutes) const {
    return load(settings_.model, state_.tissues, pressure(state_.depth_m), pressure(to_m), minutes,
                mix());
  }

  // Upwards, at the ascent's rate.
  void move(double to_m, PlanPhase phase) {
    const double minutes = (state_.depth_m - to_m) / c_.ascent_m_min;
    state_.tissues = moved(to_m, minutes);
    sink_.segment({state_.depth_m, to_m, minutes, state_.gas, phase});
    state_.run_min += minutes;
    state_.depth_m = to_m;
  }

  // The deco gas that comes next on the way up: the deepest one shallower than all used so far.
  // None: the number of gases.
  std::size_t next_gas() const {
    const PlanGas& now = settings_.gases[state_.gas];
    std::size_t best = settings_.gases.size();
    for (std::size_t i = 0; i < settings_.gases.size(); ++i) {
      const PlanGas& gas = settings_.gases[i];
      if (gas.role != GasRole::kDeco || i == state_.gas) continue;
      if ((settings_.without >> i & 1) != 0) continue;
      if (now.role == GasRole::kDeco && gas.switch_depth_m >= now.switch_depth_m) continue;
      if (best == settings_.gases.size() ||
          gas.switch_depth_m > settings_.gases[best].switch_depth_m)
        best = i;
    }
    return best;
  }

  // Rises towards `target` by the ceiling of GF low while that is shallower than the diver.
  void rise_by_ceiling(double target_m) {
    for (;;) {
      const double to = std::max(target_m, stop_below(ceiling_m(settings_.gf_low)));
      if (to >= state_.depth_m - kSame) return;
      move(to, PlanPhase::kAscent);
    }
  }

  // Switches on the way: at its depth where that is a stop's; else up to it and on to the stop
  // above, unless that is above the ceiling of GF low, when the switch waits for a stop.
  bool switch_on_the_way(std::size_t gas) {
    const double at = settings_.gases[gas].switch_depth_m;
    const double above = std::floor(at / c_.stop_step_m + kSame) * c_.stop_step_m;
    if (at >= state_.depth_m - kSame || at - above < kSame) {
      state_.gas = gas;
      return true;
    }
    const AscentState before = state_;
    const auto leg = [&](double to_m) {
      state_.tissues = moved(to_m, (state_.depth_m - to_m) / c_.ascent_m_min);
      state_.depth_m = to_m;
    };
    leg(at);
    state_.gas = gas;
    leg(above);
    const bool holds = ceiling_m(settings_.gf_low) <= above;
    state_ = before;
    if (!holds) return false;
    move(at, PlanPhase::kAscent);
    state_.gas = gas;
    move(above, PlanPhase::kAscent);
    return true;
  }

  void rise_to_first_stop() {
    for (;;) {
      const std::size_t gas = next_gas();
      const bool last = gas == settings_.gases.size();
      const double target =
          last ? 0.0 : steps(settings_.gases[gas].switch_depth_m) * c_.stop_step_m;
      rise_by_ceiling(target);
      if (last || target < state_.depth_m - kSame || !switch_on_the_way(gas)) break;
    }
    if (state_.depth_m > 0.0) begin_stops();
  }

  void begin_stops() {
    if (under_way_) return;
    under_way_ = true;
    if (c_.gf_anchor == GfAnchor::kFirstStop) state_.anchor_m = state_.depth_m;
    sink_.first_stop(state_);
  }

  void switch_at_stop() {
    for (;;) {
      const std::size_t gas = next_gas();
      if (gas == settings_.gases.size()) return;
      const double at = settings_.gases[gas].switch_depth_m;
      const double stop =
          receding() ? std::floor(at / c_.stop_step_m + kSame) * c_.stop_step_m : at;
      if (state_.depth_m > stop + kSame) return;
      state_.gas = gas;
    }
  }

  double gf_at(double depth_m) const { return diver::gf_at(settings_, state_.anchor_m, depth_m); }

  // The ceiling moves until the first stop begins.
  void place_anchor() {
    if (c_.gf_anchor == GfAnchor::kCeiling && !under_way_)
      state_.anchor_m = std::max(1.0 / c_.environment.bar_per_m, ceiling_m(settings_.gf_low));
  }

  bool may_leave(double next_m, double gf) const {
    const TissueState* tissues = &state_.tissues;
    TissueState up;
    if (c_.leaving == LeavingTrial::kTissuesAfterAscent) {
      up = moved(next_m, (state_.depth_m - next_m) / c_.ascent_m_min);
      tissues = &up;
    }
    return ceiling(settings_.model, *tissues, gf).pressure_bar <= pressure(next_m);
  }

  void hold() {
    const double q = c_.stop_quantum_min;
    const bool whole = c_.stop_end == StopEnd::kWholeStop;
    const double end =
        whole ? state_.run_min + q : (std::floor(state_.run_min / q + kSame) + 1.0) * q;
    const double minutes = end - state_.run_min, p = pressure(state_.depth_m);
    const bool even = settings_.model.saturation == 1.0 && settings_.model.desaturation == 1.0;
    state_.tissues = even && std::abs(minutes - q) < kSame
                         ? load(settings_.model, settings_.quantum, state_.tissues, p, p, mix())
                         : load(settings_.model, state_.tissues, p, p, minutes, mix());
    state_.run_min = end;
  }

  // Holds as long as it takes, and rises to next_m. Where the first stop is found by the ceiling,
  // every stop has at least one quantum; one that a computer finds the diver at is under way.
  bool leave_stop(double next_m) {
    const double arrived = state_.run_min;
    bool owed = state_.stop_owed || (receding() && !joined_);
    joined_ = state_.stop_owed = false;
    place_anchor();
    int quanta = 0;
    for (; owed || !may_leave(next_m, gf_at(next_m)); owed = false) {
      if (++quanta > kMostQuanta) return false;
      begin_stops();
      hold();
    }
    if (quanta > 0) {
      const double minutes = c_.stop_end == StopEnd::kWholeStop ? quanta * c_.stop_quantum_min
                                                                : state_.run_min - arrived;
      sink_.segment({state_.depth_m, state_.depth_m, minutes, state_.gas, PlanPhase::kStop});
      sink_.stop({state_.depth_m, minutes, gf_at(next_m), state_.run_min, state_.gas});
    }
    rise(next_m);
    return true;
  }

  // To the next stop; step by step, gases are switched at their depth on the way.
  void rise(double to_m) {
    while (!receding()) {
      const std::size_t gas = next_gas();
      if (gas == settings_.gases.size()) break;
      const double at = settings_.gases[gas].switch_depth_m;
      if (at <= to_m + kSame || at >= state_.depth_m) break;
      move(at, PlanPhase::kAscent);
      state_.gas = gas;
    }
    move(to_m, PlanPhase::kAscent);
  }

  const AscentSettings& settings_;
  const DecoConventions& c_;
  AscentState& state_;
  AscentSink& sink_;
  bool under_way_ = false;  // stops have begun
  bool joined_ = false;     // and the diver is found at one
};

}  // namespace

AscentSettings ascent_settings(const DecoConventions& conventions, double gf_low, double gf_high,
                               std::span<const PlanGas> gases, bool last_stop_always) {
  AscentSettings settings{conventions, conventions.model(), gf_low, gf_high,
                          gases,       last_stop_always,    {},     0};
  settings.quantum = step_factors(settings.model, conventions.stop_quantum_min);
  return settings;
}

double gf_at(const AscentSettings& settings, double anchor_m, double depth_m) {
  const double low = settings.gf_low, high = settings.gf_high;
  if (anchor_m <= 0.0) return low;
  const DecoConventions& c = settings.conventions;
  // A first stop that lies between the steps counts as the one below it.
  const double deepest_m = c.gf_anchor == GfAnchor::kFirstStop
                               ? std::ceil(anchor_m / c.stop_step_m - kSame) * c.stop_step_m
                               : anchor_m;
  return std::clamp(high - (high - low) * depth_m / deepest_m, low, high);
}

std::optional<double> first_stop_anchor(const AscentSettings& settings, const AscentState& state) {
  AscentState here = state;
  NoSink nobody;
  return Ascent(settings, here, nobody).first_stop_anchor();
}

TissueState after_direct_ascent(const AscentSettings& settings, const TissueState& tissues,
                                double depth_m, const GasMix& gas) {
  const DecoEnvironment& where = settings.conventions.environment;
  return load(settings.model, tissues, where.pressure_bar(depth_m), where.pressure_bar(0.0),
              depth_m / settings.conventions.ascent_m_min, gas);
}

AscentEnd ascend(const AscentSettings& settings, AscentState& state, AscentSink& sink) {
  return Ascent(settings, state, sink).run();
}

}  // namespace neritic::diver
