#include "diver/deco_live.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diver/deco_ndl.hpp"

namespace neritic::diver {
namespace {

constexpr double kHighestSample_m = -10.0, kDeepestSample_m = 2000.0;
constexpr double kSubmerged_m = 0.5;
// A longer time at the surface ends a dive.
constexpr double kNewDive_min = 10.0;
// A diver is at a stop within this distance of its depth.
constexpr double kArrived_m = 0.5;

// The stop at this depth or the next below it.
double stop_at(const DecoConventions& conventions, double depth_m) {
  const double step_m = conventions.stop_step_m;
  return std::max(std::ceil(depth_m / step_m - 1e-9) * step_m, conventions.last_stop_m);
}

// The next stop and the sum of all times.
class NextStop : public AscentSink {
 public:
  explicit NextStop(const DecoEnvironment& where) : where_(where) {}
  void segment(const PlanSegment& s) override {
    minutes += s.minutes;
    if (s.gas < bar_min.size())
      bar_min[s.gas] += s.minutes * where_.pressure_bar(0.5 * (s.from_m + s.to_m));
  }
  void stop(const PlanStop& s) override {
    if (found) return;
    found = true;
    depth_m = s.depth_m;
    stop_min = s.minutes;
  }
  bool found = false;
  double depth_m = 0.0, stop_min = 0.0, minutes = 0.0;
  std::array<double, kToldGases> bar_min{};

