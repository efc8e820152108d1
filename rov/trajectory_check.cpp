#include "rov/trajectory_check.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::rov {
namespace {

constexpr double kSameTime = 1e-9;   // s
constexpr double kFairRate = 120.0;  // Hz, down to which the bars are RK4's

// The case's sine from a time on.
struct Swing {
  const SineWrench* sine;
  double t_s;

  static Vec6 at(const void* context, double t_s) {
    const auto& swing = *static_cast<const Swing*>(context);
    return swing.sine->at(swing.t_s + t_s);
  }
};

const InputSegment* segment_at(const TrajectoryCase& one, double t_s) {
  for (const InputSegment& segment : one.segments)
    if (t_s >= segment.t0_s - kSameTime && t_s < segment.t1_s - kSameTime) return &segment;
  return nullptr;
}

// The next time at which the inputs change.
double next_change(const TrajectoryCase& one, double t_s) {
  double next = 1e300;
  for (const InputSegment& segment : one.segments)
    for (const double edge : {segment.t0_s, segment.t1_s})
      if (edge > t_s + kSameTime) next = std::min(next, edge);
  return next;
}

struct Run {
  const TrajectoryCase& one;
  Integrator integrator;

  State advance(const State& state, double t_s, double dt_s) const {
    const InputSegment* segment = segment_at(one, t_s);
    Inputs inputs;
    inputs.current_ned_m_s = one.current_ned_m_s;
    if (segment) {
      inputs.wrench = segment->wrench;
      inputs.thruster_n = segment->thruster_n;
    }
    const Swing swing{one.sine ? &*one.sine : nullptr, t_s};
    return step(one.vehicle, state, inputs, dt_s, integrator,
                one.sine ? VaryingWrench{&Swing::at, &swing} : VaryingWrench{});
  }
};

// The error at the end that the file states for this length of step; for a rate that it does not
// list, extrapolated from the nearest by the integrator's order. 0, 0 if it states none.
PromisedError promised(const TrajectoryCase& one, const TrajectoryCheck& options) {
  const bool euler = options.integrator == Integrator::kSemiImplicit;
  const double order = euler ? 1.0 : 4.0;
  PromisedError best;
  for (const PromisedError& p : one.promised) {
    if (p.integrator != (euler ? "semi_euler" : "rk4")) continue;
    const auto distance = [&](double hz) { return std::abs(std::log(hz / options.hz)); };
    if (best.hz == 0.0 || distance(p.hz) < distance(best.hz)) best = p;
  }
  if (best.hz == 0.0) return best;
  const double factor = std::pow(best.hz / options.hz, order);
  best.position_m *= factor;
  best.velocity *= factor;
  return best;
}

struct Bars {
  double position, attitude, velocity, force;
};

Bars rk4_bars(const TrajectoryCheck& options, bool has_promise) {
  const double longer = std::pow(std::max(1.0, kFairRate / options.hz), 4.0);
  const bool plain = options.integrator == Integrator::kRk4;
  return {has_promise ? kPositionBar : longer * kPositionBar, longer * kAttitudeBar,
          longer * kVelocityBar,
          kForceBar * (plain ? 10.0 * std::pow(240.0 / options.hz, 4.0) : 1.0)};
}

// About twice what this variant of semi-implicit Euler errs by over the file's trajectories.
Bars euler_bars(double hz) {
  return {4.0 / hz, 0.8 / hz, 1.0 / hz, kForceBar};
}

void keep_worst(CheckedError& kept, double error, double t_s) {
  if (std::isnan(kept.error) || error <= kept.error) return;
  kept.error = error;
  kept.time_s = t_s;
}

double attitude_error(const Quat& a, const Quat& b) {
  const auto largest = [&](double sign) {
    return larger(larger(std::abs(a.w - sign * b.w), std::abs(a.x - sign * b.x)),
                  larger(std::abs(a.y - sign * b.y), std::abs(a.z - sign * b.z)));
  };
  const double plus = largest(1.0), minus = largest(-1.0);
  return std::isnan(plus) || plus <= minus ? plus : minus;
}

// position, attitude, velocity, force
void compare(const TrajectoryCase& one, const TrajectorySample& sample, const State& state,
             std::vector<CheckedError>& errors) {
  const double t = sample.t_s;
  if (sample.position_ned_m)
    keep_worst(errors[0], glm::length(state.position_ned_m - *sample.position_ned_m), t);
  if (sample.attitude) keep_worst(errors[1], attitude_error(state.attitude, *sample.attitude), t);
  if (sample.velocity) {
    const Vec6 off = state.velocity - *sample.velocity;
    keep_worst(errors[2], std::sqrt(dot(off, off)), t);
  }
  const auto forces = thruster_forces(one.vehicle, state, state.held);
  for (std::size_t i = 0; i < sample.thruster_n.size(); ++i)
    keep_worst(errors[3], std::abs(forces[i] - sample.thruster_n[i]), t);
}

}  // namespace

