#include "diver/gaze_events.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

static_assert(std::is_trivially_copyable_v<GazeState>);

// Faster trackers are none; closer samples are refused, which bounds what waits.
constexpr double kLeastStep_s = 2e-4;
constexpr int kClockWasSet = 20;
constexpr double kPursuit_rad = radians(2.0);

}  // namespace

GazeSettings headset_gaze(GazeMethod method) {
  GazeSettings settings;
  settings.method = method;
  settings.dispersion_s = 0.250;
  return settings;
}

Status check_gaze_settings(const GazeSettings& s) {
  const auto within = [](double value, double low, double high) {
    return value >= low && value <= high;
  };
  if (!within(s.velocity_rad_s, radians(1.0), radians(1000.0)))
    return refusal("gaze", fmt::format("{:g} deg/s", degrees(s.velocity_rad_s)), "1 to 1000");
  if (!within(s.dispersion_rad, radians(0.05), radians(30.0)))
    return refusal("gaze", fmt::format("a dispersion of {:g} deg", degrees(s.dispersion_rad)),
                   "0.05 to 30");
  for (const double duration_s : {s.velocity_window_s, s.widest_window_s, s.bridge_s, s.merge_s,
                                  s.least_fixation_s, s.dispersion_s})
    if (!within(duration_s, 0.0, 2.0))
      return refusal("gaze", fmt::format("a duration of {:g} s", duration_s), "0 to 2");
  return {};
}

void GazeMonitor::Growing::add(const Seen& s) {
  if (!open) {
    *this = {};
    open = true;
    fixation.start_s = s.time_s;
    first = s.direction;
  }
  fixation.end_s = s.time_s;
  last = s.direction;
  sum += s.direction;
  ++fixation.samples;
}

Fixation GazeMonitor::Growing::result() const {
  Fixation out = fixation;
  const double length = glm::length(sum);
  out.direction = length > 0.0 ? sum / length : last;
  // For unit vectors |sum| = n (1 - <angle^2> / 2) to second order.
  out.spread_rad = std::sqrt(std::max(0.0, 2.0 * (1.0 - length / out.samples)));
  out.drift_rad = angle_between(first, last);
  out.may_be_pursuit = out.drift_rad > kPursuit_rad;
  return out;
}

void GazeMonitor::push(const GazeSample& sample, GazeEvents& out) {
  const double length = glm::length(sample.direction);
  const bool good = std::abs(sample.time_s) < 1e12 && length > 1e-6 && length < 1e6;
  const bool late = good && has_time_ && !(sample.time_s >= last_time_s_ + kLeastStep_s);
  if (!good || late) {
    ++state_.refused;
    ++lost_;
    // So many in a row: the clock was set back, or once was wrong.
    if (late && ++late_in_a_row_ == kClockWasSet) {
      break_off(out);
      has_time_ = false;
    }
    return;
  }
  late_in_a_row_ = 0;
  last_time_s_ = sample.time_s;
  has_time_ = true;
  state_.time_s = sample.time_s;
  if (!sample.valid) {
    ++lost_;
    if (sample.time_s - last_seen_s_ > settings_.bridge_s) state_.now = GazeClass::kLost;
    return;
  }
  if (has_seen_ && sample.time_s - last_seen_s_ > settings_.bridge_s) {
    note_loss(last_seen_s_, sample.time_s, out);
    break_off(out);
  }
  has_seen_ = true;
  last_seen_s_ = sample.time_s;
  state_.direction = sample.direction / length;
  noise_.push(sample.time_s, state_.direction);
  deviation_sum_rad_ += noise_.deviation_rad();
  ++seen_samples_;
  waiting_.push_back({sample.time_s, state_.direction, lost_});
  lost_ = 0;
  if (settings_.method == GazeMethod::kVelocity)
    settle_velocity(false, out);
  else
    settle_dispersion(false, out);
}

GazeMonitor::Extent::Extent(const Vec3& middle) : ahead(middle) {
  const Vec3 up = std::abs(ahead.y) < 0.9 ? Vec3(0.0, 1.0, 0.0) : Vec3(1.0, 0.0, 0.0);
  right = glm::normalize(glm::cross(ahead, up));
  above = glm::cross(right, ahead);
}

void GazeMonitor::Extent::add(const Vec3& d) {
  const double x = std::atan2(glm::dot(d, right), glm::dot(d, ahead));
  const double y = std::atan2(glm::dot(d, above), glm::dot(d, ahead));
  low_x = std::min(low_x, x), high_x = std::max(high_x, x);
  low_y = std::min(low_y, y), high_y = std::max(high_y, y);
}

