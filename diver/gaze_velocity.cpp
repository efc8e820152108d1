// The eye's velocity beside the noise of the tracker, and I-VT by it (gaze_events.hpp).
#include <algorithm>
#include <cmath>

#include "diver/gaze_events.hpp"

namespace neritic::diver {
namespace {

// Times are rounded to some microseconds.
constexpr double kSlack_s = 1e-5;
// So many samples tell the noise to a tenth; slow trackers begin before.
constexpr std::size_t kNoiseKnown = 32;
constexpr double kMostLearning_s = 0.5;
constexpr double kBaloh_rad_s = radians(551.0), kBaloh_rad = radians(14.0);

}  // namespace

GazeNoiseFound GazeMonitor::noise() const {
  GazeNoiseFound out{0.0, settings_.velocity_rad_s, settings_.velocity_window_s};
  if (seen_samples_ > 0) out.deviation_rad = deviation_sum_rad_ / seen_samples_;
  if (asked_samples_ == 0) return out;
  out.velocity_rad_s = asked_sum_.velocity_rad_s / asked_samples_;
  out.window_s = asked_sum_.window_s / asked_samples_;
  out.span_s = asked_sum_.span_s / asked_samples_;
  return out;
}

double smallest_saccade_rad(const GazeNoiseFound& noise) {
  return std::max(amplitude_of_peak_rad(noise.velocity_rad_s), noise.span_s * noise.velocity_rad_s);
}

double amplitude_of_peak_rad(double peak_rad_s) {
  if (!(peak_rad_s < kBaloh_rad_s)) return radians(180.0);
  return -kBaloh_rad * std::log1p(-std::max(0.0, peak_rad_s) / kBaloh_rad_s);
}

// Over the usual window: between the samples half a window before and after, or its neighbours
// where they are farther off. Over wider ones: between the means of all samples of both halves.
std::optional<GazeMonitor::Velocity> GazeMonitor::velocity_at(std::size_t sample, double window_s,
                                                              bool all) const {
  const double half_s = 0.5 * window_s, now_s = waiting_[sample].time_s;
  std::size_t after = sample + 1, before = sample;
  while (after < waiting_.size() && waiting_[after].time_s < now_s + half_s - kSlack_s) ++after;
  if (after >= waiting_.size()) {
    if (!all) return std::nullopt;
    after = waiting_.size() - 1;
  }
  while (before > 0 && waiting_[before].time_s > now_s - half_s + kSlack_s) --before;
  Vec3 later = waiting_[after].direction, earlier = waiting_[before].direction;
  double span_s = waiting_[after].time_s - waiting_[before].time_s;
  if (window_s > settings_.velocity_window_s && before < sample && after > sample) {
    double sum_s = waiting_[after].time_s;
    for (std::size_t i = sample + 1; i < after; ++i) {
      later += waiting_[i].direction;
      sum_s += waiting_[i].time_s;
    }
    span_s = sum_s / static_cast<double>(after - sample);
    later /= static_cast<double>(after - sample);
    sum_s = waiting_[before].time_s;
    for (std::size_t i = before + 1; i < sample; ++i) {
      earlier += waiting_[i].direction;
      sum_s += waiting_[i].time_s;
    }
    span_s -= sum_s / static_cast<double>(sample - before);
    earlier /= static_cast<double>(sample - before);
  }
  if (!(span_s > 0.0)) return Velocity{};
  return Velocity{(later - earlier) / span_s, angle_between(earlier, later) / span_s};
}

// The usual window, or the first of twice and four times its width in which white noise of this
// size stays below the velocity asked; if it does in none, the widest, and a larger velocity.
GazeMonitor::Asked GazeMonitor::asked() const {
  const double usual_s = settings_.velocity_window_s,
               noise_rad = settings_.noise_deviations * noise_.deviation_rad();
  Asked out{usual_s, settings_.velocity_rad_s, usual_s};
  if (!(noise_rad > 0.0) || waiting_.size() < 2) return out;
  const double step_s =
      (waiting_.back().time_s - waiting_.front().time_s) / static_cast<double>(waiting_.size() - 1);
  for (double window_s = usual_s;; window_s *= 2.0) {
    // Means of n samples each, n + 1 steps apart; in the usual window, of the outermost alone.
    const bool means = window_s > usual_s;
    const double n = std::max(1.0, std::ceil(0.5 * window_s / step_s - 1e-3)),
                 span_s = (means ? n + 1.0 : 2.0 * n) * step_s,
                 noise_rad_s = noise_rad * std::sqrt(2.0 / (means ? n : 1.0)) / span_s;
    out = {window_s, std::max(settings_.velocity_rad_s, noise_rad_s), span_s};
    if (noise_rad_s <= settings_.velocity_rad_s || 2.0 * window_s > settings_.widest_window_s)
      break;
  }
  // Noise need not be white: in wider windows it counts as it is found there.
  if (out.window_s > usual_s && out.window_s == slow_window_s_ &&
      slow_noise_.count() >= kNoiseKnown)
    out.velocity_rad_s =
        std::max(out.velocity_rad_s, settings_.noise_deviations * slow_noise_.deviation());
  return out;
}

// Velocities a window apart have independent noise, and the same eye's motion.
void GazeMonitor::learn_noise(double time_s, double window_s, const Vec3& velocity_rad_s) {
  if (window_s != slow_window_s_) {
    slow_noise_ = {};
    slow_velocity_rad_s_.reset();
    slow_window_s_ = window_s;
  }
  if (slow_velocity_rad_s_ && time_s - slow_time_s_ < window_s) return;
  if (slow_velocity_rad_s_)
    slow_noise_.push(glm::length(velocity_rad_s - *slow_velocity_rad_s_) / std::sqrt(2.0));
  slow_velocity_rad_s_ = velocity_rad_s;
  slow_time_s_ = time_s;
}

void GazeMonitor::settle_velocity(bool all, GazeEvents& out) {
  // At the start the noise is learnt first.
  learnt_ = learnt_ || all || noise_.count() >= kNoiseKnown ||
            waiting_.back().time_s - waiting_.front().time_s >= kMostLearning_s;
  if (!learnt_) return;
  const double usual_s = settings_.velocity_window_s;
  while (settled_ < waiting_.size()) {
    const Asked asked = this->asked();
    const auto velocity = velocity_at(settled_, asked.window_s, all);
    if (!velocity) return;
    const Seen seen = waiting_[settled_];
    asked_sum_.window_s += asked.window_s;
    asked_sum_.velocity_rad_s += asked.velocity_rad_s;
    asked_sum_.span_s += asked.span_s;
    ++asked_samples_;
    if (asked.window_s > usual_s) learn_noise(seen.time_s, asked.window_s, velocity->rad_s);
    classify(
        seen,
        velocity->size_rad_s > asked.velocity_rad_s ? GazeClass::kSaccade : GazeClass::kFixation,
        velocity->size_rad_s, out);
    ++settled_;
    // Samples more than half of the widest window back are not needed again.
    const double kept_s = 0.5 * std::max(usual_s, settings_.widest_window_s) + kSlack_s;
    std::size_t old = 0;
    while (old + 1 < settled_ && waiting_[old + 1].time_s < seen.time_s - kept_s) ++old;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(old));
    settled_ -= old;
  }
}

}  // namespace neritic::diver
