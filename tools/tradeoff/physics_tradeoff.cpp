#include "tools/tradeoff/physics_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "rov/bluerov2.hpp"
#include "rov/closed_loop.hpp"
#include "rov/guidance.hpp"
#include "tools/tradeoff/extrapolation.hpp"
#include "tools/tradeoff/measure.hpp"

namespace neritic::tools {
namespace {

using rov::Integrator;

// Commands change every 50 ms: the longest step.
constexpr double kHold = 0.05;  // s
// Steps a hold; 12 are 240 Hz.
constexpr int kCounts[] = {50, 25, 20, 12, 10, 5, 4, 2, 1};
constexpr Integrator kIntegrators[] = {Integrator::kSemiImplicit, Integrator::kRk4,
                                       Integrator::kGuarded};
constexpr double kTolerance = 1e-12;

// What is flown: a vehicle, a start, and commands held for kHold each.
struct Flight {
  std::string name;
  rov::Vehicle vehicle;
  rov::State start;
  std::vector<rov::Inputs> inputs;
};

// Round a square of three metres, as the controller flies it at 20 Hz in a current, recorded: all
// integrators then get the same commands.
Flight make_flight(bool lag, double seconds) {
  rov::VehicleParameters p = rov::bluerov2_heavy();
  if (!lag) p.lag.kind = rov::ThrusterLag::Kind::kNone;
  Flight flight{lag ? "lag" : "no lag", rov::make_vehicle(p).value(), {}, {}};
  flight.start.position_ned_m.z = 10.0;
  rov::WaypointFollower follower(
      {{{3, 0, 10}, 0.0}, {{3, 3, 11}, kPi / 2}, {{0, 3, 11.5}, kPi}, {{0, 0, 10}, -kPi / 2}});
  rov::ControlGains gains = rov::default_gains();
  gains.period_s = kHold;
  const rov::Allocator allocator(flight.vehicle);
  rov::State state = flight.start;
  rov::ControlState control;
  while (static_cast<double>(flight.inputs.size()) * kHold < seconds) {
    rov::Inputs inputs = rov::control_inputs(flight.vehicle, allocator, gains,
                                             follower.update(state), state, control);
    inputs.current_ned_m_s = {0.2, 0.1, 0.0};
    flight.inputs.push_back(inputs);
    for (int i = 0; i < 10; ++i) state = rov::step(flight.vehicle, state, inputs, kHold / 10);
  }
  return flight;
}

Vector vector_of(const rov::State& s, std::size_t thrusters) {
  Vector y{s.position_ned_m.x, s.position_ned_m.y, s.position_ned_m.z, s.attitude.w,
           s.attitude.x,       s.attitude.y,       s.attitude.z};
  y.insert(y.end(), s.velocity.v.begin(), s.velocity.v.end());
  for (std::size_t i = 0; i < thrusters; ++i) y.insert(y.end(), s.lag[i].begin(), s.lag[i].end());
  return y;
}

rov::State state_of(const Vector& y, std::size_t thrusters) {
  rov::State s;
  s.position_ned_m = {y[0], y[1], y[2]};
  s.attitude = {y[3], y[4], y[5], y[6]};
  std::copy_n(y.begin() + 7, 6, s.velocity.v.begin());
  for (std::size_t i = 0; i < thrusters; ++i) std::copy_n(&y[13 + 3 * i], 3, s.lag[i].begin());
  return s;
}

// The state at the end of every hold, by the equation in absolute velocity.
Result<std::vector<rov::State>> reference(const Flight& flight, double tolerance) {
  const std::size_t n = flight.vehicle.thruster_count;
  std::vector<rov::State> out;
  Vector y = vector_of(flight.start, n);
  for (const rov::Inputs& inputs : flight.inputs) {
    const Slope slope = [&](double, const Vector& at) {
      const rov::StateRate rate = rov::derivative(flight.vehicle, state_of(at, n), inputs);
      rov::State as_state;
      as_state.position_ned_m = rate.position_m_s;
      as_state.attitude = rate.attitude;
      as_state.velocity = rate.velocity;
      as_state.lag = rate.lag;
      return vector_of(as_state, n);
    };
    Extrapolated next = extrapolate(slope, 0.0, kHold, y, tolerance);
    if (!next.converged)
      return failure(ErrorCode::kUnsupported, "tradeoff physics: the reference does not converge");
    y = std::move(next.y);
    const double length = std::sqrt(y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6]);
    for (std::size_t i = 3; i < 7; ++i) y[i] /= length;
    out.push_back(state_of(y, n));
  }
  return out;
}

double angle_between(const Quat& a, const Quat& b) {
  const Quat off = glm::conjugate(a) * b;
  return 2.0 * std::atan2(glm::length(Vec3(off.x, off.y, off.z)), std::abs(off.w));
}

// Calls seen(hold, state) after every hold.
template <class Seen>
void fly_all(const Flight& flight, Integrator integrator, int count, const Seen& seen) {
  rov::State state = flight.start;
  for (std::size_t k = 0; k < flight.inputs.size(); ++k) {
    for (int i = 0; i < count; ++i)
      state = rov::step(flight.vehicle, state, flight.inputs[k], kHold / count, integrator);
    seen(k, state);
  }
}

// Processor time of the whole flight: other programs' time does not count, but what they do to
// caches and clocks does, hence the least of several.
double least_cpu_us(const Flight& flight, Integrator integrator, int count, int repeats) {
  double least = 1e300, farthest = 0.0;
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t begin = std::clock();
    fly_all(flight, integrator, count, [&](std::size_t, const rov::State& s) {
      farthest = std::max(farthest, s.position_ned_m.x);
    });
    const double us = 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    if (farthest > -1.0) least = std::min(least, us);  // the flights are needed for this
  }
  return least;
}

