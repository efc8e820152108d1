#include "tools/tradeoff/physics_flights.hpp"

#include <algorithm>
#include <cmath>

#include "rov/bluerov2.hpp"
#include "rov/closed_loop.hpp"
#include "rov/guidance.hpp"
#include "testbed/simulation/water_along.hpp"
#include "tools/tradeoff/extrapolation.hpp"
#include "tools/tradeoff/flight_parts.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kTolerance = 1e-12;
// Steps a hold of the truth among things, 1 ms; where halving those that touch ends, for the truth
// and for what says how sure it is, m.
constexpr int kFinest = 50;
constexpr double kFinest_m = 1e-6, kSecond_m = 3e-6;

}  // namespace

std::size_t holds_of(double seconds) {
  return static_cast<std::size_t>(std::llround(seconds / kHold_s));
}

Loop loop_of(const rov::Vehicle& vehicle, rov::Guide guide) {
  rov::ControlGains gains = rov::default_gains();
  gains.period_s = kHold_s;
  return {rov::Allocator(vehicle), gains, std::move(guide), std::nullopt};
}

namespace {

// Flies by the controller, steps a hold as fine as asked, and keeps its commands.
void record_commands(Flight& flight, double seconds, int count, const rov::Guide& guide,
                     const Vec3& current_ned_m_s) {
  const Loop loop = loop_of(flight.vehicle, guide);
  rov::State state = flight.start;
  rov::ControlState control;
  for (std::size_t k = 0; k < holds_of(seconds); ++k) {
    const double time_s = static_cast<double>(k) * kHold_s;
    rov::Inputs inputs = rov::control_inputs(flight.vehicle, loop.allocator, loop.gains,
                                             guide(state, time_s), state, control);
    inputs.current_ned_m_s = current_ned_m_s;
    flight.inputs.push_back(inputs);
    for (int i = 0; i < count; ++i) state = flight.step(state, inputs, time_s, kHold_s / count, {});
  }
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
Result<std::vector<rov::State>> extrapolated(const Flight& flight, double tolerance) {
  const std::size_t n = flight.vehicle.thruster_count;
  std::vector<rov::State> out;
  Vector y = vector_of(flight.start, n);
  rov::ControlState control;
  for (std::size_t k = 0; k < flight.inputs.size(); ++k) {
    const rov::Inputs inputs = flight.commands(k, state_of(y, n), control);
    const Slope slope = [&](double t_s, const Vector& at) {
      const rov::State now = state_of(at, n);
      const double time_s = static_cast<double>(k) * kHold_s + t_s;
      const rov::StateRate rate =
          rov::derivative(flight.vehicle, now, flight.in_water(inputs, now, time_s, 0.0));
      rov::State as_state;
      as_state.position_ned_m = rate.position_m_s;
      as_state.attitude = rate.attitude;
      as_state.velocity = rate.velocity;
      as_state.lag = rate.lag;
      return vector_of(as_state, n);
    };
    Extrapolated next = extrapolate(slope, 0.0, kHold_s, y, tolerance);
    if (!next.converged)
      return failure(ErrorCode::kUnsupported, "tradeoff physics: the reference does not converge");
    y = std::move(next.y);
    const double length = std::sqrt(y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6]);
    for (std::size_t i = 3; i < 7; ++i) y[i] /= length;
    out.push_back(state_of(y, n));
  }
  return out;
}

std::vector<rov::State> halved(const Flight& flight, double within_m) {
  std::vector<rov::State> out;
  flight.fly(kFinest, {rov::Integrator::kGuarded, within_m},
             [&](std::size_t, const rov::State& state) { out.push_back(state); });
  return out;
}

double most_apart_m(const std::vector<rov::State>& a, const std::vector<rov::State>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    most = std::max(most, glm::distance(a[k].position_ned_m, b[k].position_ned_m));
  return most;
}

}  // namespace

void halved_truth(Flight& flight) {
  flight.truth = halved(flight, kFinest_m);
  flight.truth_error_m = most_apart_m(flight.truth, halved(flight, kSecond_m));
}