std::vector<State> run_trajectory(const TrajectoryCase& one, const TrajectoryCheck& options) {
  const Run run{one, options.integrator};
  const double dt = 1.0 / options.hz;
  State state;
  state.position_ned_m = one.position_ned_m;
  state.attitude = one.attitude;
  state.velocity = one.velocity;
  std::vector<State> out;
  double start = 0.0, change = next_change(one, 0.0);  // of the inputs that act now
  std::uint64_t steps = 0;                             // since start
  while (out.size() < one.samples.size()) {
    const double t = start + static_cast<double>(steps) * dt;
    const double end = std::min(t + dt > change - kSameTime ? change : t + dt, change);
    while (out.size() < one.samples.size()) {
      const double wanted = one.samples[out.size()].t_s;
      if (wanted > end - kSameTime) break;
      out.push_back(wanted - t > kSameTime ? run.advance(state, t, wanted - t) : state);
    }
    if (out.size() == one.samples.size()) break;
    state = run.advance(state, t, end - t);
    ++steps;
    if (end != change) continue;
    start = change;
    steps = 0;
    change = next_change(one, start);
  }
  return out;
}

CaseResult check_trajectory(const TrajectoryCase& one, const TrajectoryCheck& options) {
  const PromisedError promise = promised(one, options);
  const bool euler = options.integrator == Integrator::kSemiImplicit;
  const Bars bars = euler ? euler_bars(options.hz) : rk4_bars(options, promise.hz > 0.0);
  CaseResult result{one.id, {}, {}};
  const auto counted = [&](const char* what, double told, double most) {
    if (!(told > most)) return told;
    result.note = fmt::format("{} {:g} counts as {:g}", what, told, most);
    return most;
  };
  const double most = euler ? kMostPromisedEuler
                            : kMostPromised * std::pow(std::max(1.0, kFairRate / options.hz), 4.0);
  const double reference =
      counted("reference_error_estimate", one.reference_error, kMostReferenceError);
  const auto tolerance = [&](double promised_error) {
    return std::max(2.0 * counted("fixed_step_end_error", promised_error, most), reference);
  };
  const double position = tolerance(promise.position_m), velocity = tolerance(promise.velocity);
  result.errors = {{"position", "m", 0.0, std::max(bars.position, position)},
                   {"attitude", "", 0.0, std::max({bars.attitude, position, velocity})},
                   {"velocity", "m/s", 0.0, std::max(bars.velocity, velocity)}};
  if (std::ranges::any_of(one.samples, [](const auto& s) { return !s.thruster_n.empty(); }))
    result.errors.push_back({"thruster force", "N", 0.0, bars.force});
  const std::vector<State> states = run_trajectory(one, options);
  for (std::size_t i = euler ? states.size() - 1 : 0; i < states.size(); ++i)
    compare(one, one.samples[i], states[i], result.errors);
  return result;
}

}  // namespace neritic::rov
