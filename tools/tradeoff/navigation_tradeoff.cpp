#include "tools/tradeoff/navigation_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "engine/core/random.hpp"
#include "engine/core/refusal.hpp"
#include "rov/closed_loop.hpp"
#include "rov/guidance.hpp"
#include "rov/navigation.hpp"
#include "rov/thrust_priority.hpp"
#include "rov/vehicle_file.hpp"

namespace neritic::tools {
// A namespace of its own: names of rov and of this file stay out of the files compiled with it.
namespace survey_flight {

using namespace rov;

namespace {

constexpr double kStep_s = 1.0 / 250.0;  // every rate below is met within a step
constexpr double kSpeed_m_s = 0.5, kBottom_m = 15.0;
constexpr double kImuRates_hz[] = {10, 25, 50, 100, 200};
constexpr double kDvlRates_hz[] = {1, 2, 4, 8};
constexpr const char* kAidSets[] = {"DVL and USBL", "DVL", "USBL"};

double flight_s(const NavigationTradeoffOptions& options) {
  return options.quick ? 20.0 : 600.0;
}
int seeds(const NavigationTradeoffOptions& options) {
  return options.quick ? 2 : 8;
}

double cast_down(const void*, const Vec3& origin, const Vec3& direction, double most) {
  const double distance = (kBottom_m - origin.z) / direction.z;
  return distance > 0.0 && distance <= most ? distance : std::numeric_limits<double>::infinity();
}

// A survey: legs of 20 m, 4 m apart, up and down by half a metre, facing along.
Setpoint survey(const State& state, double time_s) {
  constexpr double kLeg_m = 20.0, kAcross_m = 4.0, kRound_m = 2.0 * (kLeg_m + kAcross_m);
  const double way = std::fmod(kSpeed_m_s * time_s, kRound_m);
  const double round = std::floor(kSpeed_m_s * time_s / kRound_m);
  Vec3 from(0.0), to(0.0);
  if (way < kLeg_m)
    to = {kLeg_m, 0, 0};
  else if (way < kLeg_m + kAcross_m)
    from = {kLeg_m, 0, 0}, to = {kLeg_m, kAcross_m, 0};
  else if (way < 2.0 * kLeg_m + kAcross_m)
    from = {kLeg_m, kAcross_m, 0}, to = {0, kAcross_m, 0};
  else
    from = {0, kAcross_m, 0}, to = {0, 2.0 * kAcross_m, 0};
  const Vec3 place(0.0, 2.0 * kAcross_m * round, 10.0 + 0.5 * std::sin(0.2 * time_s));
  return at_heading(go_to({}, state, place + from, place + to, kSpeed_m_s),
                    std::atan2(to.y - from.y, to.x - from.x));
}

// True states, one a step.
std::vector<State> fly_survey(const VehicleFile& file, const Vehicle& vehicle, double seconds) {
  const Allocator allocator(vehicle);
  State state;
  teleport(state, {0, 0, 10}, Quat(1.0, 0.0, 0.0, 0.0));
  ControlState control;
  Inputs inputs;
  std::vector<State> states{state};
  const auto count = static_cast<std::size_t>(std::lround(seconds / kStep_s));
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 5 == 0)
      inputs = level_inputs(vehicle, allocator, file.gains,
                            survey(state, static_cast<double>(i) * kStep_s), state, control);
    state = rov::step(vehicle, state, inputs, kStep_s);
    states.push_back(state);
  }
  return states;
}

// The same device read at another rate: its noise a root hertz stays.
void read_at(Imu& imu, double rate_hz) {
  const double more = std::sqrt(rate_hz / imu.rate_hz);
  imu.gyro.white *= more;
  imu.accelerometer.white *= more;
  imu.rate_hz = rate_hz;
}

Vec3 turn_between(const Quat& truth, const Quat& estimate) {
  const Quat q = truth * glm::conjugate(estimate);
  return (q.w < 0.0 ? -2.0 : 2.0) * Vec3(q.x, q.y, q.z);
}

Mat3 block(const NavigationState& state, std::size_t place) {
  Mat3 out;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      out[static_cast<int>(j)][static_cast<int>(i)] = state.covariance(place + i, place + j);
  return out;
}

struct Sums {
  double position_m2 = 0.0, attitude_rad2 = 0.0, consistency = 0.0, end_m2 = 0.0;
  std::size_t count = 0;
};

// One flight of a seed; keeps the readings of its first seconds for timing.
void run_seed(const SensorSet& sensors, const Vehicle& vehicle, const std::vector<State>& truth,
              std::uint64_t seed, Sums& sums, std::vector<SensorReadings>* kept) {
  const SensorWorld world{RayQuery{&cast_down, nullptr}, seed, 0, {}};
  const NavigationModel model = navigation_model(sensors);
  SensorReadings readings;
  update_readings(sensors, world, vehicle, truth[0], {}, -1.0, 0.0, readings);
  NavigationState state =
      start_navigation(model, readings, surveyed_launch(truth[0].position_ned_m, seed, 0), 0.0);
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const double time_s = static_cast<double>(k) * kStep_s;
    update_readings(sensors, world, vehicle, truth[k], {}, time_s - kStep_s, time_s, readings);
    if (kept) kept->push_back(readings);
    update_navigation(model, readings, time_s, state);
    if (k % 25 != 0) continue;
    const Vec3 off = truth[k].position_ned_m - estimate_of(model, state).position_ned_m;
    const Vec3 turned = turn_between(truth[k].attitude, state.attitude);
    sums.position_m2 += glm::dot(off, off);
    sums.attitude_rad2 += glm::dot(turned, turned);
    sums.consistency += glm::dot(off, glm::inverse(block(state, kPositionError)) * off);
    ++sums.count;
  }
  const Vec3 off = truth.back().position_ned_m - estimate_of(model, state).position_ned_m;
  sums.end_m2 += glm::dot(off, off);
}