namespace {

rov::Vehicle vehicle_of(rov::VehicleParameters parameters, bool lag) {
  if (!lag) parameters.lag.kind = rov::ThrusterLag::Kind::kNone;
  return rov::make_vehicle(parameters).value();
}

// A plane at y = 0 of 40 m, and where asked a wall across its north side.
std::unique_ptr<const sim::StaticWorld> sand(const sim::Surface& surface, bool wall) {
  sim::StaticWorldBuilder builder;
  const std::vector<float> heights_m(41 * 41, 0.0f);
  builder.place(builder.add_heights(41, 41, 1.0, heights_m, "sand").value(), {}, surface);
  if (wall) {
    // 2 m north, turned by 35 degrees.
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back({i & 1 ? 8.0 : -8.0, i & 2 ? 2.0 : -1.0, i & 4 ? -1.0 : 0.0});
    builder.place(builder.add_hull(corners, "wall").value(),
                  {{{0.0, 0.0, -2.0}, glm::angleAxis(radians(35.0), Vec3(0.0, 1.0, 0.0))}, 1.0},
                  surface);
  }
  return std::make_unique<const sim::StaticWorld>(builder.build());
}

// The body that falls, slides and rolls: its mass, weight in water, and friction on sand.
constexpr double kSlideMass_kg = 10.0, kSlideWeight_n = 15.0, kSlideFriction = 0.3;
constexpr double kBallRadius_m = 0.15, kSlideSpeed_m_s = 1.0;

rov::VehicleParameters dragless(double added_kg) {
  rov::VehicleParameters p;
  p.mass_kg = kSlideMass_kg;
  p.weight_n = kSlideWeight_n;
  for (std::size_t i = 0; i < 3; ++i) p.added_mass(i, i) = added_kg;
  return p;
}

Flight ball_flight(const char* name, double added_kg, double seconds) {
  rov::VehicleParameters p = dragless(added_kg);
  p.inertia_kg_m2 = Mat3(0.4 * kSlideMass_kg * kBallRadius_m * kBallRadius_m);
  Flight flight{.name = name, .vehicle = rov::make_vehicle(p).value()};
  flight.body = solid_body(flight.vehicle);
  flight.body.shape.add_sphere(Vec3(0.0), kBallRadius_m);
  flight.inputs.assign(holds_of(seconds), {});
  return flight;
}

// On sand from the start, north at kSlideSpeed_m_s: slowed, and turned forward, evenly for so long,
// then steady.
void slide_north(Flight& flight, double height_m, double slowing_m_s2, double turning_rad_s2,
                 double slowed_s) {
  flight.solid = sand({.friction = kSlideFriction}, false);
  flight.start.position_ned_m.z = -height_m;
  flight.start.velocity[0] = kSlideSpeed_m_s;
  for (std::size_t k = 1; k <= flight.inputs.size(); ++k) {
    const double t = static_cast<double>(k) * kHold_s, slowing = std::min(t, slowed_s);
    rov::State at = flight.start;
    const double by_now = slowing * (t - 0.5 * slowing);
    at.position_ned_m.x = kSlideSpeed_m_s * t - slowing_m_s2 * by_now;
    at.attitude = glm::angleAxis(-turning_rad_s2 * by_now, Vec3(0.0, 1.0, 0.0));
    flight.truth.push_back(at);
  }
}

}  // namespace

sim::Current turning_current() {
  sim::GridCurrent grid{.axes = {{-20.0, -30.0, -20.0}, Vec3(40.0), 0.0, 40.0},
                        .counts = {2, 2, 2, 2},
                        .velocities_m_s = {}};
  for (int i = 0; i < 16; ++i) {
    const double later = i >> 3 & 1, up = i >> 2 & 1, south = i >> 1 & 1, east = i & 1;
    for (const double v :
         {0.1 + 0.3 * up - 0.2 * later, 0.0, 0.2 * east - 0.3 * later + 0.1 * south})
      grid.velocities_m_s.push_back(static_cast<float>(v));
  }
  return grid;
}