// A window of the least duration is moved on until what it holds lies together; then the fixation
// lasts for as long as its samples do.
void GazeMonitor::settle_dispersion(bool all, GazeEvents& out) {
  const auto take = [&](const Seen& seen, GazeClass is) {
    const double span_s = has_before_ ? seen.time_s - before_.time_s : 0.0;
    const double velocity =
        span_s > 0.0 ? angle_between(before_.direction, seen.direction) / span_s : 0.0;
    classify(seen, is, velocity, out);
  };
  if (in_fixation_ && !waiting_.empty()) {
    Extent wider = extent_;
    wider.add(waiting_.back().direction);
    if (wider.size() <= settings_.dispersion_rad) {
      extent_ = wider;
      take(waiting_.back(), GazeClass::kFixation);
      waiting_.clear();
    } else {
      // The eye has gone, perhaps between two samples.
      in_fixation_ = false;
      leave_fixation(out);
    }
  }
  while (!in_fixation_ && !waiting_.empty() &&
         waiting_.back().time_s - waiting_.front().time_s >= settings_.dispersion_s) {
    Extent extent(waiting_.front().direction);
    for (const Seen& seen : waiting_) extent.add(seen.direction);
    if (extent.size() > settings_.dispersion_rad) {
      take(waiting_.front(), GazeClass::kSaccade);
      waiting_.erase(waiting_.begin());
      continue;
    }
    in_fixation_ = true;
    extent_ = extent;
    for (const Seen& seen : waiting_) take(seen, GazeClass::kFixation);
    waiting_.clear();
  }
  if (!all) return;
  for (const Seen& seen : waiting_) take(seen, GazeClass::kSaccade);
  waiting_.clear();
}

void GazeMonitor::classify(const Seen& seen, GazeClass is, double velocity_rad_s, GazeEvents& out) {
  out.classes.insert(out.classes.end(), seen.lost_before, GazeClass::kLost);
  out.classes.push_back(is);
  state_.velocity_rad_s = velocity_rad_s;
  state_.now = is;
  if (seen.lost_before > 0 && has_before_) note_loss(before_.time_s, seen.time_s, out);
  if (is == GazeClass::kFixation) {
    if (in_saccade_) {
      saccade_.end_s = seen.time_s;
      saccade_.amplitude_rad = angle_between(saccade_start_.direction, seen.direction);
      saccade_.peak_rad_s = std::max(saccade_.peak_rad_s, velocity_rad_s);
      in_saccade_ = false;
      has_saccade_ = true;
    }
    growing_.add(seen);
    state_.fixated_s = growing_.fixation.end_s - growing_.fixation.start_s;
    state_.fixation = glm::normalize(growing_.sum);
  } else {
    if (!has_before_) before_ = seen;
    if (!in_saccade_) leave_fixation(out);
    saccade_.end_s = seen.time_s;
    saccade_.amplitude_rad = angle_between(saccade_start_.direction, seen.direction);
    saccade_.peak_rad_s = std::max(saccade_.peak_rad_s, velocity_rad_s);
  }
  before_ = seen;
  has_before_ = true;
}

// A saccade starts at the last sample.
void GazeMonitor::leave_fixation(GazeEvents& out) {
  if (growing_.open) end_fixation(out);
  in_saccade_ = true;
  saccade_start_ = before_;
  saccade_ = {saccade_start_.time_s};
  state_.fixated_s = 0.0;
}

// The one that grows has ended: the same as the one that is held, or the next.
void GazeMonitor::end_fixation(GazeEvents& out) {
  const Fixation ended = growing_.result();
  const auto merged_sum = growing_.sum;
  growing_.open = false;
  if (has_held_ && ended.start_s - held_.end_s <= settings_.merge_s &&
      angle_between(held_.direction, ended.direction) <= settings_.merge_rad) {
    const double n = held_.samples, m = ended.samples;
    held_.direction = glm::normalize(n * held_.direction + merged_sum);
    held_.spread_rad = std::sqrt(
        (n * held_.spread_rad * held_.spread_rad + m * ended.spread_rad * ended.spread_rad) /
        (n + m));
    held_.end_s = ended.end_s;
    held_.drift_rad += ended.drift_rad;
    held_.may_be_pursuit = held_.may_be_pursuit || held_.drift_rad > kPursuit_rad;
    held_.samples += ended.samples;
    has_saccade_ = false;  // it was noise
    return;
  }
  emit(out);
  held_ = ended;
  has_held_ = true;
}

