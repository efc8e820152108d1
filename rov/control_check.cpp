#include "rov/control_check.hpp"

#include <algorithm>
#include <cmath>

#include "rov/bluerov2.hpp"
#include "rov/closed_loop.hpp"

namespace neritic::rov {
namespace {

// The largest difference, relative to the largest number expected.
template <class Found>
double difference(const Found& found, const std::vector<double>& expected) {
  double largest = 0.0, size = 1.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    largest = larger(largest, std::abs(found[i] - expected[i]));
    size = std::max(size, std::abs(expected[i]));
  }
  return largest / size;
}

CheckedError exact(const char* what, double error) {
  return {what, "", error, kExactBar};
}

CaseResult check_pid(const PidCase& one) {
  CaseResult result{one.id, {exact("output", 0.0), exact("integral", 0.0)}};
  std::vector<double> integral = one.integral, output(one.axes.size());
  for (std::size_t k = 0; k < one.steps.size(); ++k) {
    const PidStep& step = one.steps[k];
    for (std::size_t i = 0; i < one.axes.size(); ++i)
      output[i] = pid_step(one.axes[i], integral[i], step.error[i], step.rate[i], one.dt_s);
    const double off[] = {difference(output, step.output), difference(integral, step.integral)};
    for (std::size_t i = 0; i < 2; ++i) {
      if (off[i] <= result.errors[i].error) continue;
      result.errors[i].error = off[i];
      result.errors[i].time_s = static_cast<double>(k) * one.dt_s;
    }
  }
  return result;
}

double condition(const Vec6& singular_values) {
  return singular_values[0] / singular_values[5];
}

CaseResult check_matrix(const AllocationTable& table, const Allocator& allocator) {
  CaseResult result{"allocation", {}};
  const PseudoInverse& inverse = allocator.inverse();
  double off = 0.0;
  for (std::size_t k = 0; k < table.inverse.size(); ++k)
    off = larger(off, difference(inverse.rows[k], table.inverse[k]));
  result.errors.push_back(exact("pseudo-inverse", off));
  if (table.rank) result.errors.push_back(exact("rank", std::abs(*table.rank - inverse.rank)));
  result.errors.push_back(
      exact("singular values", difference(inverse.singular_values, table.singular_values)));
  if (table.condition)
    result.errors.push_back(
        exact("condition",
              difference(std::array{condition(inverse.singular_values)}, {*table.condition})));
  if (table.condition_length_0_2) {
    std::vector<Vec6> scaled = table.columns;  // moments over 0.2 m, as forces
    for (Vec6& column : scaled)
      for (std::size_t i = 3; i < 6; ++i) column[i] /= 0.2;
    result.errors.push_back(
        exact("condition at 0.2 m",
              difference(std::array{condition(pseudo_inverse(scaled).singular_values)},
                         {*table.condition_length_0_2})));
  }
  return result;
}

CaseResult check_allocation(const AllocationCase& one, const Allocator& allocator) {
  const Allocation found = allocator.allocate(one.wrench);
  CaseResult result{one.id, {exact("forces wanted", difference(found.wanted_n, one.wanted_n))}};
  if (one.scale) result.errors.push_back(exact("scale", std::abs(found.scale - *one.scale)));
  result.errors.push_back(exact("forces", difference(found.force_n, one.force_n)));
  result.errors.push_back(
      exact("wrench", difference(allocator.wrench_of(found.force_n), one.achieved)));
  return result;
}

Vehicle plant_of(const LoopCase& one) {
  VehicleParameters p = bluerov2_heavy(one.buoyancy_water_kg_m3);
  if (one.buoyancy_water_kg_m3 == 0.0) p.buoyancy_n = p.weight_n;
  p.lag = {ThrusterLag::Kind::kFirstOrder, one.lag_s};
  for (Thruster& t : p.thrusters) {
    t.min_n = one.min_n;
    t.max_n = one.max_n;
  }
  return make_vehicle(p).value();
}

State start_of_loops() {
  State state;
  state.position_ned_m = {0.0, 0.0, 10.0};
  return state;
}

Setpoint setpoint_of(const LoopCase& one) {
  Setpoint s = stay(start_of_loops());
  if (one.axis < 3) {
    s.position_ned_m[static_cast<int>(one.axis)] += one.amount;
  } else {
    Vec3 about(0.0);
    about[static_cast<int>(one.axis) - 3] = 1.0;
    s.attitude = glm::angleAxis(one.amount, about);
  }
  return s;
}

// How far the axis has come, 1 at the setpoint.
std::vector<double> progress(const LoopCase& one, const LoopRun& run) {
  std::vector<double> out;
  for (const State& state : run.states) {
    const Quat& q = state.attitude;
    const Vec3 v(q.x, q.y, q.z);
    const double come =
        one.axis < 3
            ? (state.position_ned_m - run.states.front().position_ned_m)[static_cast<int>(one.axis)]
            : 2.0 * std::atan2(v[static_cast<int>(one.axis) - 3], q.w);
    out.push_back(come / one.amount);
  }
  return out;
}

struct Figure {
  double value, finest;  // what differs by no more than finest is the same
  const char* unit;
};

std::map<std::string, Figure> figures_of(const LoopCase& one, const LoopRun& run) {
  const double period = run.period_s * 1.001;
  std::map<std::string, Figure> out{{"max_tilt_deg", {degrees(run.largest_tilt_rad), 0.06, "deg"}},
                                    {"max_thruster_N", {run.largest_thruster_n, 0.006, "N"}}};
  if (!one.waypoints.empty()) return out;
  const StepResponse r = step_response(progress(one, run), run.period_s);
  out["rise_10_90"] = {r.rise_10_90_s, period, "s"};
  out["t90"] = {r.t90_s, period, "s"};
  out["settle_s"] = {r.settled_s, period, "s"};
  out["overshoot_pct"] = {100.0 * r.overshoot, 0.006, "%"};
  out["final_error"] = {r.final_error, 6e-6, ""};
  return out;
}

CheckedError figure_error(const std::string& what, double found, double expected, double finest,
                          const char* unit, const ControlCheck& options) {
  const bool euler = options.integrator == Integrator::kSemiImplicit;
  return {what, unit, std::abs(found - expected),
          std::max(finest, (euler ? kEulerFigureBar : kFigureBar) * std::abs(expected))};
}

void compare_end(const LoopCase& one, const State& state, const ControlCheck& options,
                 CaseResult& result) {
  if (one.end_state.empty()) return;
  const bool euler = options.integrator == Integrator::kSemiImplicit;
  const double bar = euler ? kEulerEndBar * std::max(1.0, 240.0 / options.hz)
                           : kEndBar * std::pow(std::max(1.0, 120.0 / options.hz), 4.0);
  const auto& e = one.end_state;
  const Vec3 p(e[0], e[1], e[2]);
  const Quat q(e[3], e[4], e[5], e[6]);
  double velocity = 0.0;
  for (std::size_t i = 0; i < 6; ++i)
    velocity = larger(velocity, std::abs(state.velocity[i] - e[7 + i]));
  const Quat &a = state.attitude, minus = a - q, plus = a + q;
  result.errors.push_back({"end position", "m", glm::distance(state.position_ned_m, p), bar});
  result.errors.push_back(
      {"end attitude", "", std::min(glm::length(minus), glm::length(plus)), bar});
  result.errors.push_back({"end velocity", "m/s", velocity, euler ? bar : 10.0 * bar});
}

CaseResult check_loop(const LoopCase& one, const ControlCheck& options) {
  const Vehicle vehicle = plant_of(one);
  WaypointFollower follower(one.waypoints, one.radius_m);
  std::vector<double> arrivals;
  const auto guide = [&](const State& state, double t_s) {
    if (one.waypoints.empty()) return setpoint_of(one);
    const Setpoint s = follower.update(state);
    if (follower.reached() > arrivals.size()) arrivals.push_back(t_s);
    return s;
  };
  const int steps =
      std::max(1, static_cast<int>(std::ceil(options.hz * one.gains.period_s - 1e-9)));
  const LoopRun run = fly(vehicle, one.gains, start_of_loops(), guide, one.duration_s,
                          {steps, options.integrator, one.level_first});
  CaseResult result{one.id, {}};
  const auto found = figures_of(one, run);
  for (const auto& [what, expected] : one.figures) {
    const auto at = found.find(what);
    if (at == found.end()) continue;
    result.errors.push_back(figure_error(what, at->second.value, expected, at->second.finest,
                                         at->second.unit, options));
  }
  for (std::size_t i = 0; i < one.arrivals_s.size(); ++i)
    result.errors.push_back(figure_error(fmt::format("arrival {}", i + 1),
                                         i < arrivals.size() ? arrivals[i] : NAN, one.arrivals_s[i],
                                         run.period_s * 1.001, "s", options));
  compare_end(one, run.states.back(), options, result);
  return result;
}

}  // namespace

std::vector<CaseResult> check_control(const ControlCases& cases, const ControlCheck& options) {
  std::vector<CaseResult> out;
  if (cases.pid) out.push_back(check_pid(*cases.pid));
  if (cases.allocation) {
    const AllocationTable& table = *cases.allocation;
    const Allocator allocator(table.columns, table.min_n, table.max_n);
    out.push_back(check_matrix(table, allocator));
    for (const AllocationCase& one : table.cases) out.push_back(check_allocation(one, allocator));
  }
  for (const LoopCase& one : cases.loops) out.push_back(check_loop(one, options));
  return out;
}

}  // namespace neritic::rov