namespace {

// Round a circle, up and down, turning.
rov::Setpoint round_and_down(const rov::State&, double t_s) {
  constexpr double kRadius_m = 2.0, kTurn_rad_s = 0.25;
  const double a = kTurn_rad_s * t_s;
  rov::Setpoint s;
  s.position_ned_m = {kRadius_m * std::sin(a), kRadius_m * (1.0 - std::cos(a)),
                      10.0 + 0.5 * std::sin(2.0 * a)};
  s.velocity_ned_m_s = kRadius_m * kTurn_rad_s * Vec3(std::cos(a), std::sin(a), 0.0);
  s.attitude = rov::heading_attitude(a);
  return s;
}

// Down onto sand, along it, up, and against a wall.
rov::Setpoint among_things(const rov::State&, double t_s) {
  rov::Setpoint s;
  if (t_s < 3.0)
    s.position_ned_m = {0.3, 0.1, 0.2};  // down, into the sand
  else if (t_s < 8.0)
    s.position_ned_m = {1.0, 0.3, 0.1};  // along it
  else if (t_s < 10.0)
    s.position_ned_m = {0.7, 0.0, -1.2};  // up
  else if (t_s < 14.0)
    s.position_ned_m = {3.0, -0.5, -1.0};  // into the wall, a corner first
  else if (t_s < 17.0)
    s.position_ned_m = {2.5, 1.0, -1.3};  // along it
  else
    s.position_ned_m = {0.0, 0.0, -1.0};  // away
  s.attitude = rov::heading_attitude(0.0);
  return s;
}

// A speed controller's: 51 N at 1900 us, its square below, none within 28 us of the middle.
rov::ThrustCurve pulse_curve() {
  std::vector<double> pwm_us;
  std::vector<std::vector<double>> thrust_n;
  for (double us = 1100.0; us <= 1900.0; us += 4.0) {
    const double share = std::max(0.0, std::abs(us - 1500.0) - 28.0) / 372.0;
    pwm_us.push_back(us);
    thrust_n.push_back({std::copysign(51.0 * share * share, us - 1500.0)});
  }
  return rov::ThrustCurve::make(std::move(pwm_us), {16.0}, std::move(thrust_n)).value();
}

}  // namespace

Flight vehicle_among_things(const char* name, bool lag) {
  Flight flight{.name = name,
                .vehicle = vehicle_of(rov::bluerov2_heavy_manual(rov::kFreshDensity), lag)};
  flight.body = solid_body(flight.vehicle);
  flight.body.shape.add_box({}, {0.2285, 0.127, 0.2875});
  flight.solid = sand({.friction = 0.5}, true);
  rov::teleport(flight.start, {0.0, 0.0, -0.5}, glm::angleAxis(0.15, Vec3(0.6, 0.8, 0.0)));
  return flight;
}

rov::Inputs Flight::commands(std::size_t hold, const rov::State& state,
                             rov::ControlState& control) const {
  if (!loop) return inputs[hold];
  rov::Inputs out =
      rov::control_inputs(vehicle, loop->allocator, loop->gains,
                          loop->guide(state, static_cast<double>(hold) * kHold_s), state, control);
  if (loop->pulses)
    for (std::size_t i = 0; i < vehicle.thruster_count; ++i)
      out.thruster_n[i] = loop->pulses->realised_n(out.thruster_n[i], 16.0);
  return out;
}

rov::Inputs Flight::in_water(rov::Inputs out, const rov::State& state, double time_s,
                             double dt_s) const {
  if (!current) return out;
  const diver::WaterFlow water = water_along(
      current, {}, state.position_ned_m, state.attitude * state.velocity.linear(), time_s, dt_s);
  out.current_ned_m_s = water.current_m_s;
  out.current_change_ned_m_s2 = water.change_m_s2;
  out.water_acceleration_ned_m_s2 = water.acceleration_m_s2;
  return out;
}

rov::State Flight::step(const rov::State& state, const rov::Inputs& held, double time_s,
                        double dt_s, const StepMethod& method) const {
  const rov::Inputs acting = in_water(held, state, time_s, dt_s);
  const VehicleStep step{body, vehicle, state, acting, dt_s, method};
  const rov::State free = free_step(step);
  return solid ? step_among(*solid, step, free) : free;
}

Result<Flight> square_flight(bool lag, double seconds) {
  Flight flight{.name = lag ? "lag" : "no lag", .vehicle = vehicle_of(rov::bluerov2_heavy(), lag)};
  flight.start.position_ned_m.z = 10.0;
  rov::WaypointFollower follower(
      {{{3, 0, 10}, 0.0}, {{3, 3, 11}, kPi / 2}, {{0, 3, 11.5}, kPi}, {{0, 0, 10}, -kPi / 2}});
  record_commands(flight, seconds, 10,
                  [&](const rov::State& s, double) { return follower.update(s); }, {0.2, 0.1, 0.0});
  NERITIC_TRY(flight.truth, extrapolated(flight, kTolerance));
  NERITIC_TRY(const auto looser, extrapolated(flight, 10.0 * kTolerance));
  flight.truth_error_m = most_apart_m(flight.truth, looser);
  return flight;
}