PhysicsPoint measure(const Flight& flight, const std::vector<rov::State>& truth,
                     Integrator integrator, int count, int repeats) {
  PhysicsPoint point;
  point.vehicle = flight.name;
  point.integrator = integrator;
  point.step_s = kHold / count;
  fly_all(flight, integrator, count, [&](std::size_t k, const rov::State& state) {
    const double off = glm::distance(state.position_ned_m, truth[k].position_ned_m);
    point.error_m = off <= point.error_m ? point.error_m : off;
    point.error_rad = std::max(point.error_rad, angle_between(state.attitude, truth[k].attitude));
  });
  if (!(point.error_m < 100.0)) point.error_m = std::numeric_limits<double>::infinity();
  point.us_a_second = least_cpu_us(flight, integrator, count, repeats) /
                      (static_cast<double>(flight.inputs.size()) * kHold);
  return point;
}

}  // namespace

std::uint64_t steps(const PhysicsTradeoffOptions&) {
  return 2 * (1 + std::size(kIntegrators) * std::size(kCounts));
}

Result<PhysicsTradeoff> run_physics_tradeoff(const PhysicsTradeoffOptions& options) {
  PhysicsTradeoff out;
  out.flight_s = options.quick ? 2.0 : 20.0;
  for (const bool lag : {false, true}) {
    const Flight flight = make_flight(lag, out.flight_s);
    NERITIC_TRY(const auto truth, reference(flight, kTolerance));
    NERITIC_TRY(const auto looser, reference(flight, 10.0 * kTolerance));
    for (std::size_t k = 0; k < truth.size(); ++k)
      out.reference_error_m = std::max(
          out.reference_error_m, glm::distance(truth[k].position_ned_m, looser[k].position_ned_m));
    options.step();
    for (const Integrator integrator : kIntegrators)
      for (const int count : kCounts) {
        PhysicsPoint point = measure(flight, truth, integrator, count, options.quick ? 1 : 15);
        if (count != kCounts[0])
          point.order = std::log(point.error_m / out.points.back().error_m) /
                        std::log(point.step_s / out.points.back().step_s);
        out.points.push_back(std::move(point));
        options.step();
      }
  }
  return out;
}

const PhysicsPoint* knee(const PhysicsTradeoff& tradeoff, const std::string& vehicle) {
  std::vector<const PhysicsPoint*> front;
  std::vector<double> cost, error;
  for (const PhysicsPoint& p : tradeoff.points) {
    const bool beaten = std::ranges::any_of(tradeoff.points, [&](const PhysicsPoint& other) {
      return other.vehicle == vehicle && other.us_a_second < p.us_a_second &&
             other.error_m <= p.error_m;
    });
    if (p.vehicle != vehicle || !std::isfinite(p.error_m) || beaten) continue;
    front.push_back(&p);
    cost.push_back(std::log(p.us_a_second));
    error.push_back(std::log(p.error_m + 1e-15));
  }
  return front.empty() ? nullptr : front[knee_of(cost, error)];
}

const PhysicsPoint* cheapest(const PhysicsTradeoff& tradeoff, double max_error_m) {
  const PhysicsPoint* best = nullptr;
  for (const PhysicsPoint& p : tradeoff.points) {
    if (p.vehicle != "lag" || !(p.error_m <= max_error_m)) continue;
    const bool without = std::ranges::any_of(tradeoff.points, [&](const PhysicsPoint& other) {
      return other.vehicle != p.vehicle && other.integrator == p.integrator &&
             other.step_s == p.step_s && other.error_m <= max_error_m;
    });
    if (without && (!best || p.us_a_second < best->us_a_second)) best = &p;
  }
  return best;
}

}  // namespace neritic::tools
