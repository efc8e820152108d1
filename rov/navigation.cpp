#include "rov/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rov/controller.hpp"
#include "rov/navigation_measurements.hpp"
#include "rov/navigation_start.hpp"

namespace neritic::rov {
namespace {

// Beyond these no reading is one: what the devices can measure (16 g, 2000 degrees a second), the
// deepest sea, and speeds that no vehicle has.
constexpr double kMostForce_m_s2 = 160.0, kMostTurning_rad_s = 35.0;
// A reading beyond these is no jolt either, but a fault.
constexpr double kMostJolt_m_s2 = 1e4, kMostJolt_rad_s = 1e3;
constexpr double kMostDepth_m = 12e3, kMostFix_m = 1e7;
// Rejections over this time, and at least this number, before a sensor is believed again: a DVL
// that locks onto something that moves errs for seconds.
constexpr double kPatience_s = 10.0;
constexpr double kLeastPatience = 5.0;
// After this number of fixes that are rejected, or this time of depths, the navigation is lost: an
// echo is not five times in a row, and a depth has no echo.
constexpr std::uint64_t kLostFixes = 5;
constexpr double kLostDepth_s = 5.0;
// The position is known so well where it begins anew, before the fix that it is taken from.
constexpr double kAnewSigma_m = 1e3;

// An inertial reading holds for this number of periods.
constexpr double kHeldPeriods = 4.0;

// The covariance follows the motion at least this often: its transition takes the attitude for
// constant since.
constexpr double kLongestPending_s = 0.1;

// The random stream of launch errors, apart from the sensors'.
constexpr std::uint64_t kLaunchStream = 0x6c61756e63680000ull;

std::uint64_t patience(double rate_hz) {
  return static_cast<std::uint64_t>(std::max(kLeastPatience, std::ceil(kPatience_s * rate_hz)));
}

// Whether there is a reading that was not used yet; it is then.
template <class Value>
bool fresh(const Reading<Value>& reading, std::uint64_t& used) {
  return std::exchange(used, reading.count) != reading.count;
}

// In body axes.
ImuReading in_body(const NavigationModel& model, const ImuReading& reading) {
  return {model.imu.mount.rotation * reading.angular_rad_s,
          model.imu.mount.rotation * reading.specific_force_m_s2};
}

// Moves the state to time_s without a new inertial reading: the last one holds for some periods.
void carry(const NavigationModel& model, double time_s, NavigationState& state) {
  const double dt_s = time_s - state.time_s;
  if (!(dt_s > 0.0)) return;
  const double silent_s = std::max(0.0, state.time_s - state.imu_s);
  if (silent_s + dt_s <= kHeldPeriods / model.imu.rate_hz)
    move(state, state.imu, model.imu.gravity_m_s2, dt_s);
  else
    coast(state, silent_s, dt_s);
}

// Moves the state to time_s by the inertial unit's next reading. It is the mean since the last:
// where the state was carried into that time by the last one, the rest of it remains.
void move_on(const NavigationModel& model, const ImuReading& next, double time_s,
             NavigationState& state) {
  const double dt_s = time_s - state.time_s, whole_s = time_s - state.imu_s;
  ImuReading rest = next;
  if (dt_s > 0.0 && dt_s < whole_s && whole_s <= kHeldPeriods / model.imu.rate_hz) {
    const auto left = [&](const Vec3& mean, const Vec3& carried) {
      return mean + ((whole_s - dt_s) / dt_s) * (mean - carried);
    };
    rest = {left(next.angular_rad_s, state.imu.angular_rad_s),
            left(next.specific_force_m_s2, state.imu.specific_force_m_s2)};
  }
  move(state, rest, model.imu.gravity_m_s2, dt_s);
  state.imu = next;
  state.imu_s = std::max(state.imu_s, time_s);
}

// After a jolt that is beyond what the inertial unit measures: the vehicle gained about what the
// reading says, which is not used, and turned by a few degrees or what it says. How far the reading
// can be relied on is an estimate: along it not at all, across it to 30 %.
void doubt_jolt(const NavigationModel& model, const ImuReading& reading, NavigationState& state) {
  constexpr double kAcross = 0.3, kTurned_rad = 0.05;
  if (!is_finite_within(reading.specific_force_m_s2, kMostJolt_m_s2) ||
      !is_finite_within(reading.angular_rad_s, kMostJolt_rad_s))
    return;
  move_covariance(state, model.motion);
  const double period_s = 1.0 / model.imu.rate_hz;
  const Vec3 gained = period_s * (state.attitude * reading.specific_force_m_s2);
  const double across = kAcross * glm::length(gained);
  const double turned = std::max(period_s * glm::length(reading.angular_rad_s), kTurned_rad);
  const auto add = [&](std::size_t i, std::size_t j, double variance) {
    state.covariance.set(i, j, state.covariance(i, j) + variance);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    add(kAttitudeError + i, kAttitudeError + i, turned * turned);
    add(kVelocityError + i, kVelocityError + i, across * across);
    for (std::size_t j = i; j < 3; ++j)
      add(kVelocityError + i, kVelocityError + j,
          gained[static_cast<int>(i)] * gained[static_cast<int>(j)]);
  }
}

class Corrections {
 public:
  Corrections(const NavigationModel& model, double time_s, NavigationState& state)
      : model_(model), time_s_(time_s), state_(state) {}