 private:
  const DecoEnvironment& where_;
};

bool is_good(const DiveSample& sample, std::size_t gases) {
  return sample.depth_m >= kHighestSample_m && sample.depth_m <= kDeepestSample_m &&
         sample.gas < gases && sample.breathed <= 1;
}

}  // namespace

DiveComputer::DiveComputer(DiveComputerSettings settings)
    : settings_(std::move(settings)),
      ascent_(ascent_settings(settings_.conventions, settings_.gf_low, settings_.gf_high,
                              settings_.gases)) {}

DiveComputer::DiveComputer(DiveComputer&& other) noexcept
    : DiveComputer(std::move(other.settings_)) {}

Result<DiveComputer> DiveComputer::create(DiveComputerSettings settings) {
  // The limits of the planner.
  DivePlanRequest request{settings.conventions,
                          settings.gf_low,
                          settings.gf_high,
                          settings.gases,
                          {{10.0, 200.0}},
                          {},
                          true};
  // A diver says which gas is breathed on the way down: travel gases are gases.
  for (PlanGas& gas : request.gases)
    if (gas.role == GasRole::kTravel) gas.role = GasRole::kDeco;
  NERITIC_TRY_STATUS(check_request(request));
  return DiveComputer(std::move(settings));
}

DiveComputerState DiveComputer::start() const {
  const DecoConventions& c = settings_.conventions;
  return start(saturated(ascent_.model, c.environment.surface_bar, c.start_n2));
}

DiveComputerState DiveComputer::start(const TissueState& tissues) const {
  DiveComputerState state;
  state.tissues = tissues;
  state.surface_min = kNewDive_min;
  return state;
}

DiveComputerState DiveComputer::step(const DiveComputerState& before, const DiveSample& sample,
                                     double dt_s) const {
  DiveComputerState state = before;
  if (!(dt_s >= 0.0 && std::isfinite(dt_s))) {
    ++state.refused;
    return state;
  }
  if (is_good(sample, settings_.gases.size()))
    state.last = {std::max(sample.depth_m, 0.0), sample.gas, sample.breathed};
  else
    ++state.refused;
  const DecoConventions& c = settings_.conventions;
  const double minutes = dt_s / 60.0, from = c.environment.pressure_bar(before.last.depth_m),
               to = c.environment.pressure_bar(state.last.depth_m);
  // A new gas is breathed from the sample on that says so.
  const GasMix& mix = settings_.gases[before.last.gas].mix;
  OxygenExposure more;
  if (before.last.breathed != 0) {
    state.tissues = load(ascent_.model, before.tissues, from, to, minutes, mix);
    more = oxygen_exposure(mix.oxygen * from, mix.oxygen * to, minutes, c.cns_from_bar);
  }
  const bool submerged = std::max(before.last.depth_m, state.last.depth_m) > kSubmerged_m;
  state.oxygen = exposure_after(before.oxygen, more, submerged ? 0.0 : minutes);
  state.ascent = observe(before.ascent, state.last.depth_m, dt_s, settings_.ascent);
  if (submerged) {
    if (state.surface_min >= kNewDive_min) state.dive_min = state.deepest_m = 0.0;
    state.surface_min = 0.0;
    state.dive_min += minutes;
    state.deepest_m = std::max(state.deepest_m, state.last.depth_m);
  } else {
    state.surface_min += minutes;
  }
  move_anchor(state);
  return state;
}

// Stops begin where the planner's would, within a hand that holds its depth. The anchor is kept
// while there is a ceiling, and the diver does not go far below again.
void DiveComputer::move_anchor(DiveComputerState& state) const {
  const DecoConventions& c = settings_.conventions;
  const auto depth_of = [&](double gf) {
    return c.environment.depth_m(ceiling(ascent_.model, state.tissues, gf).pressure_bar);
  };
  const double low_m = depth_of(settings_.gf_low), depth_m = state.last.depth_m;
  if (low_m <= 0.0 || depth_of(settings_.gf_high) <= 0.0) {
    state.anchor_m = 0.0;
    return;
  }
  const double stop = stop_at(c, low_m);
  if (depth_m > std::max(stop, state.anchor_m) + 1.5 * c.stop_step_m) {
    state.anchor_m = 0.0;
  } else if (state.anchor_m > 0.0) {
    if (c.gf_anchor == GfAnchor::kFirstStop) state.anchor_m = std::max(state.anchor_m, stop);
  } else if (depth_m <= stop + kArrived_m) {
    const bool step_by_step = c.first_stop == FirstStop::kStepByStep;
    const AscentState here{state.tissues, 0.0, step_by_step ? std::min(depth_m, stop) : stop,
                           state.last.gas};
    state.anchor_m = first_stop_anchor(ascent_, here).value_or(0.0);
  }
}

// The shallowest depth that is tolerated there.
double DiveComputer::ceiling_m(const DiveComputerState& state) const {
  const DecoEnvironment& where = settings_.conventions.environment;
  const auto tolerated = [&](double depth_m) {
    const double gf = gf_at(ascent_, state.anchor_m, depth_m);
    return ceiling(ascent_.model, state.tissues, gf).pressure_bar <= where.pressure_bar(depth_m);
  };
  double not_deep = 0.0;
  double deep = where.depth_m(ceiling(ascent_.model, state.tissues, settings_.gf_low).pressure_bar);
  if (deep <= 0.0 || tolerated(0.0)) return 0.0;
  while (deep - not_deep > 1e-3) {
    const double middle = 0.5 * (not_deep + deep);
    (tolerated(middle) ? deep : not_deep) = middle;
  }
  return deep;
}

// A deco gas is not taken below its switch depth: of those that reach the stop the one for the
// shallowest use, else the bottom's.
std::size_t DiveComputer::gas_for_stop(std::size_t breathed, double depth_m,
                                       std::uint64_t without) const {
  const std::vector<PlanGas>& gases = settings_.gases;
  const auto reaches = [&](const PlanGas& gas) {
    return gas.role != GasRole::kDeco || gas.switch_depth_m >= depth_m - 1e-9;
  };
  if (reaches(gases[breathed])) return breathed;
  std::size_t best = breathed;
  for (std::size_t i = 0; i < gases.size(); ++i) {
    if (gases[i].role == GasRole::kTravel || (without >> i & 1) != 0 || !reaches(gases[i]))
      continue;
    const bool deco = gases[i].role == GasRole::kDeco;
    if (best == breathed || (deco && (gases[best].role != GasRole::kDeco ||
                                      gases[i].switch_depth_m < gases[best].switch_depth_m)))
      best = i;
  }
  return best;
}

// The depth of the stop that the ceiling asks for; 0: none. A ceiling that lies little below a stop
// sends nobody down who is at that stop. A diver who is still deeper waits at the stop below.
double DiveComputer::owed_stop_m(const DiveComputerState& state,
                                 const DiveComputerView& view) const {
  const DecoConventions& c = settings_.conventions;
  if (view.ceiling_m <= 0.0) return 0.0;
  const double exact = stop_at(c, view.ceiling_m);
  if (view.ceiling_violated) return exact;
  const double eased_m = view.ceiling_m - kCeilingSlack_m;
  const double eased = eased_m > 0.0 ? stop_at(c, eased_m) : 0.0;
  return state.last.depth_m > std::max(eased, c.last_stop_m) + 0.5 * c.stop_step_m ? exact : eased;
}

AscentState DiveComputer::ascent_start(const DiveComputerState& state, const DiveComputerView& view,
                                       std::uint64_t without) const {
  const DecoConventions& c = settings_.conventions;
  AscentState up{state.tissues, state.dive_min, state.last.depth_m, state.last.gas, state.anchor_m};
  const double stop = owed_stop_m(state, view);
  if (stop <= up.depth_m) {
    // The plan owes a whole quantum to each stop at which it arrives. A diver just below a stop has
    // arrived there.
    const double above = std::floor(up.depth_m / c.stop_step_m) * c.stop_step_m;
    if (state.anchor_m > 0.0 && above >= c.last_stop_m && up.depth_m - above <= kArrived_m) {
      up.run_min += (up.depth_m - above) / c.ascent_m_min;
      up.depth_m = above;
    }
    return up;
  }
  up.gas = gas_for_stop(up.gas, stop, without);
  const double way_min = (stop - up.depth_m) / c.descent_m_min;
  up.run_min += way_min;
  up.tissues = load(ascent_.model, up.tissues, c.environment.pressure_bar(up.depth_m),
                    c.environment.pressure_bar(stop), way_min, settings_.gases[up.gas].mix);
  up.depth_m = stop;
  up.stop_owed = view.ceiling_violated;
  return up;
}

DiveComputerView DiveComputer::view(const DiveComputerState& state, std::uint64_t without) const {
  const DecoConventions& c = settings_.conventions;
  const GasMix& mix = settings_.gases[state.last.gas].mix;
  const double depth = state.last.depth_m, p = c.environment.pressure_bar(depth);
  DiveComputerView view;
  view.po2_bar = mix.oxygen * p;
  view.density_g_l = gas_density_g_l(mix, p);
  view.narcotic_m = std::max(narcotic_depth_m(mix, depth, c.environment), 0.0);
  view.gradient = gradient_share(ascent_.model, state.tissues, p);
  view.surface_gradient = gradient_share(ascent_.model, state.tissues, c.environment.surface_bar);
  view.ascent_m_min = state.ascent.rate_m_min;
  view.alarm = alarm_of(state.ascent, settings_.ascent);
  const double left = minutes_without_stops(ascent_, state.tissues, depth, mix);
  view.no_stop_min =
      left < kNoLimit_min ? std::max(left, 0.0) : std::numeric_limits<double>::infinity();
  if (left < 0.0) view.ceiling_m = ceiling_m(state);
  view.ceiling_violated = depth < view.ceiling_m - kCeilingSlack_m;
  AscentState up = ascent_start(state, view, without);
  NextStop next(c.environment);
  next.segment({depth, up.depth_m, up.run_min - state.dive_min, up.gas});  // the way down
  AscentSettings ascent = ascent_;
  ascent.without = without;
  const bool clears = ascend(ascent, up, next) != AscentEnd::kNeverClears;
  view.to_surface_min = clears ? next.minutes : std::numeric_limits<double>::infinity();
  view.to_surface_bar_min = next.bar_min;
  if (next.found) {
    view.stop_m = stop_at(c, next.depth_m);
    view.stop_min = next.stop_min;
  }
  return view;
}

}  // namespace neritic::diver
