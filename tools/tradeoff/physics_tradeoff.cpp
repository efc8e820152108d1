#include "tools/tradeoff/physics_tradeoff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <span>

#include "tools/tradeoff/measure.hpp"
#include "tools/tradeoff/physics_flights.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

using rov::Integrator;

// Steps a hold; 12 are 240 Hz.
constexpr int kCounts[] = {50, 25, 20, 12, 10, 5, 4, 2, 1};
constexpr int kQuickCounts[] = {50, 25, 10, 5, 2, 1};
constexpr Integrator kIntegrators[] = {Integrator::kSemiImplicit, Integrator::kRk4,
                                       Integrator::kGuarded};
// Where halving a step with contacts ends, and the steps a hold: 80 and 1000 Hz.
constexpr double kWithin_m[] = {1e-4, 1e-5, 3e-6};
constexpr int kHalvedCounts[] = {4, 50};
// Later the ball's bounces are too low to count as such, and what slides has stopped.
constexpr double kClosedForms_s = 5.0;
constexpr std::size_t kFlights = std::size(kFlightNames);

double angle_between(const Quat& a, const Quat& b) {
  const Quat off = glm::conjugate(a) * b;
  return 2.0 * std::atan2(glm::length(Vec3(off.x, off.y, off.z)), std::abs(off.w));
}

struct Way {
  int count;  // steps a hold
  StepMethod method;
};

double cpu_us_since(std::clock_t begin) {
  return 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Processor time of the whole flight: other programs' time does not count, but what they do to
// caches and clocks does, hence the least of several.
double least_cpu_us(const Flight& flight, const Way& way, int repeats) {
  double least = 1e300, farthest = 0.0;
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t begin = std::clock();
    flight.fly(way.count, way.method, [&](std::size_t, const rov::State& s) {
      farthest = std::max(farthest, s.position_ned_m.x);
    });
    const double us = cpu_us_since(begin);
    if (farthest > -1.0) least = std::min(least, us);  // the flights are needed for this
  }
  return least;
}

PhysicsPoint measure(Flight& flight, const Way& way, bool quick) {
  const double step_s = kHold_s / way.count;
  rov::prepare_steps(flight.vehicle, std::array{step_s});
  PhysicsPoint point;
  point.flight = flight.name;
  point.integrator = way.method.integrator;
  point.within_m = way.method.contact_error_m;
  point.step_s = step_s;
  const std::clock_t begin = std::clock();
  const FlownError error = flown_error(flight, step_s, way.method);
  const double once_us = cpu_us_since(begin);
  point.error_m = error.m;
  point.error_rad = error.rad;
  // Flights with contacts take tens of times as long: fewer repeats are as precise.
  const double us = quick ? once_us : least_cpu_us(flight, way, flight.solid ? 3 : 15);
  point.us_a_second = us / (static_cast<double>(flight.inputs.size()) * kHold_s);
  return point;
}

// Makes one flight at a time: the reference solutions take memory and time.
Result<Flight> flight_of(std::size_t index, const std::filesystem::path& scene, double seconds) {
  switch (index) {
    case 0:
    case 1:
      return square_flight(index == 1, seconds);
    case 2:
    case 3:
      return mission_flight(index == 3, seconds);
    case 4:
    case 5:
      return contact_flight(index == 5, seconds);
    case 6:
      return contact_mission_flight(seconds);
    case 7:
    case 8:
      return landing_flight(index == 8, seconds);
    case 9:
      return wreck_flight(scene, seconds);
    case 10:
      return bounce_flight(std::min(seconds, kClosedForms_s));
    case 11:
      return slide_flight(std::min(seconds, kClosedForms_s));
    default:
      return roll_flight(std::min(seconds, kClosedForms_s));
  }
}

std::span<const int> counts_of(const PhysicsTradeoffOptions& options) {
  return options.quick ? std::span<const int>(kQuickCounts) : kCounts;
}

