#include "diver/deco_ascent_rate.hpp"

#include <algorithm>

namespace neritic::diver {
namespace {

constexpr double kMean_s = 1.0;  // of samples that are gathered into one

void keep_mean(AscentRateState& s) {
  if (s.count == AscentRateState::kMeans) {
    std::shift_left(s.time_s.begin(), s.time_s.end(), 1);
    std::shift_left(s.depth_m.begin(), s.depth_m.end(), 1);
    --s.count;
  }
  const double samples = static_cast<double>(s.samples);
  s.time_s[s.count] = s.sum_time_s / samples;
  s.depth_m[s.count] = s.sum_depth_m / samples;
  ++s.count;
  s.samples = 0;
}

// Least squares over the newest means that span the window, the one being gathered included.
double line_fit_m_min(const AscentRateState& s, double window_s) {
  const double samples = static_cast<double>(s.samples);
  const double newest_s = s.sum_time_s / samples, newest_m = s.sum_depth_m / samples;
  double n = 1.0, t = 0.0, d = 0.0, tt = 0.0, td = 0.0;  // sums, from the newest
  for (std::uint64_t i = s.count; i-- > 0;) {
    const double dt = s.time_s[i] - newest_s, dd = s.depth_m[i] - newest_m;
    n += 1.0;
    t += dt;
    d += dd;
    tt += dt * dt;
    td += dt * dd;
    if (-dt >= window_s - 1e-9) break;
  }
  const double spread = tt - t * t / n;
  return spread > 0.0 ? 60.0 * (t * d / n - td) / spread : 0.0;  // who stays has 0, not -0
}

// The time since which the rate is above a limit: the way from the sample before counts.
double since(double before_s, bool above, double last_s) {
  if (!above) return -1.0;
  return before_s < 0.0 ? last_s : before_s;
}

}  // namespace

AscentRateState observe(const AscentRateState& before, double depth_m, double dt_s,
                        const AscentRateLimits& limits) {
  AscentRateState s = before;
  s.now_s += dt_s;
  if (s.samples > 0 && s.now_s - s.began_s >= kMean_s - 1e-9) keep_mean(s);
  if (s.samples == 0) {
    s.began_s = s.now_s;
    s.sum_time_s = s.sum_depth_m = 0.0;
  }
  s.sum_time_s += s.now_s;
  s.sum_depth_m += depth_m;
  ++s.samples;
  s.rate_m_min = line_fit_m_min(s, std::clamp(limits.window_s, 2.0, 14.0));
  s.fast_since_s = since(s.fast_since_s, s.rate_m_min > limits.fast_m_min, before.now_s);
  s.dangerous_since_s =
      since(s.dangerous_since_s, s.rate_m_min > limits.dangerous_m_min, before.now_s);
  return s;
}

const char* name_of(AscentAlarm alarm) {
  constexpr const char* kNames[] = {"none", "fast", "dangerous"};
  return kNames[static_cast<std::size_t>(alarm)];
}

AscentAlarm alarm_of(const AscentRateState& state, const AscentRateLimits& limits) {
  const auto lasts = [&](double since_s) {
    return since_s >= 0.0 && state.now_s - since_s >= limits.persists_s - 1e-9;
  };
  if (lasts(state.dangerous_since_s)) return AscentAlarm::kDangerous;
  return lasts(state.fast_since_s) ? AscentAlarm::kFast : AscentAlarm::kNone;
}

}  // namespace neritic::diver