Result<Flight> mission_flight(bool pulses, double seconds) {
  Flight flight{.name = pulses ? "mission, pulses" : "mission",
                .vehicle = vehicle_of(rov::bluerov2_heavy(), true)};
  flight.start.position_ned_m.z = 10.0;
  flight.inputs.assign(holds_of(seconds), {});
  flight.current = turning_current();
  flight.loop = loop_of(flight.vehicle, round_and_down);
  if (pulses) flight.loop->pulses = pulse_curve();
  NERITIC_TRY(flight.truth, extrapolated(flight, kTolerance));
  NERITIC_TRY(const auto looser, extrapolated(flight, 10.0 * kTolerance));
  flight.truth_error_m = most_apart_m(flight.truth, looser);
  return flight;
}

Flight contact_flight(bool lag, double seconds) {
  Flight flight = vehicle_among_things(lag ? "contact, lag" : "contact, no lag", lag);
  record_commands(flight, seconds, 400, among_things, Vec3(0.0));
  halved_truth(flight);
  return flight;
}

Flight contact_mission_flight(double seconds) {
  Flight flight = vehicle_among_things("mission, contact", true);
  flight.inputs.assign(holds_of(seconds), {});
  flight.loop = loop_of(flight.vehicle, among_things);
  halved_truth(flight);
  return flight;
}

Flight bounce_flight(double seconds) {
  constexpr double kFall_m = 1.0, kBounce = 0.6, kAdded_kg = 5.0;
  Flight flight = ball_flight("bounce", kAdded_kg, seconds);
  flight.solid = sand({.friction = 0.0, .restitution = kBounce}, false);
  flight.start.position_ned_m.z = -(kBallRadius_m + kFall_m);
  // From each touch with its speed on: up and down again takes 2 v / a.
  const double a = kSlideWeight_n / (kSlideMass_kg + kAdded_kg);
  for (std::size_t k = 1; k <= flight.inputs.size(); ++k) {
    double since_s = static_cast<double>(k) * kHold_s - std::sqrt(2.0 * kFall_m / a);
    double up_m_s = kBounce * std::sqrt(2.0 * a * kFall_m);
    rov::State at = flight.start;
    if (since_s < 0.0) {
      const double t = static_cast<double>(k) * kHold_s;
      at.position_ned_m.z += 0.5 * a * t * t;
    } else {
      for (; since_s > 2.0 * up_m_s / a; up_m_s *= kBounce) since_s -= 2.0 * up_m_s / a;
      at.position_ned_m.z = -(kBallRadius_m + up_m_s * since_s - 0.5 * a * since_s * since_s);
    }
    flight.truth.push_back(at);
  }
  return flight;
}

// Coulomb: mu W against the mass that moves, added mass included.
Flight slide_flight(double seconds) {
  constexpr double kAdded_kg = 5.0, kHeight_m = 0.1;
  rov::VehicleParameters p = dragless(kAdded_kg);
  p.inertia_kg_m2 = Mat3(0.4);
  Flight flight{.name = "slide", .vehicle = rov::make_vehicle(p).value()};
  flight.body = solid_body(flight.vehicle);
  flight.body.shape.add_box({}, {0.2, kHeight_m, 0.3});
  flight.inputs.assign(holds_of(seconds), {});
  const double slowing_m_s2 = kSlideFriction * kSlideWeight_n / (kSlideMass_kg + kAdded_kg);
  slide_north(flight, kHeight_m, slowing_m_s2, 0.0, kSlideSpeed_m_s / slowing_m_s2);
  return flight;
}

// Friction slows the ball and turns it until both fit: with I = 2/5 m r^2, at 5/7 of its speed.
Flight roll_flight(double seconds) {
  Flight flight = ball_flight("roll", 0.0, seconds);
  const double slowing_m_s2 = kSlideFriction * kSlideWeight_n / kSlideMass_kg;
  slide_north(flight, kBallRadius_m, slowing_m_s2, 2.5 * slowing_m_s2 / kBallRadius_m,
              2.0 / 7.0 * kSlideSpeed_m_s / slowing_m_s2);
  return flight;
}

}  // namespace neritic::tools