void measure_flight(Flight& flight, const PhysicsTradeoffOptions& options, PhysicsTradeoff& out) {
  for (const Integrator integrator : kIntegrators)
    for (const int count : counts_of(options)) {
      PhysicsPoint point = measure(flight, {count, {integrator}}, options.quick);
      if (count != kCounts[0])
        point.order = std::log(point.error_m / out.points.back().error_m) /
                      std::log(point.step_s / out.points.back().step_s);
      out.points.push_back(std::move(point));
      options.step();
    }
  if (!flight.solid) return;
  for (const int count : kHalvedCounts) {
    if (options.quick && count != kHalvedCounts[0]) break;
    for (const double within_m : kWithin_m)
      out.halved.push_back(
          measure(flight, {count, {Integrator::kGuarded, within_m}}, options.quick));
  }
}

}  // namespace

namespace {

// Quick: one, and one that touches something.
std::size_t mission_count(const PhysicsTradeoffOptions& options) {
  return options.quick ? 2 : mission_flights().size();
}

}  // namespace

FlownError flown_error(const Flight& flight, double step_s, const StepMethod& method) {
  FlownError out;
  const int count = static_cast<int>(std::lround(kHold_s / step_s));
  flight.fly(count, method, [&](std::size_t k, const rov::State& state) {
    const rov::State& truth = flight.truth[k];
    const double off = glm::distance(state.position_ned_m, truth.position_ned_m);
    out.m = off <= out.m ? out.m : off;
    out.rad = std::max(out.rad, angle_between(state.attitude, truth.attitude));
  });
  if (!(out.m < 100.0)) out.m = std::numeric_limits<double>::infinity();
  return out;
}

std::uint64_t steps(const PhysicsTradeoffOptions& options) {
  return mission_count(options) +
         kFlights * (1 + std::size(kIntegrators) * counts_of(options).size());
}

Result<PhysicsTradeoff> run_physics_tradeoff(const PhysicsTradeoffOptions& options) {
  PhysicsTradeoff out;
  out.flight_s = options.quick ? 2.0 : 20.0;
  for (std::size_t i = 0; i < kFlights; ++i) {
    NERITIC_TRY(Flight flight, flight_of(i, options.scene, out.flight_s));
    out.truth_error_m[flight.name] = flight.truth_error_m;
    options.step();
    measure_flight(flight, options, out);
  }
  std::vector<MissionFlight> missions = mission_flights();
  if (options.quick) missions = {missions.front(), missions.back()};
  NERITIC_TRY(out.missions, fly_missions(missions, {.assets = options.scene.parent_path() / "..",
                                                    .seconds = out.flight_s,
                                                    .step = options.step}));
  return out;
}

const PhysicsPoint* knee(const PhysicsTradeoff& tradeoff, const std::string& flight) {
  std::vector<const PhysicsPoint*> front;
  std::vector<double> cost, error;
  for (const PhysicsPoint& p : tradeoff.points) {
    const bool beaten = std::ranges::any_of(tradeoff.points, [&](const PhysicsPoint& other) {
      return other.flight == flight && other.us_a_second < p.us_a_second &&
             other.error_m <= p.error_m;
    });
    if (p.flight != flight || !std::isfinite(p.error_m) || beaten) continue;
    front.push_back(&p);
    cost.push_back(std::log(p.us_a_second));
    error.push_back(std::log(p.error_m + 1e-15));
  }
  return front.empty() ? nullptr : front[knee_of(cost, error)];
}

const PhysicsPoint* cheapest(const PhysicsTradeoff& tradeoff, double max_error_m) {
  const PhysicsPoint* best = nullptr;
  for (const PhysicsPoint& p : tradeoff.points) {
    if (p.flight != "lag" || !(p.error_m <= max_error_m)) continue;
    const bool without = std::ranges::any_of(tradeoff.points, [&](const PhysicsPoint& other) {
      return other.flight == "no lag" && other.integrator == p.integrator &&
             other.step_s == p.step_s && other.error_m <= max_error_m;
    });
    if (without && (!best || p.us_a_second < best->us_a_second)) best = &p;
  }
  return best;
}

}  // namespace neritic::tools