// Processor time of the filter alone, the least of several runs over the same readings.
double us_a_second(const SensorSet& sensors, const std::vector<SensorReadings>& readings,
                   const State& start) {
  constexpr int kRepeats = 3;
  const NavigationModel model = navigation_model(sensors);
  double least_us = std::numeric_limits<double>::infinity();
  double farthest_m = 0.0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    NavigationState state =
        start_navigation(model, readings.front(), start.position_ned_m, kStep_s);
    const std::clock_t begin = std::clock();
    for (std::size_t k = 1; k < readings.size(); ++k)
      update_navigation(model, readings[k], static_cast<double>(k + 1) * kStep_s, state);
    const double us = 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    farthest_m = std::max(farthest_m, glm::length(estimate_of(model, state).position_ned_m));
    if (farthest_m >= 0.0) least_us = std::min(least_us, us);  // the estimate is needed for this
  }
  return least_us / (static_cast<double>(readings.size()) * kStep_s);
}

}  // namespace
}  // namespace survey_flight

std::uint64_t steps(const NavigationTradeoffOptions& options) {
  using namespace survey_flight;
  const std::size_t points = std::size(kAidSets) * std::size(kImuRates_hz) +
                             (std::size(kAidSets) - 1) * std::size(kDvlRates_hz);
  return points * static_cast<std::uint64_t>(seeds(options));
}

Result<NavigationTradeoff> run_navigation_tradeoff(const NavigationTradeoffOptions& options) {
  using namespace survey_flight;
  NERITIC_TRY(const VehicleFile file, read_vehicle(options.vehicle, 1028.0));
  const SensorSet& all = file.sensors;
  if (!all.imu || !all.dvl || !all.usbl || !all.pressure || !all.compass)
    return refusal(options.vehicle.string(), "no full set of sensors",
                   "[imu], [dvl], [usbl], [pressure] and [compass]");
  NERITIC_TRY(const Vehicle vehicle, make_vehicle(file.parameters));
  NavigationTradeoff out;
  out.vehicle = options.vehicle.stem().string();
  out.flight_s = flight_s(options);
  out.seeds = seeds(options);
  const std::vector<State> truth = fly_survey(file, vehicle, out.flight_s);
  for (std::size_t k = 1; k < truth.size(); ++k)
    out.way_m += glm::distance(truth[k].position_ned_m, truth[k - 1].position_ned_m);
  const auto measure = [&](const std::string& aids, const char* sweep, double rate_hz) {
    SensorSet sensors = all;
    if (aids == "DVL") sensors.usbl.reset();
    if (aids == "USBL") sensors.dvl.reset();
    const bool imu = std::string_view(sweep) == "imu";
    if (imu)
      read_at(*sensors.imu, rate_hz);
    else
      sensors.dvl->rate_hz = rate_hz;
    Sums sums;
    std::vector<SensorReadings> kept;
    const std::vector<State> first(
        truth.begin(), truth.begin() + std::min<std::ptrdiff_t>(std::ssize(truth), 5001));
    for (int seed = 1; seed <= out.seeds; ++seed) {
      SensorSet own = sensors;
      own.compass->deviation_phase_rad =
          2.0 * kPi * random_uniform({static_cast<std::uint64_t>(seed), 99, 0}, 0);
      run_seed(own, vehicle, truth, static_cast<std::uint64_t>(seed), sums, nullptr);
      options.step();
    }
    Sums unused;
    run_seed(sensors, vehicle, first, 1, unused, &kept);
    const double n = static_cast<double>(sums.count);
    const double file_hz = imu ? all.imu->rate_hz : all.dvl->rate_hz;
    out.points.push_back({aids, sweep, rate_hz, std::sqrt(sums.position_m2 / n),
                          std::sqrt(sums.end_m2 / out.seeds),
                          degrees(std::sqrt(sums.attitude_rad2 / n)), sums.consistency / n,
                          us_a_second(sensors, kept, truth[0]), rate_hz == file_hz});
  };
  for (const char* aids : kAidSets)
    for (const double rate_hz : kImuRates_hz) measure(aids, "imu", rate_hz);
  for (const char* aids : {kAidSets[0], kAidSets[1]})
    for (const double rate_hz : kDvlRates_hz) measure(aids, "dvl", rate_hz);
  return out;
}

}  // namespace neritic::tools