  // Refuses a reading that no such sensor can make.
  bool refuse(Aid aid, bool good) {
    if (!good) ++tally(aid).refused;
    return !good;
  }
  // Whether the navigation is lost: this reading would be the last of so many that are rejected.
  bool lost(Aid aid, std::uint64_t most, const Measurement& measurement) {
    return tally(aid).rejected_in_a_row + 1 >= most &&
           normalized_innovation_squared(state_, measurement) > outlier_bound(measurement.count);
  }
  // Carries the state to the time of the readings, before it is compared with one.
  void prepare() {
    carry(model_, time_s_, state_);
    move_covariance(state_, model_.motion);
  }
  void apply(Aid aid, double rate_hz, const Measurement& measurement) {
    correct(state_, measurement, tally(aid), patience(rate_hz));
  }

 private:
  AidTally& tally(Aid aid) { return state_.aids[static_cast<std::size_t>(aid)]; }
  const NavigationModel& model_;
  double time_s_;
  NavigationState& state_;
};

void correct_by_dvl(const NavigationModel& model, const DvlReading& reading, Corrections& out,
                    const NavigationState& state) {
  for (std::size_t beam = 0; beam < 4; ++beam) {
    const auto aid = static_cast<Aid>(beam);
    const double speed = reading.speed_m_s[beam];
    if (!reading.hears(beam) || out.refuse(aid, std::abs(speed) <= kMostSpeed_m_s)) continue;
    out.prepare();
    out.apply(aid, model.dvl->rate_hz, beam_measurement(model, state, beam, speed));
  }
}

void correct_by_fix(const NavigationModel& model, const SensorReadings& readings, double age_s,
                    Corrections& out, NavigationState& state) {
  const UsblReading& reading = readings.usbl.value;
  if (reading.heard == 0) return;
  if (out.refuse(Aid::kUsbl, is_finite_within(reading.position_ned_m, kMostFix_m))) return;
  out.prepare();
  if (out.lost(Aid::kUsbl, kLostFixes, fix_measurement(model, state, reading, age_s))) {
    begin_anew(model, readings, kAnewSigma_m, state);
    state.position_ned_m = reading.position_ned_m -
                           state.attitude * (model.usbl->beacon_m - model.imu.mount.position_m);
  }
  out.apply(Aid::kUsbl, model.usbl->rate_hz, fix_measurement(model, state, reading, age_s));
}

void correct_by_depth(const NavigationModel& model, const SensorReadings& readings,
                      Corrections& out, NavigationState& state) {
  const double depth_m = readings.pressure.value.depth_m, rate_hz = model.pressure->rate_hz;
  if (out.refuse(Aid::kPressure, std::abs(depth_m) <= kMostDepth_m)) return;
  out.prepare();
  const auto most = static_cast<std::uint64_t>(
      std::max(static_cast<double>(kLostFixes), std::ceil(kLostDepth_s * rate_hz)));
  if (out.lost(Aid::kPressure, most, depth_measurement(model, state, depth_m))) {
    // As far as it may have gone off since a depth was right; the next fix finds it.
    const double since_s = std::max(0.0, state.time_s - state.of(Aid::kPressure).accepted_s);
    const double off_m = (glm::length(state.velocity_ned_m_s) + kAnewSigma_m_s) * since_s +
                         glm::length(state.sigma3(kPositionError));
    begin_anew(model, readings, std::min(off_m, kAnewSigma_m), state);
    state.position_ned_m.z =
        depth_m -
        (state.attitude * (model.pressure->mount.position_m - model.imu.mount.position_m)).z;
  }
  out.apply(Aid::kPressure, rate_hz, depth_measurement(model, state, depth_m));
}

// All but the inertial unit's.
void correct_by_new(const NavigationModel& model, const SensorReadings& readings, double time_s,
                    NavigationState& state) {
  Corrections out(model, time_s, state);
  if (model.dvl && fresh(readings.dvl, state.dvl_used))
    correct_by_dvl(model, readings.dvl.value, out, state);
  if (model.pressure && fresh(readings.pressure, state.pressure_used))
    correct_by_depth(model, readings, out, state);
  if (model.compass && fresh(readings.heading_rad, state.compass_used)) {
    const double heading = readings.heading_rad.value;
    if (!out.refuse(Aid::kCompass, std::abs(heading) <= 10.0 * kPi) && has_heading(state)) {
      out.prepare();
      out.apply(Aid::kCompass, model.compass->rate_hz, heading_measurement(model, state, heading));
    }
  }
}

// How late a new fix arrives: half the way back to the surface, no longer than until the next one
// replaces it. Infinite, where none is new.
double fix_late_s(const NavigationModel& model, const SensorReadings& readings,
                  const NavigationState& state) {
  const auto& fix = readings.usbl;
  if (!model.usbl || fix.count == state.usbl_used) return std::numeric_limits<double>::infinity();
  const double travel_s = fix.value.travel_s, period_s = 1.0 / model.usbl->rate_hz;
  return travel_s > 0.0 ? std::min(0.5 * travel_s, 0.9 * period_s) : 0.0;
}

// Takes in the fix that has arrived by time_s, at its own time where the state is not past that.
void correct_by_arrived(const NavigationModel& model, const SensorReadings& readings, double time_s,
                        NavigationState& state) {
  const double late_s = fix_late_s(model, readings, state);
  if (!(time_s - readings.usbl.time_s >= late_s)) return;
  state.usbl_used = readings.usbl.count;
  const double at_s =
      std::clamp(readings.usbl.time_s + late_s, std::min(state.time_s, time_s), time_s);
  Corrections out(model, at_s, state);
  const double age_s = std::clamp(at_s - readings.usbl.time_s, 0.0, 1.0 / model.usbl->rate_hz);
  correct_by_fix(model, readings, age_s, out, state);
}

}  // namespace

Vec3 surveyed_launch(const Vec3& position_ned_m, std::uint64_t seed, std::uint64_t vehicle) {
  const NoiseSource noise{seed, kLaunchStream + vehicle};
  return position_ned_m + noise.error3({.white = kLaunchSigma_m}, 0, 0, 1.0);
}

NavigationState start_navigation(const NavigationModel& model, const SensorReadings& readings,
                                 const Vec3& launch_ned_m, double time_s) {
  NavigationState state;
  state.time_s = state.imu_s = time_s;
  const ImuReading first = in_body(model, readings.imu.value);
  const bool felt = readings.imu.count > 0 &&
                    is_finite_within(first.specific_force_m_s2, kMostForce_m_s2) &&
                    is_finite_within(first.angular_rad_s, kMostTurning_rad_s);
  if (felt) state.imu = first;
  state.imu_used = readings.imu.count;
  const double heading = heading_by(model, readings).value_or(0.0);
  state.attitude =
      felt ? levelled(state.imu.specific_force_m_s2, heading) : heading_attitude(heading);
  state.position_ned_m = launch_ned_m + state.attitude * model.imu.mount.position_m;
  know_only(model, kLaunchSigma_m_s, kLaunchSigma_m, state);
  // The attitude is the readings' own: their innovations are 0 here, and leave what it has to do
  // with the sensors' biases.
  if (felt) level(model, state);
  correct_by_new(model, readings, time_s, state);
  correct_by_arrived(model, readings, time_s, state);
  return state;
}

void update_navigation(const NavigationModel& model, const SensorReadings& readings, double time_s,
                       NavigationState& state) {
  if (!std::isfinite(time_s)) return;
  // Before the inertial unit's reading, unless both are of the same time.
  if (time_s - readings.usbl.time_s > fix_late_s(model, readings, state))
    correct_by_arrived(model, readings, time_s, state);
  if (readings.imu.count != state.imu_used) {
    state.imu_used = readings.imu.count;
    const ImuReading next = in_body(model, readings.imu.value);
    const bool good = is_finite_within(next.specific_force_m_s2, kMostForce_m_s2) &&
                      is_finite_within(next.angular_rad_s, kMostTurning_rad_s);
    if (good) {
      // After a silence the last reading says nothing of the time between.
      if (time_s - state.imu_s > 2.0 * kHeldPeriods / model.imu.rate_hz) {
        carry(model, time_s, state);
        state.imu = next;
        level(model, state);
      }
      move_on(model, next, time_s, state);
    } else {
      ++state.imu_refused;
      doubt_jolt(model, next, state);
    }
  }
  correct_by_new(model, readings, time_s, state);
  correct_by_arrived(model, readings, time_s, state);
  if (state.pending_s > kLongestPending_s) move_covariance(state, model.motion);
}

State estimated_state(const NavigationModel& model, const NavigationState& navigation,
                      double time_s, const State& known) {
  State out = known;
  const Vec3 turning = navigation.imu.angular_rad_s - navigation.bias3(kGyroBias);
  const double since_s =
      std::clamp(time_s - navigation.time_s, 0.0, kHeldPeriods / model.imu.rate_hz);
  const Vec3 arm = model.imu.mount.position_m;
  out.attitude = glm::normalize(navigation.attitude * rotation_by(since_s * turning));
  out.position_ned_m =
      navigation.position_ned_m + since_s * navigation.velocity_ned_m_s - out.attitude * arm;
  out.velocity =
      vec6(glm::conjugate(out.attitude) * navigation.velocity_ned_m_s - glm::cross(turning, arm),
           turning);
  out.held.current_ned_m_s = out.held.current_change_ned_m_s2 =
      out.held.water_acceleration_ned_m_s2 = Vec3(0.0);
  return out;
}

NavigationEstimate estimate_of(const NavigationModel& model, const NavigationState& navigation) {
  const Vec3 turning = navigation.imu.angular_rad_s - navigation.bias3(kGyroBias);
  const Vec3 arm = model.imu.mount.position_m;
  return {navigation.position_ned_m - navigation.attitude * arm,
          navigation.velocity_ned_m_s - navigation.attitude * glm::cross(turning, arm),
          navigation.attitude,
          navigation.sigma3(kPositionError),
          navigation.sigma3(kVelocityError),
          navigation.sigma3(kAttitudeError)};
}

}  // namespace neritic::rov