// The held event is final, and so is the saccade after it.
void GazeMonitor::emit(GazeEvents& out) {
  if (has_held_ && held_.end_s - held_.start_s >= settings_.least_fixation_s) {
    out.fixations.push_back(held_);
    ++state_.fixations;
  }
  has_held_ = false;
  if (!has_saccade_) return;
  const bool too_fast =
      settings_.method == GazeMethod::kVelocity && saccade_.peak_rad_s > kFastestEye_rad_s;
  if (too_fast || at_loss(saccade_)) {
    add_blink(saccade_, out);
    has_saccade_ = false;
    return;
  }
  out.saccades.push_back(saccade_);
  ++state_.saccades;
  state_.last_amplitude_rad = saccade_.amplitude_rad;
  state_.last_peak_rad_s = saccade_.peak_rad_s;
  has_saccade_ = false;
}

// The saccade just before was the eyelid.
void GazeMonitor::note_loss(double from_s, double to_s, GazeEvents& out) {
  loss_from_s_ = from_s;
  loss_to_s_ = to_s;
  while (!out.saccades.empty() && at_loss(out.saccades.back())) {
    add_blink(out.saccades.back(), out);
    out.saccades.pop_back();
    --state_.saccades;
  }
}

bool GazeMonitor::at_loss(const Saccade& saccade) const {
  return saccade.end_s >= loss_from_s_ - kLid_s && saccade.start_s <= loss_to_s_ + kLid_s;
}

// One loss is one blink, the lid's way down and up.
void GazeMonitor::add_blink(const Saccade& blink, GazeEvents& out) const {
  if (out.blinks.empty() || !at_loss(out.blinks.back()) || !at_loss(blink)) {
    out.blinks.push_back(blink);
    return;
  }
  Saccade& last = out.blinks.back();
  last.start_s = std::min(last.start_s, blink.start_s);
  last.end_s = std::max(last.end_s, blink.end_s);
  last.amplitude_rad = std::max(last.amplitude_rad, blink.amplitude_rad);
  last.peak_rad_s = std::max(last.peak_rad_s, blink.peak_rad_s);
}

// The eye was lost for long: nothing goes on across.
void GazeMonitor::break_off(GazeEvents& out) {
  if (settings_.method == GazeMethod::kVelocity)
    settle_velocity(true, out);
  else
    settle_dispersion(true, out);
  if (growing_.open) end_fixation(out);
  has_saccade_ = has_saccade_ || in_saccade_;
  in_saccade_ = false;
  emit(out);
  waiting_.clear();
  settled_ = 0;
  slow_velocity_rad_s_.reset();
  in_fixation_ = false;
  has_before_ = has_seen_ = false;
  state_.now = GazeClass::kLost;
  state_.fixated_s = 0.0;
}

void GazeMonitor::finish(GazeEvents& out) {
  break_off(out);
  out.classes.insert(out.classes.end(), lost_, GazeClass::kLost);
  lost_ = 0;
}

GazeEvents find_gaze_events(const std::vector<GazeSample>& samples, const GazeSettings& settings) {
  GazeMonitor monitor(settings);
  GazeEvents out;
  for (const GazeSample& sample : samples) monitor.push(sample, out);
  monitor.finish(out);
  return out;
}

std::vector<bool> in_saccades(const std::vector<GazeSample>& samples,
                              const std::vector<Saccade>& saccades) {
  std::vector<bool> out;
  auto next = saccades.begin();
  for (const GazeSample& sample : samples) {
    while (next != saccades.end() && next->end_s < sample.time_s) ++next;
    out.push_back(next != saccades.end() && sample.time_s >= next->start_s);
  }
  return out;
}

double saccade_kappa(const std::vector<bool>& marked, const std::vector<bool>& found) {
  NERITIC_CHECK(marked.size() == found.size(), "{} {}", marked.size(), found.size());
  double both = 0.0, only_marked = 0.0, only_found = 0.0, neither = 0.0;
  for (std::size_t i = 0; i < marked.size(); ++i)
    (marked[i] ? found[i] ? both : only_marked : found[i] ? only_found : neither) += 1.0;
  const double n = static_cast<double>(marked.size());
  if (n == 0.0) return 0.0;
  const double agreed = (both + neither) / n;
  const double chance = ((both + only_marked) * (both + only_found) +
                         (neither + only_marked) * (neither + only_found)) /
                        (n * n);
  return chance < 1.0 ? (agreed - chance) / (1.0 - chance) : 1.0;
}

}  // namespace neritic::diver
